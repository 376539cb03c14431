#include "tled/problem/conforming_step.h"

#include <math.h>

element_any conforming_shape(const conforming_element *c)
{
    element_any s = {.volume = c->volume};
    for (int m = 0; m < ELEMENT_MODES; m++)
        s.slope[m] = (element_vector){c->slope[m][0], c->slope[m][1], c->slope[m][2]};
    for (int g = 0; g < ELEMENT_TWISTS; g++)
        s.twist[g] = (element_vector){c->twist[g][0], c->twist[g][1], c->twist[g][2]};
    return s;
}

/* ---- the stable step */

void conforming_matrix(const tled_problem *p, int64_t element, element_tensor h, element_fibre fibre, step_matrix *a)
{
    const tled_law law = tled_law_of(p, element);
    double(*l)[3] = p->conforming->element[element].root;
    double half[9][9];
    form_tangent(p->form, h, law.c, a->at);
    if (fibre.tension != 0)
        stability_add_active(h, fibre, a->at);
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
            a->at[r][c] = 8 / law.density * sum;
        }
}

/* l2 of the header. */
static double twists(const tled_problem *p, int64_t element)
{
    const conforming_element *c = &p->conforming->element[element];
    return c->gammas * c->hourglass / (tled_law_of(p, element).density * c->volume / 8);
}

double conforming_room(const tled_problem *p, int64_t element, double limit)
{
    const double couple = p->conforming->element[element].couple, twist = twists(p, element);
    return limit > twist ? limit * (limit - twist) / (limit - twist * (1 - couple)) : 0;
}

double conforming_square(const tled_problem *p, int64_t element, double eigenvalue)
{
    const double couple = p->conforming->element[element].couple, twist = twists(p, element);
    const double apart = eigenvalue - twist;
    return (eigenvalue + twist + sqrt(apart * apart + 4 * couple * eigenvalue * twist)) / 2;
}

void conforming_join(tled_problem *p)
{
    conforming *c = p->conforming;
    const element_tensor rest = {0};
    const element_fibre none = {0};
    step_matrix a;
    for (int64_t i = 0; i < p->elements; i++) {
        const tled_law law = tled_law_of(p, i);
        conforming_element *own = &c->element[i];
        own->hourglass = p->kappa * element_hourglass_modulus(law.mu, law.bulk) * own->volume * own->squares / 8;
        conforming_matrix(p, i, rest, none, &a);
        if (i && step_below(&a, conforming_room(p, i, c->square)))
            continue;
        double square = conforming_square(p, i, step_largest(&a));
        if (square > c->square) {
            c->square = square;
            c->stiffest = i;
        }
    }
}
