/* Files that people write: words, comments, pairs, and what is refused with its line. */
#include "base/keyfile.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

static const char *const keys[] = {"level", "priority", "material", "surfaces"};

typedef struct file {
    in *s;
    keyfile k;
    err e;
} file;

static void file_open(file *f, const char *text, size_t size)
{
    *f = (file){0};
    f->s = in_memory(text, size, "f.txt", &f->e);
    keyfile_open(&f->k, f->s);
}

/* Reads all lines; returns how many have words, or -1. */
static int lines(file *f)
{
    int count = 0, more;
    while ((more = keyfile_next(&f->k, &f->e)) > 0)
        count++;
    return more < 0 ? -1 : count;
}

static void words(void)
{
    static const char text[] = "\xEF\xBB\xBF"
                               "# a comment\r\n"
                               "\n"
                               "  skin\tlevel=0 surfaces=a#1,b*  # rest\r\n"
                               "last";
    file f;
    file_open(&f, text, strlen(text));
    ok(keyfile_next(&f.k, &f.e) == 1, "the first line with words");
    ok(f.k.line == 3 && f.k.count == 3, "is line 3, of 3 words (line %d, %d)", (int)f.k.line, f.k.count);
    ok(!strcmp(f.k.word[0], "skin") && !strcmp(f.k.word[1], "level=0"), "blanks and tabs part words");
    ok(!strcmp(f.k.word[2], "surfaces=a#1,b*"), "a '#' inside a word is no comment: %s", f.k.word[2]);
    ok(f.k.comment && !strcmp(f.k.comment, "rest"), "what comes after one is: %s", f.k.comment ? f.k.comment : "none");
    ok(keyfile_next(&f.k, &f.e) == 1 && f.k.count == 1 && !strcmp(f.k.word[0], "last") && f.k.line == 4,
       "a last line without its end");
    ok(!f.k.comment, "which has no comment");
    ok(keyfile_next(&f.k, &f.e) == 0 && !f.e.status, "then the end");
    in_close(f.s);
}

static void pairs(void)
{
    static const char text[] = "skin level=0 surfaces=a=b";
    file f;
    uint64_t seen = 0;
    char *value = NULL;
    file_open(&f, text, strlen(text));
    keyfile_next(&f.k, &f.e);
    ok(keyfile_pair(&f.k, 1, keys, 4, &seen, &value, &f.e) == 0 && !strcmp(value, "0"), "level=0");
    ok(keyfile_pair(&f.k, 2, keys, 4, &seen, &value, &f.e) == 3 && !strcmp(value, "a=b"), "a value may hold '='");
    ok(seen == 9, "the bits of the keys seen");
    in_close(f.s);
}

/* The error of taking all words but the first as pairs must hold `want`. */
static void refuse_pair(const char *text, const char *want)
{
    file f;
    uint64_t seen = 0;
    char *value;
    int got = 0;
    file_open(&f, text, strlen(text));
    keyfile_next(&f.k, &f.e);
    for (int at = 1; at < f.k.count && got >= 0; at++)
        got = keyfile_pair(&f.k, at, keys, 4, &seen, &value, &f.e);
    ok(got == -1 && strstr(f.e.text, want) && !strncmp(f.e.text, "f.txt:1: ", 9), "'%s': %s", text, f.e.text);
    in_close(f.s);
}

static void refuse_text(const char *text, size_t size, const char *want, const char *name)
{
    file f;
    file_open(&f, text, size);
    ok(lines(&f) == -1 && strstr(f.e.text, want), "%s: %s", name, f.e.text);
    in_close(f.s);
}

static void refuse_lines(void)
{
    enum { LONG = KEYFILE_LINE + 1 };
    char *text = malloc(LONG + 1);
    if (!text) {
        ok(false, "memory for a long line");
        return;
    }
    memset(text, 'x', LONG);
    refuse_text(text, LONG, "f.txt:1: a line of 65537 bytes", "a line that is too long");
    for (int i = 0; i <= 2 * KEYFILE_WORDS; i++)
        text[i] = i % 2 ? ' ' : 'x';
    refuse_text(text, 2 * KEYFILE_WORDS + 1, "f.txt:1: more than 64 words", "a line of too many words");
    free(text);
    refuse_text("a\nb\1c\n", 6, "f.txt:2: control character 0x01", "a control character");
    refuse_text("a\nb\0c\n", 6, "f.txt", "a NUL byte");
    refuse_text("a\nb\177\n", 5, "f.txt:2: control character 0x7f", "a DEL");
}

static void bytes(void)
{
    static const char comment[] = "skin level=0 # caf\xE9\n", word[] = "skin\nsk\xFFin level=0\n";
    file f;
    file_open(&f, comment, sizeof comment - 1);
    ok(lines(&f) == 1, "a comment's bytes do not matter");
    in_close(f.s);
    file_open(&f, word, sizeof word - 1);
    ok(lines(&f) == -1 && strstr(f.e.text, "f.txt:2: word 1 is not UTF-8"), "a word's do: %s", f.e.text);
    in_close(f.s);
}

int main(void)
{
    bytes();
    words();
    pairs();
    refuse_pair("skin levl=0", "unknown key 'levl'; did you mean 'level'?");
    refuse_pair("skin level", "expected KEY=VALUE");
    refuse_pair("skin =3", "expected KEY=VALUE");
    refuse_pair("skin level= 3", "without a value");
    refuse_pair("skin level=1 level=1", "given twice");
    refuse_pair("skin Level=1", "did you mean 'level'?");
    refuse_lines();
    return done_testing();
}
