#include "tled/problem/cut.h"

#include "base/mem.h"
#include "mesh/lattice.h"
#include "tled/problem/films.h"

#include <math.h>
#include <string.h>

double cut_inertia(const tled_problem *p, int64_t element)
{
    const double share = films_whole(p, element);
    return share < CUT_LEAST && tled_cut(p, element) ? CUT_LEAST : share;
}

double cut_mass(const tled_problem *p, int64_t element)
{
    return tled_law_of(p, element).density * p->side[0] * p->side[1] * p->side[2] * cut_inertia(p, element);
}

int cut_borrow(tled_problem *p, const model *m, err *e)
{
    if (cut_moments_of(&p->cut, m, e))
        return -1;
    if (p->cut.count && p->conforming)
        return err_set(e, NULL, 0, "cut.moments are of elements without a lattice; expected them of a lattice's boxes");
    return 0;
}

int64_t cut_least(const tled_problem *p)
{
    int64_t count = 0;
    for (int64_t i = 0; i < p->cut.count; i++)
        count += films_whole(p, p->cut.element[i]) < CUT_LEAST;
    return count;
}

/* The mean of a corner's shape function over the part. */
static double weight_of(const float *moments, int corner)
{
    const double x = 2 * lattice_vtk[corner][0] - 1, y = 2 * lattice_vtk[corner][1] - 1,
                 z = 2 * lattice_vtk[corner][2] - 1;
    const element_cut c = element_cut_of(moments);
    return (1 + x * c.x + y * c.y + z * c.z + x * y * c.xy + y * z * c.yz + z * x * c.zx +
            x * y * z * (double)moments[CUT_XYZ]) /
           8;
}

int cut_weigh(tled_problem *p, err *e)
{
    const double volume = p->side[0] * p->side[1] * p->side[2];
    if (!p->cut.count && !p->films)
        return 0;
    p->weight = mem_array(p->nodes, sizeof *p->weight, "the nodes", e);
    for (int64_t i = 0; p->weight && i < p->elements; i++) {
        const double mass = tled_law_of(p, i).density * volume * tled_fraction(p, i);
        const float *moments = tled_cut(p, i);
        for (int c = 0; c < 8; c++)
            p->weight[p->element_node[8 * i + c]] += mass * (moments ? weight_of(moments, c) : .125);
    }
    return p->weight ? 0 : -1;
}

double cut_lighter_of(const tled_problem *p, int64_t element)
{
    return tled_fraction(p, element) / cut_inertia(p, element);
}

void cut_matrix(const tled_problem *p, int64_t element, const float *moments, step_matrix *a)
{
    stability_cut_matrix(element_cut_of(moments), cut_lighter_of(p, element), a);
}

stability_twists cut_twists(const tled_problem *p, int64_t element, const float *moments, stability_twists whole)
{
    return stability_cut_twists(element_cut_of(moments), cut_lighter_of(p, element), whole);
}

double cut_raises(const tled_problem *p, int64_t element, const float *moments)
{
    const stability_gram g = stability_gram_of(element_cut_of(moments));
    return cut_lighter_of(p, element) * stability_gram_bound(&g);
}

/* ---- laminates */

int border_borrow(tled_problem *p, const model *m, err *e)
{
    if (borders_of(&p->borders, &p->cut, m, e))
        return -1;
    const borders *of = &p->borders;
    if (of->count && p->conforming)
        return err_set(e, NULL, 0, "border.element is of elements without a lattice; expected a lattice's boxes");
    if (of->count && p->own_mix)
        return err_set(e, NULL, 0,
                       "elements have values in place of their materials' and others are laminates "
                       "(border.element); expected one of these");
    p->border = of->count ? mem_array(of->count, LAMINATE_NUMBERS * sizeof *p->border, "the borders", e) : NULL;
    for (int64_t i = 0; p->border && i < of->count; i++)
        borders_numbers(of, i, tled_cut(p, of->element[i]), p->side, tled_fraction(p, of->element[i]),
                        tled_mixture(p, of->element[i]), p->border + LAMINATE_NUMBERS * i);
    return of->count && !p->border ? -1 : 0;
}

border_parts border_parts_of(const tled_problem *p, int64_t element, const double *numbers)
{
    const tled_law *law[2] = {&p->volume[p->element_volume[element]].law, &p->volume[tled_mix(p, element)].law};
    const tled_law between = tled_law_of(p, element);
    const double mixture = tled_mixture(p, element), by[2] = {1 - mixture, mixture};
    const int moduli = form_moduli(p->form);
    border_parts to = {.l = laminate_by(numbers, mixture, law[0]->bulk, law[1]->bulk)};
    for (int i = 0; i < FORM_NUMBERS; i++) {
        to.c[0][i] = law[0]->c[i] * (i < moduli ? by[0] : 1);
        to.c[1][i] = law[1]->c[i] * (i < moduli ? by[1] : 1);
    }
    memcpy(to.law.c, between.c, sizeof between.c);
    memcpy(to.law.hourglass, between.hourglass, sizeof between.hourglass);
    return to;
}

border_parts border_parts_by(border_parts parts, const tled_problem *p, double share)
{
    const int moduli = form_moduli(p->form);
    for (int i = 0; i < moduli; i++) {
        parts.c[0][i] *= share;
        parts.c[1][i] *= share;
        parts.law.c[i] *= share;
    }
    for (int i = 0; i < HOURGLASS_NUMBERS; i++)
        parts.law.hourglass[i] *= share;
    parts.l.bulk[0] *= share;
    parts.l.bulk[1] *= share;
    return parts;
}

laminate_state border_state(const tled_problem *p, border_parts *parts, element_modes x, element_modes y,
                            element_modes z, element_shape box)
{
    return laminate_held(p->form, p->control.kind, x, y, z, box, &parts->law, parts->c[0], parts->c[1], &parts->l);
}

static double length_of(element_vector a)
{
    return sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
}

bool border_is_found(const laminate_state *is)
{
    return 1 + element_dilation(is->h1) > 0 && 1 + element_dilation(is->h2) > 0 &&
           length_of(is->left) <= .1 * length_of(is->jump) + 1e-3;
}

double border_square(const tled_problem *p, int64_t element, const border_parts *parts, const laminate_state *is,
                     const double *rest, double density, const step_fibres *fibres, stability_twists t, double highest)
{
    const float *moments = tled_cut(p, element);
    stability_laminate m;
    if (moments)
        t = cut_twists(p, element, moments, t);
    stability_laminate_matrices(p->form, is, &parts->l, parts->c[0], parts->c[1], rest, density, p->side, fibres->own,
                                fibres->other, fibres->sets.of, fibres->sets.count,
                                moments ? cut_lighter_of(p, element) : 1, &m);
    const double bound = stability_laminate_bound(&m, t);
    return bound <= highest ? bound : stability_laminate_square(&m, t);
}

double border_square_at_rest(const tled_problem *p, int64_t element, const double *numbers, const step_fibres *fibres,
                             double highest)
{
    const laminate_state rest = {.jump = {0, 0, 0}};
    const tled_law law = tled_law_of(p, element);
    const border_parts parts = border_parts_of(p, element, numbers);
    step_fibres at_rest = *fibres;
    double none[FORM_NUMBERS];
    memcpy(none, law.c, sizeof none);
    memset(none, 0, (size_t)form_moduli(p->form) * sizeof *none);
    at_rest.own = at_rest.other = (element_fibre){.tension = 0};
    return border_square(p, element, &parts, &rest, none, law.density, &at_rest, (stability_twists){law.twists, 0},
                         highest);
}
