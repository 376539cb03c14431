#include "voxelise/surfaces/thin.h"

#include "base/mem.h"
#include "surface/embree.h"

#include <math.h>
#include <stdlib.h>

/* A ray begins so far in, of a voxel, that it does not meet the triangle that it comes from. */
static const float begin = 1e-3f;

/* Positions in voxels from the middle of the surface, where a length of 1 is a voxel along each axis. */
static float *in_voxels(const double *position, int64_t vertices, const double *voxel, err *e)
{
    float *to = mem_array(3 * vertices, sizeof *to, "vertices", e);
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int64_t i = 0; to && i < 3 * vertices; i++) {
        low[i % 3] = fmin(low[i % 3], position[i]);
        high[i % 3] = fmax(high[i % 3], position[i]);
    }
    for (int64_t i = 0; to && i < 3 * vertices; i++)
        to[i] = (float)((position[i] - low[i % 3] / 2 - high[i % 3] / 2) / voxel[i % 3]);
    return to;
}

/* The normal, of a length that is twice the area. */
static void normal_of(const float *a, const float *b, const float *c, double *n)
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = ((double)b[j] - a[j]) * ((double)c[k] - a[k]) - ((double)b[k] - a[k]) * ((double)c[j] - a[j]);
    }
}

/* Sets up the ray of one triangle; returns its area (in voxels), 0 where it has none. */
static double aim(embree_packet *p, int ray, const float *place, const int32_t *v)
{
    const float *c[3] = {&place[3 * (int64_t)v[0]], &place[3 * (int64_t)v[1]], &place[3 * (int64_t)v[2]]};
    double n[3], most = 0;
    normal_of(c[0], c[1], c[2], n);
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int a = 0; a < 3; a++)
        most = fmax(most, fabs(n[a]));
    for (int a = 0; a < 3; a++) {
        p->from[a][ray] = (c[0][a] + c[1][a] + c[2][a]) / 3;
        /* One voxel along the axis that it runs most along. */
        p->along[a][ray] = most > 0 ? (float)(-n[a] / most) : 1;
    }
    p->start[ray] = begin;
    p->end[ray] = 1 - begin;
    return length / 2;
}

int thin_share(const double *position, int64_t vertices, const int32_t *vertex, int64_t triangles, const double *voxel,
               int threads, double *share, err *e)
{
    double all = 0, thin = 0;
    int status = -1;
    float *place = in_voxels(position, vertices, voxel, e);
    uint32_t *corner = mem_array(3 * triangles, sizeof *corner, "triangles", e);
    embree *tree = place && corner ? embree_create(threads, e) : NULL;
    if (!tree)
        goto out;
    for (int64_t i = 0; i < 3 * triangles; i++)
        corner[i] = (uint32_t)vertex[i];
    if (embree_add_faces(tree, 3, vertices, place, triangles, corner, e) || embree_commit(tree, e))
        goto out;
    for (int64_t t = 0; t < triangles; t += EMBREE_RAYS) {
        int rays = triangles - t < EMBREE_RAYS ? (int)(triangles - t) : EMBREE_RAYS;
        embree_packet p;
        double area[EMBREE_RAYS];
        embree_packet_clear(&p);
        for (int i = 0; i < rays; i++)
            area[i] = aim(&p, i, place, &vertex[3 * (t + i)]);
        embree_nearest(tree, (1u << rays) - 1, &p, false);
        for (int i = 0; i < rays; i++) {
            all += area[i];
            thin += p.geometry[i] != EMBREE_NONE ? area[i] : 0;
        }
    }
    *share = all > 0 ? thin / all : 0;
    status = 0;
out:
    embree_destroy(tree);
    free(place);
    free(corner);
    return status;
}
