#include "tled/problem/films.h"

#include "base/mem.h"
#include "mesh/element_motion.h"
#include "mesh/fibre_sets.h"
#include "physics/stability.h"
#include "tled/problem/cut.h"
#include "tled/problem/film_strain.h"
#include "tled/problem/moves.h"
#include "tled/problem/muscle_fibre.h"
#include "tled/problem/step.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 256 }; /* films, or nodes */

void films_free(films *f)
{
    if (!f)
        return;
    bone_films_free(&f->rows);
    film_rest_free(&f->rest);
    free(f->fibred);
    free(f->node);
    free(f->place);
    free(f->pull_start);
    free(f->pull);
    free(f->borne);
    free(f);
}

/* ---- making */

/* The nodes that films pull, and which films do. */
static int list_nodes(films *f, const tled_problem *p, err *e)
{
    const int64_t corners = 8 * f->rows.count;
    int32_t *place = mem_array(p->nodes, sizeof *place, "the films", e);
    f->node = mem_array(p->nodes, sizeof *f->node, "the films", e);
    f->place = mem_array(corners, sizeof *f->place, "the films", e);
    f->pull = mem_array(corners, sizeof *f->pull, "the films", e);
    f->pull_start = mem_array(p->nodes + 2, sizeof *f->pull_start, "the films", e);
    const bool made = place && f->node && f->place && f->pull && f->pull_start;
    for (int64_t i = 0; made && i < corners; i++)
        place[p->element_node[8 * (int64_t)f->rows.element[i / 8] + i % 8]] = 1;
    for (int64_t n = 0; made && n < p->nodes; n++)
        if (place[n]) {
            place[n] = (int32_t)f->nodes;
            f->node[f->nodes++] = (int32_t)n;
        }
    for (int64_t i = 0; made && i < corners; i++) {
        f->place[i] = place[p->element_node[8 * (int64_t)f->rows.element[i / 8] + i % 8]];
        f->pull_start[f->place[i] + 2]++;
    }
    for (int64_t n = 0; made && n < f->nodes; n++)
        f->pull_start[n + 2] += f->pull_start[n + 1];
    for (int64_t i = 0; made && i < corners; i++)
        f->pull[f->pull_start[f->place[i] + 1]++] = (int32_t)i;
    free(place);
    return made ? 0 : -1;
}

static bool is_any(const float *of, int64_t element)
{
    const float *v = of ? of + 3 * element : NULL;
    return v && (v[0] != 0 || v[1] != 0 || v[2] != 0);
}

static int find_fibres(films *f, const tled_problem *p, err *e)
{
    f->fibred = mem_array(f->rows.count, 1, "the films", e);
    for (int64_t i = 0; f->fibred && i < f->rows.count; i++)
        f->fibred[i] = is_any(p->fibre, f->rows.element[i]) || is_any(p->mixfibre, f->rows.element[i]) ||
                       fibres_any(&p->fibres, p->element_volume[f->rows.element[i]]) ||
                       fibres_any(&p->fibres, tled_mix(p, f->rows.element[i]));
    return f->fibred ? 0 : -1;
}

static int check_muscles(const films *f, const tled_problem *p, err *e)
{
    for (int64_t i = 0; p->serial && i < f->rows.count; i++) {
        const int32_t volume = p->element_volume[f->rows.element[i]], mix = tled_mix(p, f->rows.element[i]);
        const bool is_own = p->volume[volume].serial;
        if (is_own || (mix >= 0 && p->volume[mix].serial))
            return err_set(e, NULL, 0,
                           "volume '%s' has vmax, and bone that holds it by its surface; expected materials without "
                           "vmax, or attach without --surface",
                           p->volume[is_own ? volume : mix].name);
    }
    return 0;
}

int films_share(tled_problem *p, const model *m, err *e)
{
    const element_mesh mesh = {
        p->element_node, 8,          p->elements, p->position, !p->conforming, {p->side[0], p->side[1], p->side[2]},
        p->cut,          p->borders, p->fraction};
    bone_films rows;
    if (bone_films_make(&rows, &mesh, m, e)) {
        bone_films_free(&rows);
        return -1;
    }
    if (!rows.count)
        return 0;
    p->films = mem_array(1, sizeof *p->films, "the films", e);
    if (!p->films) {
        bone_films_free(&rows);
        return -1;
    }
    p->films->rows = rows;
    p->films->whole = p->fraction;
    if (film_rest_make(&p->films->rest, m, p->elements, p->fraction, &p->borders, &p->cut, e))
        return -1;
    p->fraction = p->films->rest.fraction;
    return 0;
}

double films_whole(const tled_problem *p, int64_t element)
{
    if (!p->films)
        return tled_fraction(p, element);
    return p->films->whole ? (double)p->films->whole[element] : 1;
}

/* ---- strain and stress */

film_bone films_bone(const tled_problem *p, int64_t film, const double *value)
{
    const int32_t *hold = p->hold + 3 * (p->nodes + film);
    film_bone to = {.u = {0}};
    for (int a = 0; a < 3; a++)
        to.u[a] = hold[a] >= 0 ? moves_to(value, hold[a], a, p->films->rows.point + 3 * film) : 0;
    for (int i = 0; i < 9 && hold[0] >= 0 && (hold[0] & MOVES_BODY); i++) /* columns of A: the curves after the first */
        to.turn[i / 3][i % 3] = value[3 * ((int64_t)(hold[0] & MOVES_CURVE) + 1 + i % 3) + i / 3];
    return to;
}

element_tensor films_gradient(const tled_problem *p, int64_t film, const double *moved, const int32_t *at,
                              const double *value)
{
    const film_bone bone = films_bone(p, film, value);
    double h[9];
    bone_films_gradient(&p->films->rows, film, &bone, moved, at, h);
    return element_tensor_of(h);
}

static const tled_law *law_of(const tled_problem *p, int64_t element)
{
    return p->mixed && p->mixed[element] >= 0 ? &p->law[p->mixed[element]] : &p->volume[p->element_volume[element]].law;
}

element_tensor films_stress(const tled_problem *p, int64_t film, element_tensor h, const double *value)
{
    const int64_t element = p->films->rows.element[film];
    const tled_law *law = law_of(p, element);
    if (!p->films->fibred[film])
        return form_stress(p->form, h, law->c);
    const step_fibres of = step_fibres_of(p, element, value);
    return element_stress(p->form, h, law->c, of.own, element_fibre_which(of.own), of.other,
                          element_fibre_which(of.other), of.sets.of, of.sets.count);
}

double films_energy(const tled_problem *p, int64_t film, element_tensor h)
{
    const films *f = p->films;
    const int64_t element = f->rows.element[film];
    const fibre_sets sets = fibre_sets_at(&p->fibres, element);
    return f->rows.area[film] * f->rows.depth[film] *
           (form_energy(p->form, h, law_of(p, element)->c) + muscle_fibre_energy(p, element, h) +
            fibre_sets_energy(&sets, h));
}

void films_pull(const films *f, int64_t film, int corner, const element_tensor *s, double pull[3])
{
    const double *g = f->rows.slope + 24 * film + 3 * (int64_t)corner,
                 volume = f->rows.area[film] * f->rows.depth[film];
    pull[0] = volume * (s->xx * g[0] + s->xy * g[1] + s->xz * g[2]);
    pull[1] = volume * (s->yx * g[0] + s->yy * g[1] + s->yz * g[2]);
    pull[2] = volume * (s->zx * g[0] + s->zy * g[1] + s->zz * g[2]);
}

/* ---- forces */

int films_room(films_work *w, const tled_problem *p, err *e)
{
    *w = (films_work){.p = p};
    if (!p->films)
        return 0;
    w->moved = mem_array(p->films->nodes, 3 * sizeof *w->moved, "the films", e);
    w->stress = mem_array(p->films->rows.count, 9 * sizeof *w->stress, "the films", e);
    w->stiffness = mem_array(p->films->rows.count, 8 * sizeof *w->stiffness, "the films", e);
    return w->moved && w->stress && w->stiffness ? 0 : -1;
}

void films_room_free(films_work *w)
{
    free(w->moved);
    free(w->stress);
    free(w->stiffness);
    *w = (films_work){.p = NULL};
}

int64_t films_bytes(const films *f)
{
    return f ? (int64_t)sizeof(double) * (3 * f->nodes + 17 * f->rows.count) : 0;
}

static void strain_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const films_work *w = context;
    const films *f = w->p->films;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        const element_tensor h = films_gradient(w->p, i, w->moved, f->place + 8 * i, w->value);
        const element_tensor s = films_stress(w->p, i, h, w->value);
        const double rows[9] = {s.xx, s.xy, s.xz, s.yx, s.yy, s.yz, s.zx, s.zy, s.zz};
        memcpy(w->stress + 9 * i, rows, sizeof rows);
    }
}

void films_strain(films_work *w, pool *threads, const double *value)
{
    w->value = value;
    pool_run(threads, w->p->films->rows.count, CHUNK, strain_work, w);
}

void films_sum(const films_work *w, int64_t i, double force[3])
{
    const films *f = w->p->films;
    double sum[3] = {0};
    for (int32_t k = f->pull_start[i]; k < f->pull_start[i + 1]; k++) {
        const double *p = w->stress + 9 * (int64_t)(f->pull[k] / 8);
        const element_tensor stress = element_tensor_of(p);
        double pull[3];
        films_pull(f, f->pull[k] / 8, f->pull[k] % 8, &stress, pull);
        for (int a = 0; a < 3; a++)
            sum[a] += pull[a];
    }
    memcpy(force, sum, sizeof sum);
}

double films_energies(const tled_problem *p, const double *displacement, const double *value)
{
    const films *f = p->films;
    double sum = 0;
    for (int64_t i = 0; i < films_count(p); i++)
        sum += films_energy(
            p, i, films_gradient(p, i, displacement, p->element_node + 8 * (int64_t)f->rows.element[i], value));
    return sum;
}

/* ---- the stable step */

/* No less than the largest eigenvalue of a symmetric 3 x 3 matrix: of the largest sum of a row and the root of the sum
 * of squares the lesser. */
static double eigenvalue_most(double q[3][3])
{
    double rows = 0, squares = 0;
    for (int i = 0; i < 3; i++) {
        rows = fmax(rows, fabs(q[i][0]) + fabs(q[i][1]) + fabs(q[i][2]));
        for (int k = 0; k < 3; k++)
            squares += q[i][k] * q[i][k];
    }
    return fmin(rows, sqrt(squares));
}

/* q of a corner, from dP/dF. */
static double root_of(const step_matrix *a, const double *g)
{
    double q[3][3] = {{0}};
    for (int r = 0; r < 9; r++)
        for (int s = 0; s < 9; s++)
            q[r / 3][s / 3] += g[r % 3] * a->at[r][s] * g[s % 3];
    return sqrt(eigenvalue_most(q));
}

/* A d q_a sum_b q_b of a film's corners at H, N/m. */
static void stiffness_of(const tled_problem *p, int64_t film, element_tensor h, const double *value, double to[8])
{
    static const double unit[3] = {1, 1, 1}; /* so that the matrix is dP/dF itself, with a density of 4 */
    const films *f = p->films;
    const int64_t element = f->rows.element[film];
    const step_fibres of = step_fibres_of(p, element, value);
    double all = 0;
    step_matrix a;
    stability_matrix_fibred(p->form, law_of(p, element)->c, 4, unit, h, of.own, of.other, of.sets.of, of.sets.count,
                            &a);
    for (int c = 0; c < 8; c++) {
        to[c] = root_of(&a, f->rows.slope + 24 * film + 3 * (int64_t)c);
        all += to[c];
    }
    for (int c = 0; c < 8; c++)
        to[c] *= f->rows.area[film] * f->rows.depth[film] * all;
}

/* Those of all films at displacements of all nodes; NULL: at rest. */
typedef struct stiffening {
    const films_work *w;
    const double *displacement, *value;
} stiffening;

static void stiffness_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const stiffening *s = context;
    const tled_problem *p = s->w->p;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        const int32_t *node = p->element_node + 8 * (int64_t)p->films->rows.element[i];
        const element_tensor rest = {0};
        const element_tensor h = s->displacement ? films_gradient(p, i, s->displacement, node, s->value) : rest;
        stiffness_of(p, i, h, s->value, s->w->stiffness + 8 * i);
    }
}

/* grown: by what factor elements are stiffer than at rest. */
static double largest(const films_work *w, double grown)
{
    const films *f = w->p->films;
    double most = 0;
    for (int64_t i = 0; i < f->nodes; i++) {
        double sum = 0;
        for (int32_t k = f->pull_start[i]; k < f->pull_start[i + 1]; k++)
            sum += w->stiffness[f->pull[k]];
        most = fmax(most, grown * f->borne[i] + sum / w->p->mass[f->node[i]]);
    }
    return most;
}

double films_square(films_work *w, pool *threads, const double *displacement, const double *value, double square)
{
    const films *f = w->p ? w->p->films : NULL;
    stiffening s = {w, displacement, value};
    if (!f)
        return square;
    pool_run(threads, f->rows.count, CHUNK, stiffness_work, &s);
    return fmax(largest(w, fmax(1, square / f->elements_square)), square);
}

/* What elements bring to each node, and the model's square at rest. */
static int find_square(films *f, const tled_problem *p, err *e)
{
    films_work w;
    f->borne = mem_array(f->nodes, sizeof *f->borne, "the films", e);
    const int failed = films_room(&w, p, e) || !f->borne;
    for (int64_t i = 0; !failed && i < f->nodes; i++) {
        const int32_t *corner = p->corner + 8 * (int64_t)f->node[i];
        for (int c = 0; c < 8 && corner[c] < 8 * p->elements; c++)
            f->borne[i] += step_element_at_rest(p, corner[c] / 8) * cut_mass(p, corner[c] / 8) / 8;
        f->borne[i] /= p->mass[f->node[i]];
    }
    if (!failed) {
        stiffening s = {&w, NULL, NULL};
        stiffness_work(&s, 0, 0, f->rows.count);
        f->elements_square = step_elements_at_rest(p, NULL);
        f->square = fmax(largest(&w, 1), f->elements_square);
    }
    films_room_free(&w);
    return failed;
}

static void find_taken(films *f, const tled_problem *p)
{
    double taken = 0, all = 0;
    for (int64_t i = 0; i < p->elements; i++)
        taken += (films_whole(p, i) - tled_fraction(p, i)) * p->side[0] * p->side[1] * p->side[2];
    for (int64_t i = 0; i < f->rows.count; i++)
        all += f->rows.area[i] * f->rows.depth[i];
    f->taken = all > 0 ? taken / all : 0;
}

int films_make(tled_problem *p, err *e)
{
    films *f = p->films;
    if (!f)
        return 0;
    find_taken(f, p);
    return check_muscles(f, p, e) || find_fibres(f, p, e) || list_nodes(f, p, e) || find_square(f, p, e) ? -1 : 0;
}
