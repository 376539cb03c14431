/* The part of a box that half spaces enclose, as a polyhedron: its volume, its moments, and what a constant traction on
 * its faces does to the box's corners, all to rounding. For tests of elements that are cut; shares no code with them.
 */
#ifndef SINEW_CUT_PART_H
#define SINEW_CUT_PART_H

#include <math.h>
#include <string.h>

enum { PART_FACES = 16, PART_CORNERS = 24 };

/* A face: a polygon in the box's own coordinates, -1 to 1, turned out. */
typedef struct part_face {
    int corners;
    double at[PART_CORNERS][3];
} part_face;

typedef struct part {
    int faces;
    part_face face[PART_FACES];
} part;

static inline part part_box(void)
{
    part p = {.faces = 6};
    for (int f = 0; f < 6; f++) {
        const int a = f / 2, b = (a + 1) % 3, c = (a + 2) % 3;
        const double side = f % 2 ? 1 : -1;
        p.face[f].corners = 4;
        for (int i = 0; i < 4; i++) {
            const double u = i == 0 || i == 3 ? -1 : 1;
            const double v = i < 2 ? -1 : 1;
            p.face[f].at[i][a] = side;
            p.face[f].at[i][b] = f % 2 ? u : v;
            p.face[f].at[i][c] = f % 2 ? v : u;
        }
    }
    return p;
}

static inline void part_cross(const double a[3], const double b[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static inline double part_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Sorts the corners of a face about its middle, turned along n. */
static inline void part_sort(part_face *f, const double n[3])
{
    double middle[3] = {0}, u[3], v[3], angle[PART_CORNERS];
    const double axis[3] = {fabs(n[0]) < .5, fabs(n[0]) >= .5, 0};
    part_cross(n, axis, u);
    part_cross(n, u, v);
    for (int i = 0; i < f->corners; i++)
        for (int a = 0; a < 3; a++)
            middle[a] += f->at[i][a] / f->corners;
    for (int i = 0; i < f->corners; i++) {
        const double d[3] = {f->at[i][0] - middle[0], f->at[i][1] - middle[1], f->at[i][2] - middle[2]};
        angle[i] = atan2(part_dot(d, v), part_dot(d, u));
        for (int k = i; k > 0 && angle[k] < angle[k - 1]; k--) {
            double t = angle[k], x[3];
            angle[k] = angle[k - 1], angle[k - 1] = t;
            memcpy(x, f->at[k], sizeof x);
            memcpy(f->at[k], f->at[k - 1], sizeof x);
            memcpy(f->at[k - 1], x, sizeof x);
        }
    }
}

/* What n.x <= d leaves, n of length 1; the new face is the last, if there is one. */
static inline part part_clip(const part *p, const double n[3], double d)
{
    part to = {0};
    part_face lid = {0};
    for (int f = 0; f < p->faces; f++) {
        const part_face *from = &p->face[f];
        part_face *face = &to.face[to.faces];
        face->corners = 0;
        for (int i = 0; i < from->corners; i++) {
            const double *a = from->at[i], *b = from->at[(i + 1) % from->corners];
            const double da = part_dot(n, a) - d, db = part_dot(n, b) - d;
            if (da <= 0)
                memcpy(face->at[face->corners++], a, 3 * sizeof *a);
            if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
                double x[3];
                for (int k = 0; k < 3; k++)
                    x[k] = a[k] + (b[k] - a[k]) * da / (da - db);
                memcpy(face->at[face->corners++], x, sizeof x);
                if (da < 0) /* each edge is in two faces, the other way round */
                    memcpy(lid.at[lid.corners++], x, sizeof x);
            }
        }
        to.faces += face->corners >= 3;
    }
    if (lid.corners >= 3) {
        part_sort(&lid, n);
        to.face[to.faces++] = lid;
    }
    return to;
}

/* Gauss's three points of 0 to 1. */
static const double part_point[3] = {.1127016653792583, .5, .8872983346207417},
                    part_weight[3] = {5. / 18, 4. / 9, 5. / 18};

/* 1 and the seven products of coordinates. */
static inline void part_products(const double x[3], double to[8])
{
    const double all[8] = {1, x[0], x[1], x[2], x[0] * x[1], x[1] * x[2], x[2] * x[0], x[0] * x[1] * x[2]};
    memcpy(to, all, sizeof all);
}

/* Adds the integrals of the products over the tetrahedron of 0 and a triangle, in the box's own coordinates. */
static inline void part_add_tetra(const double a[3], const double b[3], const double c[3], double sum[8])
{
    double n[3];
    part_cross(b, c, n);
    const double six = part_dot(a, n);
    for (int i = 0; i < 27; i++) {
        const double r = part_point[i % 3], s = part_point[i / 3 % 3], t = part_point[i / 9];
        const double w = part_weight[i % 3] * part_weight[i / 3 % 3] * part_weight[i / 9] * r * r * s;
        double x[3], all[8];
        for (int k = 0; k < 3; k++)
            x[k] = r * ((1 - s) * a[k] + s * ((1 - t) * b[k] + t * c[k]));
        part_products(x, all);
        for (int k = 0; k < 8; k++)
            sum[k] += six * w * all[k];
    }
}

/* Its share of the box, and its moments: x, y, z, xy, yz, zx, xyz. */
static inline double part_moments(const part *p, double moments[7])
{
    double sum[8] = {0};
    for (int f = 0; f < p->faces; f++)
        for (int i = 2; i < p->face[f].corners; i++)
            part_add_tetra(p->face[f].at[0], p->face[f].at[i - 1], p->face[f].at[i], sum);
    for (int k = 0; k < 7; k++)
        moments[k] = sum[k + 1] / sum[0];
    return sum[0] / 8;
}

/* The integral of each corner's shape function over a face, times the normal there, in space (m2): nodes x 3. side: of
 * the box, m; sign: of each corner. */
static inline void part_add_face(const part_face *f, const double side[3], int sign[8][3], double to[8][3])
{
    for (int i = 2; i < f->corners; i++) {
        double e[2][3], n[3];
        for (int k = 0; k < 3; k++) {
            e[0][k] = (f->at[i - 1][k] - f->at[0][k]) * side[k] / 2;
            e[1][k] = (f->at[i][k] - f->at[0][k]) * side[k] / 2;
        }
        part_cross(e[0], e[1], n); /* twice the area */
        for (int q = 0; q < 9; q++) {
            const double r = part_point[q % 3], s = part_point[q / 3];
            const double w = part_weight[q % 3] * part_weight[q / 3] * r;
            double x[3], all[8];
            for (int k = 0; k < 3; k++)
                x[k] = f->at[0][k] + r * ((1 - s) * (f->at[i - 1][k] - f->at[0][k]) + s * (f->at[i][k] - f->at[0][k]));
            part_products(x, all);
            for (int c = 0; c < 8; c++) {
                const double u[3] = {sign[c][0], sign[c][1], sign[c][2]};
                double by[8], shape = 0;
                part_products(u, by);
                for (int k = 0; k < 8; k++)
                    shape += by[k] * all[k] / 8;
                for (int k = 0; k < 3; k++)
                    to[c][k] += w * n[k] * shape;
            }
        }
    }
}

#endif
