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

/* What J at the corners of a box is bounded by. */
typedef struct shape {
    element_tensor h; /* grad u in the middle */
    hourglass_modes modes;
    double dilation; /* J - 1 there */
} shape;

/* Whether J at all corners of a box is above a limit, from what is known of it anyway: false where that does not tell.
 * With A = F in the middle and A + D at a corner, in Frobenius' norm,
 *     det(A + D) = det A + cof A : D + A : cof D + det D, |cof X| <= |X|^2 / sqrt(3), |det X| <= |X|^3 / (3 sqrt(3)).
 * A column of D is the sum of three hourglass modes, with signs, times a slope, and a mode is in two columns, xyz in
 * three: |D|^2 <= 9 slope^2 Q, Q the sum of all squares. Where |D| is at most 1/4,
 * as |A| <= (1 + |A|^2) / 2,
 *     det(A + D) >= det A - |D| (|A|^2 + (1 + |A|^2) / 8 + 1/48) / sqrt(3). */
static bool is_above(const strained_view *v, const shape *d, double limit)
{
    const element_tensor h = d->h;
    const double gap = 1 + d->dilation - limit - 1e-9; /* for rounding */
    const double square = 3 + 2 * (h.xx + h.yy + h.zz) + (h.xx * h.xx + h.xy * h.xy + h.xz * h.xz) +
                          (h.yx * h.yx + h.yy * h.yy + h.yz * h.yz) + (h.zx * h.zx + h.zy * h.zy + h.zz * h.zz);
    const double most = square + (1 + square) / 8 + 1. / 48;
    const double away = 9 * v->slope * v->slope * hourglass_dot(&d->modes, &d->modes); /* |D|^2 */
    return gap > 0 && 16 * away <= 1 && away * most * most < 3 * gap * gap;
}

/* d: NULL of elements that are no boxes, or cut, whose corners are always computed. */
static void add_quality(quality *to, const strained_view *v, int64_t element, const shape *d)
{
    const double limit = to->corner < v->limit ? to->corner : v->limit;
    if (d && is_above(v, d, limit > 0 ? limit : 0)) {
        if (!(1 + d->dilation >= to->centre))
            to->centre = 1 + d->dilation;
        return;
    }
    quality_j j = quality_of(&v->mesh, element, v->displacement);
    if (d)
        j.centre = 1 + d->dilation; /* the same bits, whether corners are computed or not */
    quality_add(to, element, j);
}

static bool is_box(const tled_problem *p, int64_t element)
{
    return !p->conforming && !tled_cut(p, element);
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
    const shape of = {d->h, d->modes, d->dilation};
    add_quality(&to->quality, v, element, is_box(v->p, element) ? &of : NULL);
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

/* The bits of strained_add, without laws and energies. */
static void quality_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const job *j = context;
    const tled_problem *p = j->v->p;
    const double *u = j->v->displacement;
    const element_shape box = element_box(p->side[0], p->side[1], p->side[2]);
    quality sum = quality_none();
    for (int64_t i = from; i < to; i++) {
        if (!is_box(p, i)) {
            add_quality(&sum, j->v, i, NULL);
            continue;
        }
        const element_modes x = deformed_modes(p, i, u, 0), y = deformed_modes(p, i, u, 1),
                            z = deformed_modes(p, i, u, 2);
        shape of = {element_gradient_by(NULL, x, y, z, box.slope), element_hourglass_modes(x, y, z), 0};
        of.dilation = element_dilation(of.h);
        add_quality(&sum, j->v, i, &of);
    }
    j->part[chunk].quality = sum;
}

quality strained_quality(const strained_view *v, pool *threads, strained *part)
{
    job j = {v, part};
    quality all = quality_none();
    pool_run(threads, v->p->elements, STRAINED_CHUNK, quality_work, &j);
    for (int64_t c = 0; c < pool_chunks(v->p->elements, STRAINED_CHUNK); c++)
        quality_join(&all, &part[c].quality);
    return all;
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
