#include "slice/contour/contour_obj.h"

#include "base/num.h"

#include <math.h>
#include <string.h>

enum { LINES = 256, LINE = 128 };

/* Millimetres to a fixed number of decimals, without the zeros at the end. */
typedef struct places {
    int decimals;
    double scale, most;
} places;

/* A hundred thousandth of a voxel, so that no two vertices fall together. */
static places places_of(const volume *v)
{
    places p = {.scale = 1};
    double least = fmin(volume_spacing(v, 0), fmin(volume_spacing(v, 1), volume_spacing(v, 2)));
    while (p.decimals < 12 && p.scale * least < 1e5) {
        p.decimals++;
        p.scale *= 10;
    }
    p.most = 9e15 / p.scale;
    return p;
}

static char *put_integer(char *to, uint64_t n)
{
    char digit[20];
    int count = 0;
    do
        digit[count++] = (char)('0' + n % 10);
    while (n /= 10);
    while (count)
        *to++ = digit[--count];
    return to;
}

static char *put_number(char *to, double value, const places *p)
{
    if (!(fabs(value) < p->most))
        return to + num_text(value, false, to);
    uint64_t n = (uint64_t)(fabs(value) * p->scale + .5), unit = (uint64_t)p->scale, whole = n / unit, rest = n % unit;
    if (value < 0 && n)
        *to++ = '-';
    to = put_integer(to, whole);
    if (!rest)
        return to;
    *to++ = '.';
    int digits = p->decimals;
    for (; rest % 10 == 0; rest /= 10)
        digits--;
    for (int i = digits - 1; i >= 0; i--, rest /= 10)
        to[i] = (char)('0' + rest % 10);
    return to + digits;
}

static void write_vertices(const contour *c, const volume *v, const samples_box *box, out *to)
{
    places p = places_of(v);
    char text[LINES * LINE], *end = text;
    for (int64_t i = 0; i < c->vertices; i++) {
        double at[3], place[3];
        for (int a = 0; a < 3; a++)
            at[a] = c->position[3 * i + a] + (double)box->low[a];
        volume_place(v, at, place);
        *end++ = 'v';
        for (int a = 0; a < 3; a++) {
            *end++ = ' ';
            end = put_number(end, 1e3 * place[a], &p);
        }
        *end++ = '\n';
        if (end > text + sizeof text - LINE) {
            out_write(to, text, (size_t)(end - text));
            end = text;
        }
    }
    out_write(to, text, (size_t)(end - text));
}

static void write_triangles(const contour *c, bool turned, int64_t before, out *to)
{
    char text[LINES * LINE], *end = text;
    for (int64_t t = 0; t < c->triangles; t++) {
        const int32_t *v = c->triangle + 3 * t;
        *end++ = 'f';
        for (int k = 0; k < 3; k++) {
            *end++ = ' ';
            end = put_integer(end, (uint64_t)(before + 1 + v[turned && k ? 3 - k : k]));
        }
        *end++ = '\n';
        if (end > text + sizeof text - LINE) {
            out_write(to, text, (size_t)(end - text));
            end = text;
        }
    }
    out_write(to, text, (size_t)(end - text));
}

void contour_write(const contour *c, const volume *v, const samples_box *box, const char *group, int64_t before,
                   out *to)
{
    out_format(to, "g %s\n", group);
    write_vertices(c, v, box, to);
    write_triangles(c, volume_handed(v) < 0, before, to);
}
