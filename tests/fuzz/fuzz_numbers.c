// needs: slice/image/slice_view.c
/* Any text as what people write on a command line: numbers, lengths, lists, a pattern of names, an array, a size of
 * images. Each reader takes it, and then it is what it says, or refuses it.
 */
#include "base/num.h"
#include "cli/numbered.h"
#include "slice/image/slice_view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void must(bool good)
{
    if (!good)
        abort();
}

/* A number reads back from its shortest text. */
static void check_number(double value)
{
    char text[NUM_TEXT];
    double again;
    num_text(value, false, text);
    must(!num_double(text, &again) && again == value);
}

static void numbers(const char *text)
{
    double value, list[6];
    const char *stop, *end = text + strlen(text);
    int64_t whole;
    if (!num_double(text, &value)) {
        char *other;
        must(isfinite(value) && strtod(text, &other) == value && !*other);
        check_number(value);
    }
    if (!num_scan(text, end, &stop, &value))
        must(stop > text && stop <= end && isfinite(value));
    if (!num_int(text, -5, 1000000007, &whole))
        must(whole >= -5 && whole <= 1000000007);
    if (!num_int(text, INT64_MIN, INT64_MAX, &whole))
        must(strtoll(text, NULL, 10) == whole);
    int count = num_list(text, list, 6);
    must(count <= 6);
    for (int i = 0; i < count; i++)
        must(isfinite(list[i]));
}

static void lengths(const char *text)
{
    num_length one, list[6];
    if (!num_length_of(text, &one)) {
        must(isfinite(one.value) && one.unit >= 0);
        must(!one.unit || num_unit_of(num_unit_name(one.unit)) == one.unit);
        num_length_in(one, num_unit_of("mm"), num_unit_of("m"));
    }
    int count = num_lengths_of(text, list, 6);
    must(count <= 6);
    for (int i = 0; i < count; i++)
        must(isfinite(list[i].value));
}

static void pattern(const char *text)
{
    numbered n;
    err e = {0};
    if (numbered_of(&n, text, "", &e)) {
        must(e.status == STATUS_USAGE && *e.text);
        return;
    }
    must(numbered_is(text));
    char *name = numbered_name(&n, 1234, &e);
    must(name && strstr(name, "1234"));
    free(name);
}

static void images(const char *text)
{
    slice_probe p = {0};
    slice_size s = {0};
    err e = {0};
    int got = slice_probe_of(&p, text, &e);
    must((got < 0) == (e.status != 0));
    if (!got)
        must(p.array == SLICE_LINEAR ? p.width > 0 && isfinite(p.width)
                                     : p.radius >= 0 && isfinite(p.radius) && p.angle > 0 && p.angle < 3.2);
    e = (err){0};
    got = slice_size_of(&s, text, &e);
    must((got < 0) == (e.status != 0));
    if (!got)
        must(s.columns >= 0 && s.rows >= 0 && s.columns + s.rows > 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    if (!text)
        return 0;
    if (size)
        memcpy(text, data, size);
    text[size] = '\0';
    numbers(text);
    lengths(text);
    if (size < 4096)
        pattern(text);
    images(text);
    free(text);
    return 0;
}
