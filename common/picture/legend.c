#include "picture/legend.h"

#include "base/mem.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const float ink[3] = {.012f, .012f, .012f};

int legend_ticks(double low, double high, int most, double tick[LEGEND_TICKS], int *decimals)
{
    static const double steps[] = {1, 2, 5, 10};
    double ten = pow(10, floor(log10((high - low) / most))), step = 10 * ten;
    *decimals = 0;
    if (!(high > low)) {
        tick[0] = low;
        return 1;
    }
    for (int i = 3; i >= 0; i--)
        if (floor(high / (steps[i] * ten) + 1e-9) - ceil(low / (steps[i] * ten) - 1e-9) < most)
            step = steps[i] * ten;
    int count = 0;
    double first = ceil(low / step - 1e-9);
    while (count < LEGEND_TICKS && (first + count) * step <= high + 1e-9 * step) {
        tick[count] = (first + count) * step;
        count++;
    }
    *decimals = (int)fmax(0, -floor(log10(step) + 1e-9));
    return count;
}

static void fill(image *im, int x, int y, int width, int height, const float colour[3])
{
    for (int r = y < 0 ? 0 : y; r < y + height && r < im->height; r++)
        for (int c = x < 0 ? 0 : x; c < x + width && c < im->width; c++) {
            float *p = &im->pixel[4 * ((int64_t)r * im->width + c)];
            memcpy(p, colour, 3 * sizeof *colour);
            p[3] = 1;
        }
}

/* A disc with a soft rim. */
static void disc(image *im, double x, double y, double radius, const float colour[3])
{
    for (int r = (int)(y - radius) - 1; r <= y + radius + 1; r++)
        for (int c = (int)(x - radius) - 1; c <= x + radius + 1; c++) {
            float a = (float)fmin(fmax(radius + .5 - hypot(c + .5 - x, r + .5 - y), 0), 1);
            if (r < 0 || c < 0 || r >= im->height || c >= im->width)
                continue;
            float *p = &im->pixel[4 * ((int64_t)r * im->width + c)];
            for (int i = 0; i < 4; i++)
                p[i] = a * (i < 3 ? colour[i] : 1) + (1 - a) * p[i];
        }
}

int legend_bar_height(int size)
{
    return (int)lround(4.2 * size);
}

static void number(double value, int decimals, bool round, char *to, size_t size)
{
    if (!round)
        snprintf(to, size, "%.4g", value);
    else if (decimals > 4 || fabs(value) >= 1e6)
        snprintf(to, size, "%.3g", value);
    else
        snprintf(to, size, "%.*f", decimals, value == 0 ? 0 : value);
}

void legend_bar(image *im, font *f, int size, int x, int y, int width, const colourmap *map, double low, double high,
                const char *words)
{
    int long_ = width - 3 * size < 26 * size ? width - 3 * size : 26 * size;
    int left = x + (width - long_) / 2, top = y + (int)lround(1.5 * size), thick = size, decimals;
    double tick[LEGEND_TICKS];
    int most = (int)fmin(fmax(long_ / (3.5 * size), 3), 10), ticks = legend_ticks(low, high, most, tick, &decimals);
    font_draw_middle(f, im, x + width / 2, x, x + width, y + size, words, ink);
    for (int c = 0; c < long_; c++) {
        float colour[3];
        colourmap_at(map, high > low ? (c + .5) / long_ : 0, colour);
        fill(im, left + c, top, 1, thick, colour);
    }
    for (int i = 0; i < ticks; i++) {
        char text[40];
        int at = left + (high > low ? (int)lround((tick[i] - low) / (high - low) * (long_ - 1)) : 0);
        number(tick[i], decimals, high > low, text, sizeof text);
        fill(im, at, top + thick, 1, size / 4 + 1, ink);
        font_draw_middle(f, im, at, x, x + width, top + thick + (int)lround(1.35 * size), text, ink);
    }
}

/* Where a key begins that takes `wide` pixels after what is on the row; a new row where it does not fit. */
static bool next_row(int *at, int wide, int width)
{
    bool is = *at && *at + wide > width;
    *at = is ? wide : *at + wide;
    return is;
}

static int key_width(font *f, int size, const legend_key *key)
{
    return font_width(f, key->words) + 3 * size;
}

int legend_keys_height(font *f, int size, int width, const legend_key *key, int keys)
{
    int rows = 1, at = 0;
    for (int i = 0; i < keys; i++)
        rows += next_row(&at, key_width(f, size, &key[i]), width);
    return (int)lround((1.6 * rows + .4) * size);
}

static int put_key(image *im, font *f, int size, int x, int y, int most, const legend_key *key, err *e)
{
    char *words = mem_array((int64_t)strlen(key->words) + 4, 1, "a legend", e);
    if (!words)
        return -1;
    font_shorten(f, key->words, most, words);
    if (key->round)
        disc(im, x + .5 * size, y + .65 * size, .45 * size, key->colour);
    else
        fill(im, x, y + size / 5, size * 9 / 10, size * 9 / 10, key->colour);
    font_draw(f, im, x + (int)lround(1.4 * size), y + size, words, ink);
    free(words);
    return 0;
}

int legend_keys(image *im, font *f, int size, int x, int y, int width, const legend_key *key, int keys, err *e)
{
    for (int from = 0, row = 0; from < keys; row++) {
        int at = 0, to = from;
        do
            at += key_width(f, size, &key[to++]);
        while (to < keys && at + key_width(f, size, &key[to]) <= width);
        int left = x + (at < width + 2 * size ? (width + 2 * size - at) / 2 : size / 2);
        for (; from < to; left += key_width(f, size, &key[from++]))
            if (put_key(im, f, size, left, y + (int)lround(1.6 * row * size),
                        x + width - left - (int)lround(1.4 * size), &key[from], e))
                return -1;
    }
    return 0;
}
