#include "picture/image.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int image_create(image *im, int width, int height, err *e)
{
    if (width < 1 || height < 1 || width > IMAGE_SIDE_MOST || height > IMAGE_SIDE_MOST)
        return err_set(e, NULL, 0, "a picture of %d x %d pixels; 1 to %d a side is expected", width, height,
                       IMAGE_SIDE_MOST);
    *im = (image){width, height, mem_array((int64_t)width * height, 4 * sizeof *im->pixel, "a picture", e)};
    return im->pixel ? 0 : -1;
}

void image_free(image *im)
{
    free(im->pixel);
    *im = (image){0};
}

void image_fill(image *im, const float rgba[4])
{
    for (int64_t i = 0; i < (int64_t)im->width * im->height; i++)
        memcpy(&im->pixel[4 * i], rgba, 4 * sizeof *rgba);
}

static void row_over(float *below, const float *above, int count)
{
    for (int x = 0; x < count; x++, below += 4, above += 4)
        for (int i = 0; i < 4; i++)
            below[i] = above[i] + (1 - above[3]) * below[i];
}

void image_over(image *im, const image *other, int x, int y)
{
    int left = x < 0 ? -x : 0;
    int top = y < 0 ? -y : 0;
    int right = other->width < im->width - x ? other->width : im->width - x;
    int bottom = other->height < im->height - y ? other->height : im->height - y;
    if (left >= right)
        return;
    for (int r = top; r < bottom; r++)
        row_over(&im->pixel[4 * ((int64_t)(y + r) * im->width + x + left)],
                 &other->pixel[4 * ((int64_t)r * other->width + left)], right - left);
}

/* ---- 8-bit sRGB (IEC 61966-2-1) */

static float linear_of(float s)
{
    return s <= .04045f ? s / 12.92f : powf((s + .055f) / 1.055f, 2.4f);
}

void image_linear(const uint8_t srgb[3], float linear[3])
{
    for (int i = 0; i < 3; i++)
        linear[i] = linear_of((float)srgb[i] / 255);
}

enum { GUESSES = 4096, CHUNK_ROWS = 16 };

/* code[k] is that of k / GUESSES, from[c] where code c begins: a look-up and mostly no step give the nearest code. */
typedef struct codes {
    uint8_t code[GUESSES + 1];
    float from[257];
} codes;

static void make_codes(codes *t)
{
    for (int c = 0; c < 256; c++)
        t->from[c] = c ? linear_of(((float)c - .5f) / 255) : -INFINITY;
    t->from[256] = INFINITY;
    int c = 0;
    for (int k = 0; k <= GUESSES; k++) {
        while ((float)k / GUESSES >= t->from[c + 1])
            c++;
        t->code[k] = (uint8_t)c;
    }
}

static uint8_t encode(const codes *t, float x)
{
    if (!(x > 0))
        x = 0;
    else if (x > 1)
        x = 1;
    int c = t->code[(int)(x * GUESSES)];
    while (x >= t->from[c + 1])
        c++;
    return (uint8_t)c;
}

typedef struct conversion {
    const image *im;
    int channels;
    uint8_t *out;
    codes table;
} conversion;

static void convert_rows(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)chunk;
    const conversion *c = context;
    const float *p = &c->im->pixel[4 * from * c->im->width];
    uint8_t *out = &c->out[c->channels * from * c->im->width];
    for (int64_t k = (to - from) * c->im->width; k > 0; k--, p += 4, out += c->channels) {
        bool whole = c->channels == 3 || p[3] >= 1;
        const float share = p[3] > 0 ? p[3] : 0;
        float scale = 1;
        if (!whole)
            scale = share > 0 ? 1 / share : 0;
        for (int i = 0; i < 3; i++)
            out[i] = encode(&c->table, scale * p[i]);
        if (c->channels == 4)
            out[3] = whole ? 255 : (uint8_t)lrintf(255 * share);
    }
}

void image_bytes(const image *im, int channels, uint8_t *out, pool *p)
{
    conversion c = {.im = im, .channels = channels};
    c.out = out;
    make_codes(&c.table);
    pool_run(p, im->height, CHUNK_ROWS, convert_rows, &c);
}
