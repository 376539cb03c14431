#include "tled/problem/step.h"

#include "base/mem.h"
#include "tled/problem/conforming_step.h"
#include "tled/problem/cut.h"
#include "tled/problem/films.h"
#include "tled/problem/muscle_fibre.h"

#include <math.h>
#include <stdlib.h>

step_fibres step_fibres_of(const tled_problem *p, int64_t element, const double *value)
{
    const double mixture = tled_mixture(p, element);
    const step_fibres to = {.own =
                                muscle_fibre_of(p, p->fibre, element, p->element_volume[element], 1 - mixture, value),
                            .other = muscle_fibre_of(p, p->mixfibre, element, tled_mix(p, element), mixture, value),
                            .sets = fibre_sets_at(&p->fibres, element)};
    return to;
}

void step_matrix_of(const tled_problem *p, const tled_law *law, element_tensor h, const step_fibres *fibres,
                    step_matrix *a)
{
    stability_matrix_fibred(p->form, law->c, law->density, p->side, h, fibres->own, fibres->other, fibres->sets.of,
                            fibres->sets.count, a);
}

stability_range step_range_of(const tled_problem *p, const tled_law *law, element_tensor h, const step_fibres *fibres)
{
    return stability_range_fibred(p->form, law->c, stability_diagonal(law->density, p->side), h, fibres->own,
                                  fibres->other, fibres->sets.of, fibres->sets.count);
}

bool step_below(const step_matrix *a, double limit)
{
    return stability_below(a, limit);
}

double step_largest(const step_matrix *a)
{
    return stability_largest(a);
}

/* No less than the square of the highest frequency of a mixed element: stiffness grows with mu and K alike, so it is at
 * most that of a volume times the larger of what these are of the volume's. */
static double square_by(const tled_law *law, const tled_volume *v)
{
    return v->square * fmax(law->mu / v->law.mu, law->bulk / v->law.bulk) * v->law.density / law->density;
}

/* Without muscles; of an element that is mixed perhaps a little more. */
static double square_of_law(const tled_problem *p, int64_t element)
{
    const tled_volume *v = &p->volume[p->element_volume[element]];
    if (tled_mix(p, element) < 0)
        return v->square;
    const tled_law law = tled_law_of(p, element);
    if (law.mu == v->law.mu && law.bulk == v->law.bulk && law.density == v->law.density)
        return v->square;
    return fmin(square_by(&law, v), square_by(&law, &p->volume[p->mix[element]]));
}

/* No less than what a passive muscle adds along its fibre, Pa: at l = 1, towards longer fibres. */
static double stiffness_at_rest(element_fibre fibre)
{
    const element_tensor rest = {0};
    const stability_muscle s = stability_muscle_at(rest, fibre);
    return fmax(s.t, 0) + fmax(s.slope, 0);
}

/* What passive muscles add to the square at most: as much as along the shortest side. */
static double square_of_muscles(const tled_problem *p, int64_t element)
{
    const double least = fmin(fmin(p->side[0], p->side[1]), p->side[2]);
    const step_fibres fibres = step_fibres_of(p, element, NULL);
    return 4 * (stiffness_at_rest(fibres.own) + stiffness_at_rest(fibres.other)) /
           (tled_law_of(p, element).density * least * least);
}

/* The square of the highest frequency of an element at rest, or a little more. */
static double square_at_rest(const tled_problem *p, int64_t element)
{
    const double square = square_of_law(p, element);
    return p->curved ? square + square_of_muscles(p, element) : square;
}

/* Of one whose fibres resist being stretched, if it is above `highest`; else `highest`. Bounds tell that of most. */
static double fibred_square_at_rest(const tled_problem *p, int64_t element, const step_fibres *fibres, double highest)
{
    const element_tensor rest = {0};
    const tled_law law = tled_law_of(p, element);
    step_matrix a;
    highest = fmax(highest, law.twists);
    if (step_range_of(p, &law, rest, fibres).high <= highest)
        return highest;
    step_matrix_of(p, &law, rest, fibres, &a);
    return step_below(&a, highest) ? highest : step_largest(&a);
}

/* What curved muscles add to the square; moments: NULL where the element is whole. */
static double muscles_at_rest(const tled_problem *p, int64_t element, const float *moments)
{
    const double raises = moments ? cut_raises(p, element, moments) : 1;
    return p->curved ? raises * square_of_muscles(p, element) : 0;
}

/* Likewise of one that is cut; muscles add no more than what they do to a whole one, raised as the law is. */
static double cut_square_at_rest(const tled_problem *p, int64_t element, const float *moments, step_fibres *fibres,
                                 double highest)
{
    const element_tensor rest = {0};
    const tled_law law = tled_law_of(p, element);
    const stability_twists whole = {law.twists, 0}, t = cut_twists(p, element, moments, whole);
    const double muscles = muscles_at_rest(p, element, moments);
    step_matrix a;
    fibres->own = fibres->other = (element_fibre){.tension = 0};
    step_matrix_of(p, &law, rest, fibres, &a);
    cut_matrix(p, element, moments, &a);
    if (step_below(&a, stability_room(t, highest - muscles)))
        return highest;
    return stability_square(t, step_largest(&a)) + muscles;
}

/* The larger of `highest` and the square of an element. */
static double higher(const tled_problem *p, int64_t element, double highest)
{
    const float *moments = tled_cut(p, element);
    const double *border = tled_border(p, element);
    if (!border && !moments && !p->fibres.of)
        return fmax(highest, square_at_rest(p, element));
    step_fibres fibres = step_fibres_of(p, element, NULL);
    if (border)
        return fmax(highest,
                    border_square_at_rest(p, element, border, &fibres, highest) + muscles_at_rest(p, element, moments));
    if (moments)
        return fmax(highest, cut_square_at_rest(p, element, moments, &fibres, highest));
    return fmax(highest,
                fibres.sets.count ? fibred_square_at_rest(p, element, &fibres, highest) : square_at_rest(p, element));
}

double step_element_at_rest(const tled_problem *p, int64_t element)
{
    const element_tensor rest = {0};
    const float *moments = tled_cut(p, element);
    const double *border = tled_border(p, element);
    const tled_law law = tled_law_of(p, element);
    const step_fibres fibres = step_fibres_of(p, element, NULL);
    if (border)
        return border_square_at_rest(p, element, border, &fibres, INFINITY) + muscles_at_rest(p, element, moments);
    double square = square_at_rest(p, element);
    if (fibres.sets.count)
        square = fmax(law.twists, step_range_of(p, &law, rest, &fibres).high);
    if (!moments)
        return cut_lighter_of(p, element) * square;
    const stability_twists whole = {law.twists, 0};
    return cut_raises(p, element, moments) * square + cut_twists(p, element, moments, whole).more;
}

enum { CHUNK = 4096 }; /* elements */

/* The squares of chunks of elements. */
typedef struct squares {
    const tled_problem *p;
    double *of; /* chunks: the highest square of each, searched alone */
} squares;

static void squares_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const squares *s = context;
    double highest = 0;
    for (int64_t i = from; i < to; i++)
        highest = higher(s->p, i, highest);
    s->of[chunk] = highest;
}

/* One element after the other: whether a matrix is computed depends on what came before, and so may the last digits. */
static double go_on(const tled_problem *p, int64_t from, int64_t to, double highest, int32_t *volume)
{
    for (int64_t i = from; i < to; i++) {
        const double square = higher(p, i, highest);
        if (square > highest && volume)
            *volume = p->element_volume[i];
        highest = square;
    }
    return highest;
}

/* Whether an element's square does not depend on what came before it. */
static bool is_plain(const tled_problem *p)
{
    return !p->cut.count && !p->borders.count && !p->fibres.of;
}

/* Chunks that are clearly below the highest before them change nothing, and are passed over: the result is that of
 * one element after the other, to the last bit. */
static double pass_over(const squares *s, int32_t *volume)
{
    const tled_problem *p = s->p;
    double highest = 0;
    for (int64_t from = 0, c = 0; from < p->elements; from += CHUNK, c++)
        if (!(is_plain(p) ? s->of[c] <= highest : s->of[c] * (1 + 1e-9) < highest))
            highest = go_on(p, from, p->elements - from < CHUNK ? p->elements : from + CHUNK, highest, volume);
    return highest;
}

double step_elements_at_rest(const tled_problem *p, int32_t *volume)
{
    err ignored = {0};
    if (p->conforming) {
        if (volume)
            *volume = p->element_volume[p->conforming->stiffest];
        return p->conforming->square;
    }
    const bool alone = !p->threads || pool_threads(p->threads) < 2;
    squares s = {p, alone ? NULL : mem_array(pool_chunks(p->elements, CHUNK), sizeof *s.of, "the step", &ignored)};
    if (!s.of)
        return go_on(p, 0, p->elements, 0, volume);
    pool_run(p->threads, p->elements, CHUNK, squares_work, &s);
    const double highest = pass_over(&s, volume);
    free(s.of);
    return highest;
}

double step_at_rest(const tled_problem *p, int32_t *volume)
{
    const double elements = step_elements_at_rest(p, volume);
    return 2 / sqrt(p->films ? fmax(elements, p->films->square) : elements);
}

double step_rate(double stable, int64_t *check)
{
    double parts, steps = fmax(1, ceil(.01 / (.5 * stable)));
    parts = ceil(steps / STEP_UNSEEN);
    *check = (int64_t)ceil(steps / parts);
    return 100 * parts * (double)*check;
}
