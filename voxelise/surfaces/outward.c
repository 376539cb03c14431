#include "voxelise/surfaces/outward.h"

#include "base/mem.h"
#include "surface/coincident.h"

#include <math.h>
#include <stdlib.h>

static const double least_cosine = .866025; /* of 30 degrees */

struct outward {
    const double *corner; /* triangles x 9 */
    int64_t triangles;
    triangle_tree *tree;
    double *face;   /* triangles x 3: unit, or 0 0 0 */
    double *at;     /* places x 3: unit, or 0 0 0 */
    int32_t *place; /* corners */
};

/* Makes v a unit vector, or 0 0 0 where it has hardly any length. */
static void make_unit(double *v)
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int a = 0; a < 3; a++)
        v[a] = length > 1e-300 ? v[a] / length : 0;
}

/* Twice the triangle's area along its normal. */
static void area_of(const double *corner, double *n)
{
    double p[3], q[3];
    for (int a = 0; a < 3; a++) {
        p[a] = corner[3 + a] - corner[a];
        q[a] = corner[6 + a] - corner[a];
    }
    for (int a = 0; a < 3; a++)
        n[a] = p[(a + 1) % 3] * q[(a + 2) % 3] - p[(a + 2) % 3] * q[(a + 1) % 3];
}

/* The normals of triangles, and the means at the places of their corners. */
static int find_skin(outward *o, err *e)
{
    o->place = mem_array(3 * o->triangles, sizeof *o->place, "a skin's normals", e);
    const int64_t places = o->place ? coincident_places(o->corner, 3 * o->triangles, o->place, e) : -1;
    o->face = places >= 0 ? mem_array(3 * o->triangles, sizeof *o->face, "a skin's normals", e) : NULL;
    o->at = o->face ? mem_array(3 * places, sizeof *o->at, "a skin's normals", e) : NULL;
    if (!o->at)
        return -1;
    for (int64_t t = 0; t < o->triangles; t++) {
        double *n = o->face + 3 * t;
        area_of(o->corner + 9 * t, n);
        for (int k = 0; k < 9; k++)
            o->at[3 * (int64_t)o->place[3 * t + k / 3] + k % 3] += n[k % 3];
        make_unit(n);
    }
    for (int64_t p = 0; p < places; p++)
        make_unit(o->at + 3 * p);
    return 0;
}

static int grow_tree(outward *o, err *e)
{
    int32_t *corner = mem_array(3 * o->triangles, sizeof *corner, "a skin's normals", e);
    for (int64_t i = 0; corner && i < 3 * o->triangles; i++)
        corner[i] = (int32_t)i;
    o->tree = corner ? triangle_tree_create(o->corner, corner, o->triangles, e) : NULL;
    free(corner);
    return o->tree ? 0 : -1;
}

/* The shares of the corners at a point of the triangle: areas over the whole, or the first corner where it has none. */
static void shares_at(const double *corner, const double *n, const double *point, double *share)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        const double *x = corner + 3 * ((i + 1) % 3), *y = corner + 3 * ((i + 2) % 3);
        double part[9], area[3];
        for (int a = 0; a < 3; a++)
            part[a] = point[a], part[3 + a] = x[a], part[6 + a] = y[a];
        area_of(part, area);
        share[i] = fmax(area[0] * n[0] + area[1] * n[1] + area[2] * n[2], 0);
        sum += share[i];
    }
    for (int i = 0; i < 3; i++)
        share[i] = sum > 0 ? share[i] / sum : i == 0;
}

/* The normal that the skin has at a hit. */
static void normal_at(const outward *o, const triangle_hit *hit, double *normal)
{
    const double *face = o->face + 3 * hit->triangle;
    double share[3];
    shares_at(o->corner + 9 * hit->triangle, face, hit->point, share);
    for (int a = 0; a < 3; a++)
        normal[a] = 0;
    for (int i = 0; i < 3; i++) {
        const double *mean = o->at + 3 * (int64_t)o->place[3 * hit->triangle + i];
        const bool is_smooth = mean[0] * face[0] + mean[1] * face[1] + mean[2] * face[2] >= least_cosine;
        for (int a = 0; a < 3; a++)
            normal[a] += share[i] * (is_smooth ? mean : face)[a];
    }
    make_unit(normal);
}

outward *outward_create(const double *corner, int64_t triangles, err *e)
{
    outward *o = mem_array(1, sizeof *o, "a skin's normals", e);
    if (!o)
        return NULL;
    *o = (outward){.corner = corner, .triangles = triangles};
    if (!find_skin(o, e) && !grow_tree(o, e))
        return o;
    outward_free(o);
    return NULL;
}

void outward_free(outward *o)
{
    if (!o)
        return;
    triangle_tree_destroy(o->tree);
    free(o->face);
    free(o->at);
    free(o->place);
    free(o);
}

triangle_hit outward_at(const outward *o, const double place[3], int64_t guess, double normal[3])
{
    const triangle_hit hit = triangle_tree_nearest(o->tree, place, guess);
    normal_at(o, &hit, normal);
    return hit;
}
