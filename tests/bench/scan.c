#include "scan.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>

/* A number from 0 to 1 that a vertex keeps, of its number and a choice. */
static double chance(int64_t vertex, uint64_t choice)
{
    uint64_t x = (uint64_t)vertex * 4 + choice + 1;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return (double)((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

/* A hill of height 1 about a direction. */
static double hill(const double *d, double x, double y, double z, double width)
{
    double dx = d[0] - x, dy = d[1] - y, dz = d[2] - z;
    return exp(-(dx * dx + dy * dy + dz * dz) / (width * width));
}

static double distance(const double *d)
{
    double r = 80 + 12 * d[2] * d[2] - 9 * d[0] * d[0];
    r += 14 * hill(d, 0, 1, -0.1, 0.15) + 9 * hill(d, 0.95, 0, 0, 0.12) + 9 * hill(d, -0.95, 0, 0, 0.12);
    r += 35 * hill(d, 0, -0.2, -1, 0.35) - 5 * hill(d, 0.35, 0.9, 0.25, 0.12) - 5 * hill(d, -0.35, 0.9, 0.25, 0.12);
    return r + 0.7 * sin(17 * d[0] + 3 * d[2]) * sin(13 * d[1]) + 0.3 * sin(41 * d[2] + 5 * d[0]);
}

/* Rings from pole to pole, of `round` vertices each; a place moves by less than a sixth of a
 * step, so that no triangle turns over. */
static void put_vertex(scan *s, int64_t at, int64_t rings, int64_t round)
{
    int64_t ring = at / round, turn = at % round;
    double step = M_PI / (double)(rings + 1), side = 2 * M_PI / (double)round;
    double polar = step * ((double)ring + 1 + 0.3 * (chance(at, 0) - 0.5));
    double azimuth = side * ((double)turn + 0.5 * (double)(ring % 2) + 0.3 * (chance(at, 1) - 0.5));
    double d[3] = {sin(polar) * cos(azimuth), sin(polar) * sin(azimuth), cos(polar)};
    double r = distance(d) + 0.05 * (chance(at, 2) - 0.5);
    for (int a = 0; a < 3; a++)
        s->position[3 * at + a] = r * d[a];
}

static void put_triangle(scan *s, int64_t a, int64_t b, int64_t c)
{
    int32_t *t = &s->vertex[3 * s->triangles++];
    t[0] = (int32_t)a, t[1] = (int32_t)b, t[2] = (int32_t)c;
}

static void put_triangles(scan *s, int64_t rings, int64_t round)
{
    int64_t top = rings * round, bottom = top + 1;
    for (int64_t i = 0; i < round; i++) {
        int64_t next = (i + 1) % round;
        put_triangle(s, top, i, next);
        for (int64_t ring = 0; ring + 1 < rings; ring++) {
            int64_t a = ring * round + i, b = ring * round + next, c = a + round, d = b + round;
            if (chance(a, 3) < 0.5) {
                put_triangle(s, a, c, d);
                put_triangle(s, a, d, b);
            } else {
                put_triangle(s, a, c, b);
                put_triangle(s, b, c, d);
            }
        }
        put_triangle(s, bottom, (rings - 1) * round + next, (rings - 1) * round + i);
    }
}

int scan_make(scan *s, int64_t triangles, err *e)
{
    int64_t round = (int64_t)sqrt((double)triangles), rings = triangles / 2 / round;
    *s = (scan){.vertices = rings * round + 2};
    s->position = mem_array(3 * s->vertices, sizeof *s->position, "a scan", e);
    s->vertex = mem_array(6 * rings * round, sizeof *s->vertex, "a scan", e);
    if (!s->position || !s->vertex) {
        scan_free(s);
        return -1;
    }
    for (int64_t at = 0; at < rings * round; at++)
        put_vertex(s, at, rings, round);
    double pole[3] = {0, 0, 1}, other[3] = {0, 0, -1};
    s->position[3 * rings * round + 2] = distance(pole);
    s->position[3 * rings * round + 5] = -distance(other);
    put_triangles(s, rings, round);
    return 0;
}

void scan_free(scan *s)
{
    free(s->position);
    free(s->vertex);
    *s = (scan){0};
}
