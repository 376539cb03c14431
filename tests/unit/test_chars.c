/* Names of any bytes as UTF-8: every short text over bytes that could be mistaken comes back, is well formed, and is
 * meant by what people type. */
#include "base/chars.h"

#include "tap.h"

#include <string.h>

enum { MOST = 6 };

/* The bytes that the escaped name stands for. */
static size_t decode(const char *name, char *to)
{
    size_t n = 0;
    for (; *name; n++) {
        int byte = chars_escaped(name);
        to[n] = byte < 0 ? *name : (char)byte;
        name += byte < 0 ? 1 : 4;
    }
    to[n] = 0;
    return n;
}

static bool comes_back(const char *text)
{
    char name[4 * MOST + 1], back[4 * MOST + 1];
    size_t n = chars_escape(text, strlen(text), name);
    return n == strlen(name) && chars_utf8(name) && decode(name, back) == strlen(text) && !strcmp(back, text) &&
           chars_mean(text, name) && chars_mean(name, name);
}

static void test_all(void)
{
    static const char bytes[] = "\\x4e\xe9\xc3\xa9\1 A";
    int wrong = 0, count = 0, base = (int)sizeof bytes - 1;
    for (int length = 0; length <= MOST; length++) {
        int all = 1;
        for (int i = 0; i < length; i++)
            all *= base;
        for (int number = 0; number < all; number += length < 5 ? 1 : 7) {
            char text[MOST + 1] = "";
            for (int i = 0, left = number; i < length; i++, left /= base)
                text[i] = bytes[left % base];
            wrong += !comes_back(text);
            count++;
        }
    }
    ok(!wrong && count > 100000, "%d texts come back: %d wrong", count, wrong);
}

static void test_names(void)
{
    static const struct {
        const char *text, *name;
    } known[] = {{"caf\xe9", "caf\\xe9"},
                 {"caf\xc3\xa9", "caf\xc3\xa9"},
                 {"C:\\face", "C:\\face"},
                 {"a\\xe9", "a\\x5cxe9"},
                 {"\\xe", "\\xe"},
                 {"\x1b[1m\x7f", "\\x1b[1m\\x7f"},
                 {"\xed\xa0\x80", "\\xed\\xa0\\x80"},
                 {"", ""}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        char name[64];
        chars_escape(known[i].text, strlen(known[i].text), name);
        ok(!strcmp(name, known[i].name), "stands as %s", known[i].name);
    }
}

static void test_meaning(void)
{
    ok(!chars_mean("caf", "caf\\xe9") && !chars_mean("caf\xe9s", "caf\\xe9") && !chars_mean("caf\xe8", "caf\\xe9"),
       "another name is not meant");
    ok(chars_means("CAF\xe9", 4, "caf\\xe9", 7, CHARS_ANY_CASE) && !chars_means("CAF\xe9", 4, "caf\\xe9", 7, 0),
       "in any case");
    ok(chars_means("ca", 2, "caf\\xe9", 7, CHARS_BEGINS) && chars_means("caf\xe9", 4, "caf\\xe9s", 8, CHARS_BEGINS) &&
           !chars_means("cafe", 4, "caf", 3, CHARS_BEGINS),
       "as a beginning");
}

static void test_typed(void)
{
    ok(chars_mean("caf\\xE9", "caf\\xe9") && chars_mean("caf\\xC3\\xa9", "caf\xc3\xa9"), "digits of either case");
    ok(chars_mean("a\\x2cb\\x3D", "a,b=") && !chars_mean("a\\x2c", "a") && !chars_mean("a\\x00b", "a"),
       "any byte may be written so");
    ok(chars_mean("m\\x41", "m\\x41") && chars_mean("m\\x41", "mA") && chars_mean("m\\x41", "m\\x5cx41"),
       "a name that has it as it stands is meant too");
    ok(!chars_means("a\\x4", 3, "a", 1, 0) && chars_means("a\\x41", 4, "a\\x4", 4, 0), "not beyond what was typed");
    char to[64];
    chars_show("caf\xe8\\xE8", strlen("caf\xe8\\xE8"), to);
    ok(!strcmp(to, "caf\\xe8\\xE8"), "is shown as %s", to);
}

int main(void)
{
    test_names();
    test_all();
    test_meaning();
    test_typed();
    return done_testing();
}
