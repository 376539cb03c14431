#include "bind/normals.h"

#include <math.h>
#include <string.h>

static double length(const double *v)
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* det(F) F^-T n: the cofactors of F applied to n. They carry areas (Nanson), so that sides stay sides even where an
 * element is turned inside out. */
static void carry(const double *f, const double *n, double *to)
{
    for (int i = 0; i < 3; i++) {
        int p = (i + 1) % 3, q = (i + 2) % 3;
        to[i] = 0;
        for (int j = 0; j < 3; j++) {
            int r = (j + 1) % 3, s = (j + 2) % 3;
            to[i] += (f[3 * p + r] * f[3 * q + s] - f[3 * p + s] * f[3 * q + r]) * n[j];
        }
    }
}

static void add_corner(const motion *m, const bone *carried, int64_t vertex, bool held, const double *n, double *sum)
{
    double f[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, to[3];
    if (!held)
        bone_gradient(carried, m, vertex, f);
    carry(f, n, to);
    double l = length(to);
    for (int i = 0; l > 0 && i < 3; i++)
        sum[i] += to[i] / l;
}

/* Makes the sum a unit vector, or the normal as it was where it did not turn. */
static void settle(const double *was, double *sum)
{
    double l = length(sum), before = length(was), turned = 0;
    for (int i = 0; i < 3; i++) {
        sum[i] /= l;
        turned = fmax(turned, fabs(sum[i] - was[i] / before));
    }
    if (!(l > 0 && before > 0 && turned > 1e-9))
        memcpy(sum, was, 3 * sizeof *was);
}

void normals_deform(const obj *o, const motion *m, const bone *carried, const bool *held, double *normal)
{
    memset(normal, 0, 3 * (size_t)o->normals * sizeof *normal);
    for (int64_t c = 0; c < o->corners; c++) {
        int64_t n = o->corner_normal[c], v = o->corner_vertex[c];
        if (n >= 0)
            add_corner(m, carried, v, held && held[v], &o->normal[3 * n], &normal[3 * n]);
    }
    for (int64_t n = 0; n < o->normals; n++)
        settle(&o->normal[3 * n], &normal[3 * n]);
}

/* Columns of a corner: its two edges and the unit normal between them. false where it has no area. */
static bool corner_frame(const obj *o, const double *position, int64_t face, int64_t corner, double to[3][3])
{
    const int64_t from = o->face_start[face], count = o->face_start[face + 1] - from, c = corner - from;
    const double *x = position + 3 * (int64_t)o->corner_vertex[corner];
    const double *next = position + 3 * (int64_t)o->corner_vertex[from + (c + 1) % count];
    const double *last = position + 3 * (int64_t)o->corner_vertex[from + (c + count - 1) % count];
    for (int a = 0; a < 3; a++) {
        to[0][a] = next[a] - x[a];
        to[1][a] = last[a] - x[a];
    }
    for (int a = 0; a < 3; a++)
        to[2][a] = to[0][(a + 1) % 3] * to[1][(a + 2) % 3] - to[0][(a + 2) % 3] * to[1][(a + 1) % 3];
    const double l = length(to[2]);
    for (int a = 0; a < 3; a++)
        to[2][a] /= l;
    return count > 2 && l > 0;
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void add_cross(double times, const double *a, const double *b, double *to)
{
    for (int i = 0; i < 3; i++)
        to[i] += times * (a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
}

/* With the columns a, b, n at rest and A, B, N now, F^-T has n . a, n . b and n . n as components along the dual
 * columns of (A, B, N), which are (B x N), (N x A) and (A x B) over their determinant. */
static void turn_corner(double was[3][3], double now[3][3], const double *n, double *sum)
{
    double to[3] = {0}, area[3] = {0};
    add_cross(1, now[0], now[1], area);
    add_cross(dot(n, was[0]), now[1], now[2], to);
    add_cross(dot(n, was[1]), now[2], now[0], to);
    add_cross(dot(n, was[2]), now[0], now[1], to);
    const double l = length(to);
    for (int i = 0; l > 0 && length(area) > 0 && i < 3; i++)
        sum[i] += to[i] / l;
}

void normals_turn(const obj *o, const double *position, double *normal)
{
    double was[3][3], now[3][3];
    memset(normal, 0, 3 * (size_t)o->normals * sizeof *normal);
    for (int64_t f = 0; f < o->faces && o->normals; f++)
        for (int64_t c = o->face_start[f]; c < o->face_start[f + 1]; c++) {
            const int64_t n = o->corner_normal[c];
            if (n >= 0 && corner_frame(o, o->position, f, c, was) && corner_frame(o, position, f, c, now))
                turn_corner(was, now, &o->normal[3 * n], &normal[3 * n]);
        }
    for (int64_t n = 0; n < o->normals; n++)
        settle(&o->normal[3 * n], &normal[3 * n]);
}
