/* Numbers as people write them, against strtod and by hand. */
#include "base/num.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

static uint64_t random_bits(uint64_t *state)
{
    *state ^= *state << 13, *state ^= *state >> 7, *state ^= *state << 17;
    return *state;
}

/* Random decimals of 1 to 25 digits and every size of exponent must come out as strtod reads them. */
static void against_strtod(void)
{
    uint64_t state = 88172645463325252u;
    int wrong = 0;
    for (int i = 0; i < 200000; i++) {
        char text[64];
        int n = 0, digits = 1 + (int)(random_bits(&state) % 25), point = (int)(random_bits(&state) % 26);
        if (random_bits(&state) & 1)
            text[n++] = '-';
        for (int d = 0; d < digits; d++) {
            if (d == point)
                text[n++] = '.';
            text[n++] = (char)('0' + random_bits(&state) % 10);
        }
        int exponent = (int)(random_bits(&state) % 60) - 30;
        snprintf(text + n, sizeof text - (size_t)n, "e%d", exponent);
        double got = 0, want = strtod(text, NULL);
        if (num_double(text, &got) || memcmp(&got, &want, sizeof got))
            wrong++;
    }
    ok(wrong == 0, "200000 random decimals read as strtod reads them (%d wrong)", wrong);
}

/* Whether num_scan reads what stands at the start of a long line as strtod does, to where strtod stops. */
static bool as_strtod(const char *text)
{
    char line[160], *end;
    const char *stop = NULL;
    snprintf(line, sizeof line, "%s 2 3 and more on the line, so that what comes is not the end of the text", text);
    double got = 0, want = strtod(line, &end);
    return !num_scan(line, line + strlen(line), &stop, &got) && stop == end && !memcmp(&got, &want, sizeof got);
}

/* As they stand in files: no exponent, up to 19 digits and more, within longer text. */
static void in_lines(void)
{
    static const char *const odd[] = {"0",   "-0",   "0.0",     "-0.000000", ".5",     "-.5",        "5.",  "1e5",
                                      "1E5", "1.5e", "1.25e-3", "0.1e+2",    "000001", "0000000.10", "+.5", "1.2.3"};
    uint64_t state = 3;
    int wrong[3] = {0};
    char text[64];
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++)
        ok(as_strtod(odd[i]), "'%s' within a line", odd[i]);
    for (int i = 0; i < 200000; i++) {
        int n = 0, digits = 1 + (int)(random_bits(&state) % 22), point = (int)(random_bits(&state) % 23);
        for (int d = 0; d < digits; d++) {
            if (d == point)
                text[n++] = '.';
            text[n++] = (char)('0' + random_bits(&state) % 10);
        }
        text[n] = 0;
        wrong[0] += !as_strtod(text);
        double value;
        uint64_t bits = (random_bits(&state) & 0x800fffffffffffff) | (uint64_t)(1023 - 40 + i % 60) << 52;
        memcpy(&value, &bits, sizeof value);
        snprintf(text, sizeof text, "%.17g", value);
        wrong[1] += !as_strtod(text);
        /* Half way between two doubles: to the even one. */
        snprintf(text, sizeof text, "%llu.5", (1ull << 52) + (random_bits(&state) >> 12));
        wrong[2] += !as_strtod(text);
    }
    ok(!wrong[0], "200000 random numbers within lines: %d differ", wrong[0]);
    ok(!wrong[1], "200000 doubles with 17 digits: %d differ", wrong[1]);
    ok(!wrong[2], "200000 that are half way between two doubles: %d differ", wrong[2]);
}

static void refuses(void)
{
    const char *bad[] = {"", "-", ".", "e5", "1e", "1.2.3", "nan", "inf", "0x10", "1 ", " 1", "1e400", "1,2", "--1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        double v;
        ok(num_double(bad[i], &v) == -1, "'%s' is no number", bad[i]);
    }
    double v = 1;
    ok(!num_double("1e-400", &v) && v == 0, "a number below the smallest is 0");
    ok(!num_double("-0", &v) && v == 0 && signbit(v), "-0 keeps its sign");
}

static void integers(void)
{
    int64_t v;
    ok(!num_int("-12", -20, 20, &v) && v == -12, "-12");
    ok(num_int("21", -20, 20, &v) == -1, "21 is past 20");
    ok(num_int("9223372036854775808", INT64_MIN, INT64_MAX, &v) == -1, "2^63 does not fit");
    ok(num_int("1.5", 0, 9, &v) == -1 && num_int("", 0, 9, &v) == -1 && num_int("1x", 0, 9, &v) == -1, "not integers");
}

static void lengths(void)
{
    num_length l;
    ok(!num_length_of("4cm", &l) && l.value == 4 && l.unit == 10000, "4cm");
    ok(num_length_in(l, 0, num_unit_of("mm")) == 40, "4cm is exactly 40 mm");
    ok(!num_length_of("2.5", &l) && l.unit == 0, "no suffix");
    ok(num_length_in(l, num_unit_of("mm"), num_unit_of("m")) == 2.5 / 1000, "2.5 mm in m is rounded once");
    int twice = 0;
    for (int i = 0; i < 10000; i++)
        twice += num_length_in((num_length){i / 10., 1000}, 0, 1000000) != i / 10. / 1000;
    ok(!twice, "so is 5.1 mm, and every other tenth of a millimetre to a metre");
    ok(!num_length_of("1in", &l) && num_length_in(l, 0, num_unit_of("mm")) == 25.4, "an inch is 25.4 mm");
    ok(num_length_of("3ft", &l) == -1 && num_length_of("mm", &l) == -1, "feet, and a unit alone, are refused");
    num_length list[3];
    ok(num_lengths_of("1,2mm,3", list, 3) == 3 && list[1].unit == 1000, "a list of three");
    char tail[80] = "1,2.";
    memset(tail + 4, '0', 70);
    tail[74] = 0;
    double number[2];
    ok(num_list(tail, number, 2) == -1, "an item of 72 characters is refused, not cut");
    ok(num_lengths_of("1,2,3,4", list, 3) == -1 && num_lengths_of("1,,3", list, 3) == -1, "four, or a gap: refused");
}

static void test_sizes(void)
{
    static const struct {
        const char *text;
        int64_t bytes;
    } good[] = {{"1B", 1},          {"500MB", 500000000},      {"2GiB", 2147483648}, {"1.5 GB", 1500000000},
                {"64KiB", 65536},   {"64kiB", 65536},          {"3kB", 3000},        {"3KB", 3000},
                {"1e3kB", 1000000}, {"8PiB", 9007199254740992}};
    static const char *const bad[] = {"",    "5",   "5G",    "5gb",    "GB",   "-1GB",   "0B",
                                      ".9B", "1iB", "1 B B", "1e30PB", "nanB", "5 000B", "5XB"};
    char text[NUM_TEXT];
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        int64_t got = 0;
        ok(!num_size_of(good[i].text, &got) && got == good[i].bytes, "%s is %lld bytes", good[i].text, (long long)got);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        int64_t got = 0;
        ok(num_size_of(bad[i], &got) && !got, "'%s' is no size", bad[i]);
    }
    ok(!strcmp(num_size_text(999, text), "999 B"), "%s", text);
    ok(!strcmp(num_size_text(999.6, text), "1 kB"), "%s", text);
    ok(!strcmp(num_size_text(2348e6, text), "2.35 GB"), "%s", text);
    ok(!strcmp(num_size_text(1e25, text), "1e+10 PB"), "%s", text);
}

int main(void)
{
    test_sizes();
    against_strtod();
    in_lines();
    refuses();
    integers();
    lengths();
    return done_testing();
}
