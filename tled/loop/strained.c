#include "tled/loop/strained.h"

#include <math.h>

strained strained_none(void)
{
    return (strained){.quality = quality_none(), .twisted = -1};
}

strained_view strained_view_of(const tled_problem *p, const double *displacement, int64_t worst)
{
    strained_view v = {.p = p,
                       .displacement = displacement,
                       .mesh = {p->element_node, 8, p->elements, p->position, p->conforming ? NULL : p->side},
                       .slope = 1 / (4 * fmin(fmin(p->side[0], p->side[1]), p->side[2])),
                       .limit = INFINITY};
    if (worst >= 0 && worst < p->elements)
        v.limit = fmin(v.limit, quality_of(&v.mesh, worst, displacement).corner);
    return v;
}

/* Whether J at all corners of a box is above a limit, from what is known of it anyway: false where that does not tell.
 * With A = F in the middle and A + D at a corner, in Frobenius' norm,
 *     det(A + D) = det A + cof A : D + A : cof D + det D, |cof X| <= |X|^2 / sqrt(3), |det X| <= |X|^3 / (3 sqrt(3)).
 * A column of D is the sum of three hourglass modes, with signs, times a slope, and a mode is in two columns, xyz in
 * three: |D|^2 <= 9 slope^2 Q, Q the sum of all squares. Where |D| is at most 1/4,
 * as |A| <= (1 + |A|^2) / 2,
 *     det(A + D) >= det A - |D| (|A|^2 + (1 + |A|^2) / 8 + 1/48) / sqrt(3). */
static bool is_above(const strained_view *v, const deformed *d, double limit)
{
    const element_tensor h = d->h;
    const double gap = 1 + d->dilation - limit - 1e-9; /* for rounding */
    const double square = 3 + 2 * (h.xx + h.yy + h.zz) + (h.xx * h.xx + h.xy * h.xy + h.xz * h.xz) +
                          (h.yx * h.yx + h.yy * h.yy + h.yz * h.yz) + (h.zx * h.zx + h.zy * h.zy + h.zz * h.zz);
    const double most = square + (1 + square) / 8 + 1. / 48;
    const double away = 9 * v->slope * v->slope * hourglass_dot(&d->modes, &d->modes); /* |D|^2 */
    return gap > 0 && 16 * away <= 1 && away * most * most < 3 * gap * gap;
}

/* The corners of elements that are no boxes, or cut, are always computed. */
static void add_quality(quality *to, const strained_view *v, int64_t element, const deformed *d)
{
    const double limit = to->corner < v->limit ? to->corner : v->limit, centre = 1 + d->dilation;
    const bool knows = !v->p->conforming && !tled_cut(v->p, element); /* that F in the middle */
    if (knows && is_above(v, d, limit > 0 ? limit : 0)) {
        if (!(centre >= to->centre))
            to->centre = centre;
        return;
    }
    quality_j j = quality_of(&v->mesh, element, v->displacement);
    if (knows)
        j.centre = centre; /* the same bits, whether corners are computed or not */
    quality_add(to, element, j);
}

void strained_add(strained *to, const strained_view *v, int64_t element, const deformed *d)
{
    const double fraction = tled_fraction(v->p, element), hourglass = fraction * d->hourglass;
    to->strain += fraction * d->rest * d->energy;
    to->hourglass += hourglass;
    to->scale += fraction * d->rest * d->law.mu;
    if (hourglass > to->most) {
        to->most = hourglass;
        to->twisted = element;
    }
    add_quality(&to->quality, v, element, d);
}

void strained_join(strained *to, const strained *later)
{
    to->strain += later->strain;
    to->hourglass += later->hourglass;
    to->scale += later->scale;
    if (later->most > to->most) {
        to->most = later->most;
        to->twisted = later->twisted;
    }
    quality_join(&to->quality, &later->quality);
}

typedef struct job {
    const strained_view *v;
    strained *part;
} job;

static void work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const job *j = context;
    const tled_problem *p = j->v->p;
    const element_shape box = element_box(p->side[0], p->side[1], p->side[2]);
    strained sum = strained_none();
    for (int64_t i = from; i < to; i++) {
        const deformed d = deformed_of(p, i, box, j->v->displacement);
        strained_add(&sum, j->v, i, &d);
    }
    j->part[chunk] = sum;
}

strained strained_of(const strained_view *v, pool *threads, strained *part)
{
    job j = {v, part};
    strained all = strained_none();
    pool_run(threads, v->p->elements, STRAINED_CHUNK, work, &j);
    for (int64_t c = 0; c < pool_chunks(v->p->elements, STRAINED_CHUNK); c++)
        strained_join(&all, &part[c]);
    return all;
}
