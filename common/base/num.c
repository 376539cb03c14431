#include "base/num.h"

#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Powers of ten that a double holds exactly. */
static const double ten_to[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

typedef struct decimal {
    uint64_t digits; /* the significant digits as an integer */
    int count;       /* how many of them, leading zeros aside */
    int exponent;
    bool negative;
    const char *stop;
} decimal;

static const char *scan_digits(const char *p, const char *end, decimal *d, int scale)
{
    for (; p < end && *p >= '0' && *p <= '9'; p++) {
        if (d->count < 19) {
            d->digits = d->digits * 10 + (uint64_t)(*p - '0');
            d->count += d->digits != 0;
            d->exponent -= scale;
        } else {
            d->count++;
            d->exponent += 1 - scale;
        }
    }
    return p;
}

static const char *scan_exponent(const char *p, const char *end, decimal *d)
{
    const char *q = p + 1;
    bool minus = false;
    if (q < end && (*q == '+' || *q == '-'))
        minus = *q++ == '-';
    if (q >= end || *q < '0' || *q > '9')
        return p;
    int value = 0;
    for (; q < end && *q >= '0' && *q <= '9'; q++)
        if (value < 100000)
            value = value * 10 + (*q - '0');
    d->exponent += minus ? -value : value;
    return q;
}

/* Splits text into sign, digits and exponent; false where it is not a number. */
static bool scan_decimal(const char *text, const char *end, decimal *d)
{
    const char *p = text;
    *d = (decimal){0};
    if (p < end && (*p == '+' || *p == '-'))
        d->negative = *p++ == '-';
    const char *first = p;
    p = scan_digits(p, end, d, 0);
    int64_t seen = p - first;
    if (p < end && *p == '.') {
        const char *point = ++p;
        p = scan_digits(p, end, d, 1);
        seen += p - point;
    }
    if (!seen)
        return false;
    if (p < end && (*p == 'e' || *p == 'E'))
        p = scan_exponent(p, end, d);
    d->stop = p;
    return true;
}

/* strtod wants a NUL at the end: a copy, on the stack unless someone wrote a thousand digits. */
static int scan_slow(const char *text, const char *stop, double *value)
{
    char small[128];
    size_t n = (size_t)(stop - text);
    char *copy = n < sizeof small ? small : malloc(n + 1);
    if (!copy)
        return -1;
    memcpy(copy, text, n);
    copy[n] = 0;
    *value = strtod(copy, NULL);
    if (copy != small)
        free(copy);
    return isfinite(*value) ? 0 : -1;
}

/* Reads a number of up to 15 digits about a point, as most are. Returns 1 with the number; or 0 where scan_decimal has
 * to look closer: an exponent, more digits, or the text's end nearby. 15 digits are below 2^53, and no power of ten
 * past 1e22 can come up. */
static int scan_plain(const char *text, const char *end, const char **stop, double *value)
{
    const char *p = text;
    uint64_t digits = 0;
    if (end - text < 40)
        return 0;
    bool negative = *p == '-';
    const char *first = p += negative;
    for (; (unsigned)(*p - '0') < 10 && p - first < 16; p++)
        digits = digits * 10 + (unsigned)(*p - '0');
    int64_t count = p - first, after = 0;
    if (*p == '.') {
        const char *point = ++p;
        for (; (unsigned)(*p - '0') < 10 && p - point < 16; p++)
            digits = digits * 10 + (unsigned)(*p - '0');
        after = p - point;
    }
    if (!(count + after) || count + after > 15 || (*p | 0x20) == 'e')
        return 0;
    double v = (double)digits / ten_to[after];
    *value = negative ? -v : v;
    if (stop)
        *stop = p;
    return 1;
}

/* digits / 10^places, rounded once, for digits that are not 0 and up to 19 places: the quotient of integers whose top
 * bits are set has 63 or 64 bits, ten or more past a double's, and the last of them stands for what is left over. */
static double divide(uint64_t digits, int places)
{
    static const uint64_t ten[] = {UINT64_C(1),
                                   UINT64_C(10),
                                   UINT64_C(100),
                                   UINT64_C(1000),
                                   UINT64_C(10000),
                                   UINT64_C(100000),
                                   UINT64_C(1000000),
                                   UINT64_C(10000000),
                                   UINT64_C(100000000),
                                   UINT64_C(1000000000),
                                   UINT64_C(10000000000),
                                   UINT64_C(100000000000),
                                   UINT64_C(1000000000000),
                                   UINT64_C(10000000000000),
                                   UINT64_C(100000000000000),
                                   UINT64_C(1000000000000000),
                                   UINT64_C(10000000000000000),
                                   UINT64_C(100000000000000000),
                                   UINT64_C(1000000000000000000),
                                   UINT64_C(10000000000000000000)};
    __extension__ typedef unsigned __int128 wide;
    int up = __builtin_clzll(digits), by = __builtin_clzll(ten[places]);
    uint64_t divisor = ten[places] << by;
    wide dividend = (wide)(digits << up) << 63;
    uint64_t quotient = (uint64_t)(dividend / divisor);
    bool over = (wide)quotient * divisor != dividend;
    return ldexp((double)(quotient | over), by - up - 63);
}

int num_scan(const char *text, const char *end, const char **stop, double *value)
{
    decimal d;
    if (scan_plain(text, end, stop, value))
        return 0;
    if (!scan_decimal(text, end, &d))
        return -1;
    if (stop)
        *stop = d.stop;
    /* Clinger's fast path: both the digits and the power are exact, so one operation rounds correctly. */
    if (d.count <= 19 && d.digits <= (UINT64_C(1) << 53) && d.exponent >= -22 && d.exponent <= 22) {
        double v = (double)d.digits;
        v = d.exponent < 0 ? v / ten_to[-d.exponent] : v * ten_to[d.exponent];
        *value = d.negative ? -v : v;
        return 0;
    }
    if (d.count <= 19 && d.digits && d.exponent >= -19 && d.exponent <= 0) {
        *value = divide(d.digits, -d.exponent);
        *value = d.negative ? -*value : *value;
        return 0;
    }
    return scan_slow(text, d.stop, value);
}

int num_double(const char *text, double *value)
{
    const char *end = text + strlen(text), *stop;
    return num_scan(text, end, &stop, value) || stop != end ? -1 : 0;
}

int num_int(const char *text, int64_t low, int64_t high, int64_t *value)
{
    char *stop;
    if (!isdigit((unsigned char)text[text[0] == '-' || text[0] == '+']))
        return -1;
    errno = 0;
    long long v = strtoll(text, &stop, 10);
    if (errno || *stop || v < low || v > high)
        return -1;
    *value = v;
    return 0;
}

static const struct {
    const char *name;
    num_unit unit;
} units[] = {{"um", 1}, {"mm", 1000}, {"cm", 10000}, {"m", 1000000}, {"in", 25400}};

enum { UNITS = sizeof units / sizeof *units };

num_unit num_unit_of(const char *name)
{
    for (int i = 0; i < UNITS; i++)
        if (!strcasecmp(name, units[i].name))
            return units[i].unit;
    return 0;
}

const char *num_unit_name(num_unit unit)
{
    for (int i = 0; i < UNITS; i++)
        if (units[i].unit == unit)
            return units[i].name;
    return "?";
}

int num_length_of(const char *text, num_length *length)
{
    const double most = 1e300; /* finite in any unit */
    const char *end = text + strlen(text), *stop;
    if (num_scan(text, end, &stop, &length->value) || !(fabs(length->value) <= most))
        return -1;
    length->unit = *stop ? num_unit_of(stop) : 0;
    return *stop && !length->unit ? -1 : 0;
}

double num_length_in(num_length length, num_unit unsuffixed, num_unit to)
{
    num_unit from = length.unit ? length.unit : unsuffixed;
    num_unit more = from / to, fewer = to / from;
    if (more * to == from)
        return length.value * more;
    if (fewer * from == to)
        return length.value / fewer;
    return length.value * from / to;
}

int num_pressure_of(const char *text, double *pressure)
{
    static const struct {
        const char *name;
        double pascals;
    } known[] = {{"", 1}, {"Pa", 1}, {"kPa", 1e3}, {"mmHg", 133.322387415}};
    const char *end = text + strlen(text), *stop;
    double value;
    if (num_scan(text, end, &stop, &value))
        return -1;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (!strcmp(stop, known[i].name)) {
            *pressure = value * known[i].pascals;
            return isfinite(*pressure) ? 0 : -1;
        }
    return -1;
}

/* Copies the item of a comma list that begins at *p into item and steps past its comma; false at the end. One that
 * is too long for a number becomes "?", which is none. */
static bool list_item(const char **p, char *item, size_t size)
{
    if (!*p)
        return false;
    const char *comma = strchr(*p, ',');
    size_t n = comma ? (size_t)(comma - *p) : strlen(*p);
    bool fits = n < size;
    const char *from = fits ? *p : "?";
    n = fits ? n : 1;
    memcpy(item, from, n);
    item[n] = 0;
    *p = comma ? comma + 1 : NULL;
    return true;
}

static const char size_prefixes[] = " kMGTP";

int num_size_of(const char *text, int64_t *bytes)
{
    const char *end = text + strlen(text), *unit;
    double value;
    if (num_scan(text, end, &unit, &value))
        return -1;
    unit += strspn(unit, " ");
    const char letter = *unit == 'K' ? 'k' : *unit;
    const char *prefix = letter && letter != ' ' ? strchr(size_prefixes, letter) : NULL;
    unit += prefix != NULL;
    const bool binary = prefix && *unit == 'i';
    unit += binary;
    if (strcmp(unit, "B") != 0)
        return -1;
    if (prefix)
        value *= pow(binary ? 1024 : 1000, (double)(prefix - size_prefixes));
    if (!(value >= 1 && value < 9e18))
        return -1;
    *bytes = (int64_t)value;
    return 0;
}

char *num_size_text(double bytes, char *to)
{
    int prefix = 0;
    for (; bytes >= 999.5 && size_prefixes[prefix + 1]; prefix++)
        bytes /= 1000;
    snprintf(to, NUM_TEXT, prefix ? "%.3g %cB" : "%.0f B", bytes, size_prefixes[prefix]);
    return to;
}

int num_lengths_of(const char *text, num_length *list, int most)
{
    char item[64];
    int n = 0;
    while (list_item(&text, item, sizeof item))
        if (n == most || num_length_of(item, &list[n++]))
            return -1;
    return n;
}

int num_list(const char *text, double *list, int most)
{
    char item[64];
    int n = 0;
    while (list_item(&text, item, sizeof item))
        if (n == most || num_double(item, &list[n++]))
            return -1;
    return n;
}

static bool is_white(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

int num_words(const char *text, const char *end, double *list, int most)
{
    int n = 0;
    for (; text < end; text++) {
        if (is_white(*text))
            continue;
        if (n == most || num_scan(text, end, &text, &list[n++]) || (text < end && !is_white(*text)))
            return -1;
    }
    return n;
}

int num_text(double value, bool single, char *to)
{
    if (isnan(value))
        return snprintf(to, NUM_TEXT, "nan");
    int n = 0;
    const int most = single ? 9 : 17;
    for (int digits = single ? 6 : 15; digits <= most; digits++) {
        n = snprintf(to, NUM_TEXT, "%.*g", digits, value);
        if (single ? strtof(to, NULL) == (float)value : strtod(to, NULL) == value)
            break;
    }
    return n;
}
