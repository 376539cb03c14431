#include "tled/problem/conforming_step.h"

#include "mesh/fibre_sets.h"
#include "tled/problem/muscle_fibre.h"

#include <math.h>

element_any conforming_shape(const tled_problem *p, int64_t element, const conforming_hold *hold)
{
    const conforming_element *c = &p->conforming->element[element];
    return element_any_of(&c->slope[0][0], &c->twist[0][0], c->volume, hold->basis);
}

/* ---- the stable step */

void conforming_matrix(const tled_problem *p, int64_t element, const tled_law *law, element_tensor h,
                       element_fibre fibre, step_matrix *a)
{
    double(*l)[3] = p->conforming->element[element].root;
    double half[9][9];
    const fibre_sets sets = fibre_sets_at(&p->fibres, element);
    form_tangent(p->form, h, law->c, a->at);
    if (stability_pulls(fibre))
        stability_add_muscle(h, fibre, a->at);
    fibre_add_tangent(h, sets.of, sets.count, a->at);
    for (int r = 0; r < 9; r++)
        for (int c = r + 1; c < 9; c++)
            a->at[r][c] = a->at[c][r];
    for (int r = 0; r < 9; r++) /* A L, then L^T A L */
        for (int c = 0; c < 9; c++) {
            half[r][c] = 0;
            for (int m = c % 3; m < 3; m++)
                half[r][c] += a->at[r][c / 3 * 3 + m] * l[m][c % 3];
        }
    for (int r = 0; r < 9; r++)
        for (int c = 0; c < 9; c++) {
            double sum = 0;
            for (int j = r % 3; j < 3; j++)
                sum += l[j][r % 3] * half[r / 3 * 3 + j][c];
            a->at[r][c] = 8 / law->density * sum;
        }
}

stability_twists conforming_twists(const tled_problem *p, int64_t element, element_tensor h, const hourglass_modes *m,
                                   stability_stiffening s)
{
    const conforming_element *c = &p->conforming->element[element];
    const double square = c->stiffest / (tled_law_of(p, element).density * c->volume / 8);
    return stability_twists_of(p->control.kind, square, c->steepest, h, m, s);
}

double conforming_room(const tled_problem *p, int64_t element, stability_twists t, double limit)
{
    const double couple = p->conforming->element[element].couple;
    return limit > t.own ? limit * (limit - t.own) / (limit - t.own * (1 - couple)) - t.more : 0;
}

double conforming_square(const tled_problem *p, int64_t element, stability_twists t, double eigenvalue)
{
    const double couple = p->conforming->element[element].couple, law = eigenvalue + t.more, apart = law - t.own;
    return (law + t.own + sqrt(apart * apart + 4 * couple * law * t.own)) / 2;
}

static double stiffest_of(const tled_problem *p, int64_t element)
{
    const conforming_element *c = &p->conforming->element[element];
    const conforming_hold hold = conforming_hold_of(p, element);
    double root[16];
    if (p->control.kind == HOURGLASS_ISOTROPIC)
        return c->gammas * hold.law[HOURGLASS_K];
    conforming_root(c, root);
    return hourglass_any_stiffest(hold.law, c->volume, hold.basis, root);
}

void conforming_join(tled_problem *p)
{
    conforming *c = p->conforming;
    const element_tensor rest = {0};
    const hourglass_modes still = {.xy = {0}};
    const stability_stiffening none = {.now = 1};
    step_matrix a;
    for (int64_t i = 0; i < p->elements; i++) {
        const tled_law law = tled_law_of(p, i);
        c->element[i].stiffest = stiffest_of(p, i);
        const stability_twists t = conforming_twists(p, i, rest, &still, none);
        conforming_matrix(p, i, &law, rest, muscle_fibre_of(p, p->fibre, i, p->element_volume[i], 1, NULL), &a);
        if (i && step_below(&a, conforming_room(p, i, t, c->square)))
            continue;
        double square = conforming_square(p, i, t, step_largest(&a));
        if (square > c->square) {
            c->square = square;
            c->stiffest = i;
        }
    }
}
