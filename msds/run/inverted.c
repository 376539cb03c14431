#include "msds/run/inverted.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

enum { NODE_CHUNK = 4096, ELEMENT_CHUNK = 2048 };

/* What only counting here takes. */
static int make_room(inverted *v, err *e)
{
    if (!v->place)
        v->place = mem_array(v->p->nodes, 3 * sizeof *v->place, "the frames", e);
    if (v->place && !v->sum)
        v->sum = mem_array(pool_chunks(v->p->elements, ELEMENT_CHUNK), sizeof *v->sum, "the frames", e);
    return v->sum ? 0 : -1;
}

void inverted_free(inverted *v)
{
    free(v->place);
    free(v->sum);
    *v = (inverted){.now = 0};
}

static void place_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const inverted *v = context;
    (void)chunk;
    for (int64_t i = 3 * from; i < 3 * to; i++)
        v->place[i] = v->p->position[i] + v->u[i];
}

static void count_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const inverted *v = context;
    int64_t count = 0;
    for (int64_t t = from; t < to; t++) {
        const int32_t *n = v->p->element_node + 4 * t;
        const double *x[4];
        for (int c = 0; c < 4; c++)
            x[c] = v->place + 3 * (int64_t)n[c];
        count += !(simplex_volume(x[0], x[1], x[2], x[3]) > 0);
    }
    v->sum[chunk] = count;
}

void inverted_add(inverted *v, int64_t count, double time)
{
    v->now = count;
    v->frames += count > 0;
    if (count > v->most) {
        v->most = count;
        v->most_time = time;
    }
}

int inverted_count(inverted *v, const double *u, double time, err *e)
{
    int64_t count = 0;
    if (make_room(v, e))
        return -1;
    v->u = u;
    pool_run(v->threads, v->p->nodes, NODE_CHUNK, place_work, v);
    pool_run(v->threads, v->p->elements, ELEMENT_CHUNK, count_work, v);
    for (int64_t i = 0; i < pool_chunks(v->p->elements, ELEMENT_CHUNK); i++)
        count += v->sum[i];
    inverted_add(v, count, time);
    return 0;
}

void inverted_warn(const inverted *v, int64_t frames, const char *method, notes *warnings)
{
    if (!v->most)
        return;
    notes_add(warnings,
              "%lld of %lld tetrahedra are inverted in the last frame, at most %lld (at %.6g s), some in %lld of %lld "
              "frames: the result is wrong there; expected %s",
              (long long)v->now, (long long)v->p->elements, (long long)v->most, v->most_time, (long long)v->frames,
              (long long)frames,
              strcmp(method, "tissue") ? "--method tissue, or a probe that goes less deep"
                                       : "more --iterations, or a probe that goes less deep");
}
