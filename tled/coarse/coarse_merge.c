#include "tled/coarse/coarse_merge.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = 6 }; /* volumes that a merged element keeps apart; eight cells rarely have more */

typedef struct part {
    int32_t volume;
    double share;   /* of a merged element */
    double dyad[6]; /* of its fibres, by share: xx yy zz xy yz zx */
} part;

typedef struct merged {
    part of[PARTS];
    int32_t parts;
} merged;

static void add_fibre(part *to, const float *t, double share)
{
    to->dyad[0] += share * t[0] * t[0];
    to->dyad[1] += share * t[1] * t[1];
    to->dyad[2] += share * t[2] * t[2];
    to->dyad[3] += share * t[0] * t[1];
    to->dyad[4] += share * t[1] * t[2];
    to->dyad[5] += share * t[2] * t[0];
}

/* fibre: 3, or NULL. What finds no place is left out. */
static void add_part(merged *to, int32_t volume, double share, const float *fibre)
{
    int i = 0;
    while (i < to->parts && to->of[i].volume != volume)
        i++;
    if (i == PARTS || !(share > 0))
        return;
    if (i == to->parts)
        to->of[to->parts++] = (part){.volume = volume};
    to->of[i].share += share;
    if (fibre)
        add_fibre(&to->of[i], fibre, share);
}

static void add_element(const tled_problem *p, int64_t i, merged *to)
{
    const double tissue = tled_fraction(p, i) / 8, second = tled_mixture(p, i);
    add_part(to, p->element_volume[i], tissue * (1 - second), p->fibre ? p->fibre + 3 * i : NULL);
    if (tled_mix(p, i) >= 0)
        add_part(to, tled_mix(p, i), tissue * second, p->mixfibre ? p->mixfibre + 3 * i : NULL);
}

/* The mean direction: along which the dyad is largest, by the power method from its longest column; 0 where there is
 * none. */
static void direction_of(const part *from, float *t)
{
    const double *d = from->dyad, m[3][3] = {{d[0], d[3], d[5]}, {d[3], d[1], d[4]}, {d[5], d[4], d[2]}};
    int longest = 0;
    for (int a = 1; a < 3; a++)
        longest = m[a][a] > m[longest][longest] ? a : longest;
    double v[3] = {m[longest][0], m[longest][1], m[longest][2]};
    for (int i = 0; i < 20; i++) {
        const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        if (!(length > 0))
            return;
        double w[3];
        for (int a = 0; a < 3; a++)
            w[a] = (m[a][0] * v[0] + m[a][1] * v[1] + m[a][2] * v[2]) / length;
        memcpy(v, w, sizeof v);
    }
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int a = 0; a < 3 && length > 0; a++)
        t[a] = (float)(v[a] / length);
}

/* The part that has most, but for one; -1: there is none. */
static int largest(const merged *of, int but)
{
    int best = -1;
    for (int i = 0; i < of->parts; i++)
        if (i != but && (best < 0 || of->of[i].share > of->of[best].share))
            best = i;
    return best;
}

typedef struct arrays {
    model_array *volume, *fraction, *fibre, *mix, *mixture, *mixfibre; /* fibre and mixfibre: or NULL */
} arrays;

/* With less than this share of a merged element, a second volume is left out. */
static const double least = 1. / 16;

static void put(const merged *from, int64_t i, const arrays *to)
{
    const int first = largest(from, -1), second = largest(from, first);
    double whole = 0;
    for (int k = 0; k < from->parts; k++)
        whole += from->of[k].share;
    to->volume->i32[i] = from->of[first].volume;
    to->fraction->f32[i] = (float)fmin(whole, 1);
    if (to->fibre)
        direction_of(&from->of[first], to->fibre->f32 + 3 * i);
    to->mix->i32[i] = -1;
    if (second < 0 || from->of[second].share < least * whole)
        return;
    to->mix->i32[i] = from->of[second].volume;
    to->mixture->f32[i] = (float)(from->of[second].share / (from->of[first].share + from->of[second].share));
    if (to->mixfibre)
        direction_of(&from->of[second], to->mixfibre->f32 + 3 * i);
}

static int add_arrays(arrays *a, const tled_problem *fine, model *to, err *e)
{
    *a = (arrays){.volume = model_add(to, "element.volume", e)};
    if (!a->volume || !model_add(to, "element.fraction", e) || !model_add(to, "element.mix", e) ||
        !model_add(to, "element.mixture", e) ||
        (fine->fibre && (!model_add(to, "element.fibre", e) || !model_add(to, "element.mixfibre", e))))
        return -1;
    *a = (arrays){model_find(to, "element.volume"),  model_find(to, "element.fraction"),
                  model_find(to, "element.fibre"),   model_find(to, "element.mix"),
                  model_find(to, "element.mixture"), model_find(to, "element.mixfibre")};
    return a->volume && a->fraction && a->mix && a->mixture ? 0 : -1;
}

int coarse_merge(const tled_problem *fine, const model *m, int64_t elements, const int32_t *element,
                 int64_t (*place)(const struct coarse *c, const int32_t *ijk), const struct coarse *c, model *to,
                 err *e)
{
    arrays a;
    const int32_t *cells = model_find(m, "element.lattice")->i32;
    if (add_arrays(&a, fine, to, e))
        return -1;
    merged *all = mem_array(elements, sizeof *all, "the coarser model", e);
    if (!all)
        return -1;
    for (int64_t i = 0; i < fine->elements; i++)
        add_element(fine, i, &all[element[place(c, cells + 3 * i)]]);
    for (int64_t i = 0; i < elements; i++)
        put(&all[i], i, &a);
    free(all);
    return 0;
}
