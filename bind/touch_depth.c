#include "bind/touch_depth.h"

#include "base/mem.h"
#include "mesh/weights.h"
#include "surface/triangle_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 64, FITS = 8 };

/* Of a voxel's shortest side: what is so near to a node is its own skin. */
static const double own = 1e-3;

typedef struct maker {
    touch_depth *d;
    const side *sides;
    const touch_skin *skin;
    const int32_t *element_node;
    const double *position;
    int64_t elements, nodes;
    bool *marked; /* elements */
    int32_t *row; /* nodes of the model: of d->node, or -1 */
    int32_t *around_start, *around;
    triangle_tree *tree;
    embree *faces;
    double own; /* m */
    pool *threads;
    err *e;
} maker;

/* ---- samples to elements */

static void bind_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const maker *k = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        const double *x = k->skin->sample + 3 * i;
        const int32_t element = side_element(k->sides, x, k->skin->behind + 3 * i, nearest_element(k->sides->to, x));
        const weights_box box = weights_box_of(k->element_node + 8 * (int64_t)element, k->position);
        k->d->element[i] = element;
        weights_of(&box, x, k->d->weight + 3 * i);
    }
}

/* ---- elements and nodes near samples */

static void mark_near(const maker *k, int32_t element)
{
    enum { N = 2 * DEPTH_VOXELS + 1 };
    const lattice_map *map = &k->sides->to->map;
    const int32_t *cell = k->sides->cell + 3 * (int64_t)element;
    for (int c = 0; c < N * N * N; c++) {
        const int64_t x = (int64_t)cell[0] + c % N - DEPTH_VOXELS, y = (int64_t)cell[1] + c / N % N - DEPTH_VOXELS;
        int32_t i = lattice_element(map, x, y, (int64_t)cell[2] + c / N / N - DEPTH_VOXELS);
        for (; i >= 0; i = lattice_next(map, i))
            k->marked[i] = true;
    }
}

static int mark_elements(maker *k)
{
    bool *seen = mem_array(k->elements, sizeof *seen, "the elements", k->e);
    k->marked = seen ? mem_array(k->elements, sizeof *k->marked, "the elements", k->e) : NULL;
    for (int64_t i = 0; k->marked && i < k->skin->samples; i++) {
        const int32_t element = k->d->element[i];
        if (!seen[element])
            mark_near(k, element);
        seen[element] = true;
    }
    free(seen);
    return k->marked ? 0 : -1;
}

/* The nodes of marked elements, and the marked elements around each. */
static int list_nodes(maker *k)
{
    touch_depth *d = k->d;
    k->row = mem_array(k->nodes, sizeof *k->row, "the nodes", k->e);
    k->around_start = k->row ? mem_array(k->nodes + 2, sizeof *k->around_start, "the nodes", k->e) : NULL;
    if (!k->around_start)
        return -1;
    for (int64_t c = 0; c < 8 * k->elements; c++)
        k->row[k->element_node[c]] += k->marked[c / 8];
    for (int64_t n = 0; n < k->nodes; n++)
        d->nodes += k->row[n] > 0;
    d->node = mem_array(d->nodes, sizeof *d->node, "the nodes", k->e);
    d->distance = d->node ? mem_array(d->nodes, sizeof *d->distance, "the nodes", k->e) : NULL;
    if (!d->distance)
        return -1;
    int32_t at = 0, row = 0;
    for (int64_t n = 0; n < k->nodes; n++) {
        const int32_t count = k->row[n];
        k->row[n] = -1;
        if (!count)
            continue;
        d->node[row] = (int32_t)n;
        k->row[n] = row;
        at += count;
        k->around_start[++row + 1] = at; /* shifted by one, which the filling takes back */
    }
    k->around = mem_array(at, sizeof *k->around, "the nodes", k->e);
    for (int64_t c = 0; k->around && c < 8 * k->elements; c++)
        if (k->marked[c / 8])
            k->around[k->around_start[k->row[k->element_node[c]] + 1]++] = (int32_t)(c / 8);
    return k->around ? 0 : -1;
}

/* ---- distances */

/* How far a point is from the plane of the face that a place's view of it meets first; above `otherwise`, or met by
 * none: that. */
static double past_face(const maker *k, const double place[3], const double x[3], double otherwise)
{
    embree_packet p;
    double along = 0, length = 0;
    embree_packet_clear(&p);
    for (int a = 0; a < 3; a++) {
        p.from[a][0] = (float)place[a];
        p.along[a][0] = (float)(x[a] - place[a]);
    }
    p.start[0] = 0;
    p.end[0] = 1;
    embree_nearest(k->faces, 1, &p, false);
    if (p.geometry[0] == EMBREE_NONE)
        return otherwise;
    for (int a = 0; a < 3; a++) {
        along += (1 - (double)p.end[0]) * (x[a] - place[a]) * (double)p.normal[a][0];
        length += (double)p.normal[a][0] * (double)p.normal[a][0];
    }
    return length > 0 ? fabs(along) / sqrt(length) : otherwise;
}

/* Above 0 where most of the places about do not see the node. The nearest face is of its own part of the tissue where
 * one of these places sees the nearest point. */
static double distance_of(const maker *k, int64_t row, int64_t *guess)
{
    const double *x = k->position + 3 * (int64_t)k->d->node[row];
    const int32_t from = k->around_start[row], to = k->around_start[row + 1];
    const triangle_hit hit = triangle_tree_nearest(k->tree, x, *guess);
    double away = sqrt(hit.distance2), past = 0;
    int seen = 0, sees_hit = 0;
    *guess = hit.triangle;
    for (int32_t i = from; i < to; i++) {
        double place[3];
        side_place(k->sides, k->around[i], place);
        const bool sees = side_sees(k->faces, place, x, k->own);
        seen += sees ? 1 : -1;
        sees_hit += side_sees(k->faces, place, hit.point, k->own);
        if (!sees)
            past = fmax(past, past_face(k, place, x, away));
    }
    if (seen >= 0)
        return -away;
    return sees_hit ? away : fmax(past, away);
}

static void distance_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const maker *k = context;
    int64_t guess = -1;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        k->d->distance[i] = distance_of(k, i, &guess);
}

static int make_faces(maker *k, int threads)
{
    const touch_skin *s = k->skin;
    float *position = mem_array(3 * s->vertices, sizeof *position, "the vertices", k->e);
    uint32_t *corner = position ? mem_array(3 * s->triangles, sizeof *corner, "the triangles", k->e) : NULL;
    for (int64_t i = 0; corner && i < 3 * s->vertices; i++)
        position[i] = (float)s->position[i];
    for (int64_t i = 0; corner && i < 3 * s->triangles; i++)
        corner[i] = (uint32_t)s->corner[i];
    k->faces = corner ? embree_create(threads, k->e) : NULL;
    const int failed = !k->faces || embree_add_faces(k->faces, 3, s->vertices, position, s->triangles, corner, k->e) ||
                       embree_commit(k->faces, k->e);
    free(position);
    free(corner);
    k->tree = failed ? NULL : triangle_tree_create(s->position, s->corner, s->triangles, k->e);
    return k->tree ? 0 : -1;
}

/* ---- the skin is where the distance is 0 */

static double off_at(const maker *k, int64_t sample, double share[8], int32_t row[8])
{
    double off = 0;
    weights_shares(k->d->weight + 3 * sample, share);
    for (int c = 0; c < 8; c++) {
        row[c] = k->row[k->element_node[8 * (int64_t)k->d->element[sample] + c]];
        off += share[c] * k->d->distance[row[c]];
    }
    return off;
}

/* Simultaneous iterative reconstruction (Gilbert 1972): each node takes the mean of what its samples are off by. */
static int fit(maker *k)
{
    double share[8], *more = mem_array(2 * k->d->nodes, sizeof *more, "the nodes", k->e), *sum = more + k->d->nodes;
    int32_t row[8];
    for (int pass = 0; more && pass < FITS; pass++) {
        memset(more, 0, 2 * (size_t)k->d->nodes * sizeof *more);
        for (int64_t i = 0; i < k->skin->samples; i++) {
            const double off = off_at(k, i, share, row);
            double all = 0;
            for (int c = 0; c < 8; c++)
                all += fabs(share[c]);
            for (int c = 0; c < 8; c++) {
                more[row[c]] += share[c] * off / all;
                sum[row[c]] += fabs(share[c]);
            }
        }
        for (int64_t n = 0; n < k->d->nodes; n++)
            k->d->distance[n] -= sum[n] > 0 ? more[n] / sum[n] : 0;
    }
    for (int64_t i = 0; more && i < k->skin->samples; i++)
        k->d->worst = fmax(k->d->worst, fabs(off_at(k, i, share, row)));
    const int failed = more ? 0 : -1;
    free(more);
    return failed;
}

/* ---- all */

int touch_depth_make(touch_depth *d, const model *m, const side *sides, const touch_skin *skin, int threads, pool *by,
                     err *e)
{
    const model_array *node = model_find(m, "element.node"), *position = model_find(m, "node.position");
    const double *h = sides->to->grid.spacing;
    maker k = {.d = d, .sides = sides, .skin = skin, .threads = by, .e = e};
    k.element_node = node->i32;
    k.elements = node->rows;
    k.position = position->f64;
    k.nodes = position->rows;
    k.own = own * fmin(h[0], fmin(h[1], h[2]));
    *d = (touch_depth){.element = mem_array(skin->samples, sizeof *d->element, "the samples", e)};
    d->weight = d->element ? mem_array(skin->samples, 3 * sizeof *d->weight, "the samples", e) : NULL;
    int failed = !d->weight;
    if (!failed)
        pool_run(by, skin->samples, CHUNK, bind_work, &k);
    failed = failed || mark_elements(&k) || list_nodes(&k) || make_faces(&k, threads);
    if (!failed)
        pool_run(by, d->nodes, CHUNK, distance_work, &k);
    failed = failed || fit(&k);
    free(k.marked);
    free(k.row);
    free(k.around_start);
    free(k.around);
    triangle_tree_destroy(k.tree);
    if (k.faces)
        embree_destroy(k.faces);
    return failed ? -1 : 0;
}

void touch_depth_free(touch_depth *d)
{
    free(d->element);
    free(d->weight);
    free(d->node);
    free(d->distance);
    *d = (touch_depth){.nodes = 0};
}
