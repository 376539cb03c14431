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
