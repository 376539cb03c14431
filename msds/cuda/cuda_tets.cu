/* What the method tissue needs on the card, copied from the tetrahedra that tissue_mesh.h lays out on the host.
 */
#include "solve/card_layout.cuh"

#include "msds/cuda/cuda_newton_elements.cuh"

#include <stdlib.h>
#include <string.h>

extern "C" {
#include "base/mem.h"
}

typedef struct host_sums { /* as the card has them; NULL where there are none */
    int32_t *start;
    int2 *slot;
} host_sums;

typedef struct host_tets {
    tissue_mesh m;
    host_sums corners, swells;
    int32_t *shape; /* as the card has it */
    float *gradient;
    int64_t shapes;
} host_tets;

static void host_tets_free(host_tets *h)
{
    tissue_mesh_free(&h->m);
    free(h->corners.start);
    free(h->corners.slot);
    free(h->swells.start);
    free(h->swells.slot);
    free(h->shape);
    free(h->gradient);
}

static int make_sums(const tissue_sums *from, host_sums *to, err *e)
{
    if (!from->start)
        return 0;
    to->start = (int32_t *)mem_array(from->slices + 1, sizeof *to->start, "the solver", e);
    to->slot = to->start ? (int2 *)mem_array(from->slots, sizeof *to->slot, "the solver", e) : NULL;
    for (int64_t i = 0; to->slot && i <= from->slices; i++)
        to->start[i] = (int32_t)from->start[i];
    for (int64_t i = 0; to->slot && i < from->slots; i++)
        to->slot[i] = {from->first[i], from->has[i]};
    return to->slot ? 0 : -1;
}

/* Groups of one shape follow each other, for the most part: what is the same as one of so many shapes before is not
 * stored again. */
enum { SHAPES_BACK = 16 };

/* Returns the index of these gradients among the shapes so far, or the next index. */
static int64_t find_shape(const host_tets *h, const float *q)
{
    for (int64_t i = h->shapes - 1; i >= 0 && i >= h->shapes - SHAPES_BACK; i--)
        if (!memcmp(h->gradient + 9 * i, q, 9 * sizeof *q))
            return i;
    return h->shapes;
}

static int make_shapes(host_tets *h, err *e)
{
    const tissue_mesh *m = &h->m;
    h->shape = (int32_t *)mem_array(m->groups, sizeof *h->shape, "the solver", e);
    h->gradient = h->shape ? (float *)mem_array(m->shape[m->groups], sizeof *h->gradient, "the solver", e) : NULL;
    for (int64_t g = 0; h->gradient && g < m->groups; g++) {
        const int64_t count = m->shape[g + 1] - m->shape[g], at = find_shape(h, m->gradient + m->shape[g]);
        const bool one = count == 9;
        if (!one || at == h->shapes) {
            h->shape[g] = (int32_t)(one ? h->shapes : ~h->shapes);
            memcpy(h->gradient + 9 * h->shapes, m->gradient + m->shape[g], (size_t)count * sizeof *h->gradient);
            h->shapes += count / 9;
        } else {
            h->shape[g] = (int32_t)at;
        }
    }
    return h->gradient ? 0 : -1;
}

static int host_tets_make(host_tets *h, const msds_problem *p, const sell *s, err *e)
{
    return tissue_mesh_make(&h->m, p, s, e) || make_sums(&h->m.corners, &h->corners, e) ||
                   make_sums(&h->m.swells, &h->swells, e) || make_shapes(h, e)
               ? -1
               : 0;
}

static void list_sums(card_layout *a, newton_sums *to, const tissue_sums *from, const host_sums *host)
{
    card_layout_copy(a, &to->start, host->start, from->slices + 1);
    card_layout_copy(a, &to->slot, host->slot, from->slots);
    card_layout_copy(a, &to->list, from->list, from->slots * LANES);
}

static void list_elements(card_layout *a, tissue_newton *x, const host_tets *h)
{
    const tissue_mesh *m = &h->m;
    const int64_t lanes = m->groups * LANES;
    card_layout_copy(a, &x->first, (const int4 *)m->first, m->groups);
    card_layout_copy(a, &x->first_point, (const int4 *)m->first_point, m->groups);
    card_layout_copy(a, &x->node, m->node, 4 * lanes);
    card_layout_copy(a, &x->point, m->point, 4 * lanes);
    card_layout_copy(a, &x->shape, h->shape, m->groups);
    card_layout_copy(a, &x->gradient, h->gradient, 9 * h->shapes);
    card_layout_copy(a, &x->volume, m->volume, lanes);
    card_layout_copy(a, &x->mu, m->mu, lanes);
    card_layout_copy(a, &x->kappa, m->kappa, lanes);
    card_layout_add(a, &x->law, STABLE_NUMBERS * lanes);
    card_layout_add(a, &x->counted, lanes);
    card_layout_add(a, &x->force, 12 * m->stride);
    card_layout_add(a, &x->swollen, m->stride);
}

static void list_nodes(card_layout *a, tissue_newton *x, const tissue_mesh *m, int64_t nodes)
{
    card_layout_copy(a, &x->bulk, m->bulk, m->points);
    card_layout_copy(a, &x->keep, m->keep, m->points);
    card_layout_add(a, &x->held, m->points);
    card_layout_add(a, &x->pressure, m->points);
    card_layout_add(a, &x->pressed, m->points);
    card_layout_copy(a, &x->inverse, m->inverse, nodes);
    float4 **const fields[] = {&x->step, &x->left, &x->way, &x->pulled, &x->started, &x->gone};
    for (float4 **field : fields)
        card_layout_add(a, field, nodes);
    card_layout_add(a, &x->active, nodes);
    card_layout_add(a, &x->meets, nodes);
    card_layout_add(a, &x->pull, nodes);
    card_layout_add(a, &x->residual, 1);
}

/* So many spans of nodes at most: each sum is one of so many parts, which all blocks of the card read. */
enum { SPANS = 640 };

static void cut_spans(tissue_newton *x, int64_t nodes)
{
    const int64_t chunks = (nodes + GRID_THREADS - 1) / GRID_THREADS;
    x->span = (int32_t)((chunks + SPANS - 1) / SPANS);
    x->spans = (int32_t)((chunks + x->span - 1) / x->span);
}

int tissue_newton_make(tissue_newton *x, const msds_problem *p, const sell *s, char **memory, int64_t *bytes, err *e)
{
    host_tets h = {};
    card_layout layout = {0};
    int result = -1;
    if (!host_tets_make(&h, p, s, e)) {
        list_elements(&layout, x, &h);
        list_nodes(&layout, x, &h.m, s->nodes);
        list_sums(&layout, &x->corners, &h.m.corners, &h.corners);
        list_sums(&layout, &x->swells, &h.m.swells, &h.swells);
        x->lanes = (int32_t)(h.m.groups * LANES);
        x->points = (int32_t)h.m.points;
        x->stride = h.m.stride;
        x->side = p->side;
        cut_spans(x, s->nodes);
        *bytes = layout.bytes;
        if (!card_layout_place(&layout, true, "the tetrahedra", memory, e))
            result = card_check(cudaDeviceSynchronize(), "cudaDeviceSynchronize()", -1, e);
    }
    host_tets_free(&h);
    return result;
}

cudaError_t tissue_newton_reset(const tissue_newton *x, cudaStream_t stream)
{
    const size_t bytes = (size_t)x->points * sizeof(float);
    cudaError_t code = cudaMemsetAsync(x->residual, 0, sizeof *x->residual, stream);
    if (code == cudaSuccess)
        code = cudaMemsetAsync(x->held, 0, bytes, stream);
    return code == cudaSuccess ? cudaMemsetAsync(x->pressure, 0, bytes, stream) : code;
}
