#include "tled/problem/films.h"

#include "base/mem.h"
#include "mesh/fibre_sets.h"
#include "mesh/lattice.h"
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
    free(f->normal);
    free(f->slope);
    free(f->fibred);
    free(f->node);
    free(f->place);
    free(f->pull_start);
    free(f->pull);
    free(f->fraction);
    free(f->cut_element);
    free(f->cut_moments);
    free(f->borne);
    free(f);
}

/* ---- making */

static int borrow(films *f, const model *m, err *e)
{
    const model_array *element = model_need(m, "bone.element", e), *anchor = model_need(m, "bone.anchor", e);
    const model_array *point = model_need(m, "bone.point", e), *depth = model_need(m, "bone.depth", e);
    const model_array *area = model_need(m, "bone.area", e), *body = model_find(m, "bone.body");
    if (!element || !anchor || !point || !depth || !area || !model_need(m, "bone.normal", e))
        return -1;
    f->count = element->rows;
    f->element = element->i32;
    f->anchor = anchor->i32;
    f->body = body ? body->i32 : NULL;
    f->point = point->f64;
    f->depth = depth->f64;
    f->area = area->f64;
    for (int64_t i = 0; i < f->count; i++)
        if (!(f->depth[i] > 0) || !(f->area[i] > 0))
            return err_set(e, NULL, 0, "bone.depth and bone.area, row %lld, are %g and %g; expected both above 0",
                           (long long)i, f->depth[i], f->area[i]);
    return 0;
}

/* Unit normals as they are used: those of a model may be off in length by a little. */
static int take_normals(films *f, const model *m, err *e)
{
    const float *of = model_find(m, "bone.normal")->f32;
    f->normal = mem_array(f->count, 3 * sizeof *f->normal, "the films", e);
    for (int64_t i = 0; f->normal && i < f->count; i++) {
        const double x = (double)of[3 * i], y = (double)of[3 * i + 1], z = (double)of[3 * i + 2];
        const double length = sqrt(x * x + y * y + z * z);
        if (!(length > 0))
            return err_set(e, NULL, 0, "bone.normal, row %lld, is 0 0 0; expected a unit normal", (long long)i);
        f->normal[3 * i] = x / length;
        f->normal[3 * i + 1] = y / length;
        f->normal[3 * i + 2] = z / length;
    }
    return f->normal ? 0 : -1;
}

/* How far from an element's box a point may be, in its sides: attach takes those that are half a voxel away. */
static const double farthest = 1;

/* The place of a film's point in its element, in its sides from the first corner. */
static int place_of(const films *f, const tled_problem *p, int64_t film, double at[3], err *e)
{
    const int32_t *node = p->element_node + 8 * (int64_t)f->element[film];
    for (int a = 0; a < 3; a++) {
        at[a] = (f->point[3 * film + a] - p->position[3 * (int64_t)node[0] + a]) / p->side[a];
        if (!(at[a] >= -farthest && at[a] <= 1 + farthest))
            return err_set(e, NULL, 0, "bone.point, row %lld, is away from its element, %d; expected it near to that",
                           (long long)film, (int)f->element[film]);
    }
    return 0;
}

/* g of a corner. */
static void slope_of(const films *f, const tled_problem *p, int64_t film, const double at[3], int corner, double g[3])
{
    const double *n = f->normal + 3 * film;
    double of[3], grad[3], along = 0;
    for (int a = 0; a < 3; a++)
        of[a] = lattice_vtk[corner][a] ? at[a] : 1 - at[a];
    for (int a = 0; a < 3; a++) {
        grad[a] = (lattice_vtk[corner][a] ? 1 : -1) / p->side[a] * of[(a + 1) % 3] * of[(a + 2) % 3];
        along += grad[a] * n[a];
    }
    for (int a = 0; a < 3; a++)
        g[a] = of[0] * of[1] * of[2] / f->depth[film] * n[a] + (grad[a] - along * n[a]) / 2;
}

static int find_slopes(films *f, const tled_problem *p, err *e)
{
    double at[3] = {0};
    f->slope = mem_array(f->count, 24 * sizeof *f->slope, "the films", e);
    if (!f->slope)
        return -1;
    for (int64_t i = 0; i < f->count; i++) {
        if (place_of(f, p, i, at, e))
            return -1;
        for (int c = 0; c < 8; c++)
            slope_of(f, p, i, at, c, f->slope + 24 * i + 3 * (int64_t)c);
    }
    return 0;
}

/* The nodes that films pull, and which films do. */
static int list_nodes(films *f, const tled_problem *p, err *e)
{
    const int64_t corners = 8 * f->count;
    int32_t *place = mem_array(p->nodes, sizeof *place, "the films", e);
    f->node = mem_array(p->nodes, sizeof *f->node, "the films", e);
    f->place = mem_array(corners, sizeof *f->place, "the films", e);
    f->pull = mem_array(corners, sizeof *f->pull, "the films", e);
    f->pull_start = mem_array(p->nodes + 2, sizeof *f->pull_start, "the films", e);
    const bool made = place && f->node && f->place && f->pull && f->pull_start;
    for (int64_t i = 0; made && i < corners; i++)
        place[p->element_node[8 * (int64_t)f->element[i / 8] + i % 8]] = 1;
    for (int64_t n = 0; made && n < p->nodes; n++)
        if (place[n]) {
            place[n] = (int32_t)f->nodes;
            f->node[f->nodes++] = (int32_t)n;
        }
    for (int64_t i = 0; made && i < corners; i++) {
        f->place[i] = place[p->element_node[8 * (int64_t)f->element[i / 8] + i % 8]];
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
    f->fibred = mem_array(f->count, 1, "the films", e);
    for (int64_t i = 0; f->fibred && i < f->count; i++)
        f->fibred[i] = is_any(p->fibre, f->element[i]) || is_any(p->mixfibre, f->element[i]) ||
                       fibres_any(&p->fibres, p->element_volume[f->element[i]]) ||
                       fibres_any(&p->fibres, tled_mix(p, f->element[i]));
    return f->fibred ? 0 : -1;
}

static int check_muscles(const films *f, const tled_problem *p, err *e)
{
    for (int64_t i = 0; p->serial && i < f->count; i++) {
        const int32_t volume = p->element_volume[f->element[i]], mix = tled_mix(p, f->element[i]);
        const bool is_own = p->volume[volume].serial;
        if (is_own || (mix >= 0 && p->volume[mix].serial))
            return err_set(e, NULL, 0,
                           "volume '%s' has vmax, and bone that holds it by its surface; expected materials without "
                           "vmax, or attach without --surface",
                           p->volume[is_own ? volume : mix].name);
    }
    return 0;
}

/* Of a model that has any. */
static int begin(tled_problem *p, const model *m, err *e)
{
    if (p->conforming)
        return err_set(e, NULL, 0, "bone.element is of elements without a lattice; expected a lattice's boxes");
    p->films = mem_array(1, sizeof *p->films, "the films", e);
    return p->films ? borrow(p->films, m, e) : -1;
}

/* ---- shares */

typedef struct share_row {
    double share;
    const float *moments;
} share_row;

/* What films have of an element is never all of it, so that all nodes hang on something. */
static const double most_of = .8;

static int check_rows(const model_array *element, const model_array *share, err *e)
{
    for (int64_t i = 1; i < element->rows; i++)
        if (element->i32[i] <= element->i32[i - 1])
            return err_set(e, NULL, 0, "film.element, row %lld is %d after %d; expected ascending numbers",
                           (long long)i, (int)element->i32[i], (int)element->i32[i - 1]);
    return share ? 0 : -1;
}

static void take_shares(films *f, const tled_problem *p, const model_array *element, const float *share)
{
    for (int64_t i = 0; i < p->elements; i++)
        f->fraction[i] = f->whole ? f->whole[i] : 1;
    for (int64_t i = 0; i < element->rows; i++) {
        const double whole = (double)f->fraction[element->i32[i]];
        f->fraction[element->i32[i]] = (float)(whole - fmin((double)share[i], most_of * whole));
    }
}

/* The moments of what is left of an element: whole - part, by their means and shares. */
static void moments_left(const float *whole, double share, const float *part, double taken, float *to)
{
    const double left = fmax(share - taken, (1 - most_of) * share);
    for (int k = 0; k < CUT_MOMENTS; k++) {
        const double of_whole = whole ? (double)whole[k] : 0;
        const double of_part = taken < most_of * share ? (double)part[k] : of_whole;
        const double rest = share * of_whole - fmin(taken, most_of * share) * of_part;
        to[k] = (float)fmax(-1, fmin(1, rest / left));
    }
}

/* The next row from k on of an element that is no laminate: of those what films leave has the share alone. */
static int64_t next_cut(const tled_problem *p, const model_array *element, int64_t k)
{
    while (k < element->rows && tled_border(p, element->i32[k]))
        k++;
    return k;
}

/* Rows of elements that are cut, by the model or by films; those of both are in order. */
static int join_cuts(films *f, tled_problem *p, const model_array *element, const float *share, const float *moments,
                     err *e)
{
    const cut_moments of = p->cut;
    const int64_t room = of.count + element->rows;
    int64_t count = 0;
    f->cut_element = mem_array(room, sizeof *f->cut_element, "the films", e);
    f->cut_moments = f->cut_element ? mem_array(room, CUT_MOMENTS * sizeof *f->cut_moments, "the films", e) : NULL;
    if (!f->cut_moments)
        return -1;
    for (int64_t i = 0, k = next_cut(p, element, 0); i < of.count || k < element->rows; count++) {
        const int32_t cut = i < of.count ? of.element[i] : INT32_MAX;
        const int32_t film = k < element->rows ? element->i32[k] : INT32_MAX;
        const int32_t at = cut < film ? cut : film;
        const float *whole = of.of + CUT_MOMENTS * i;
        float *to = f->cut_moments + CUT_MOMENTS * count;
        f->cut_element[count] = at;
        if (film == at)
            moments_left(cut == at ? whole : NULL, films_whole(p, at), moments + CUT_MOMENTS * k, (double)share[k], to);
        else
            memcpy(to, whole, CUT_MOMENTS * sizeof *to);
        i += cut == at;
        k = film == at ? next_cut(p, element, k + 1) : k;
    }
    p->cut = (cut_moments){f->cut_element, f->cut_moments, count};
    return 0;
}

int films_share(tled_problem *p, const model *m, err *e)
{
    const model_array *element = model_find(m, "film.element"), *share = model_find(m, "film.share");
    if (!model_find(m, "bone.element") && !element)
        return 0;
    if (begin(p, m, e))
        return -1;
    films *f = p->films;
    element = model_need(m, "film.element", e);
    share = element ? model_need(m, "film.share", e) : NULL;
    const model_array *moments = share ? model_need(m, "film.moments", e) : NULL;
    if (!moments || check_rows(element, share, e))
        return -1;
    f->whole = p->fraction;
    f->fraction = mem_array(p->elements, sizeof *f->fraction, "the films", e);
    if (!f->fraction)
        return -1;
    take_shares(f, p, element, share->f32);
    p->fraction = f->fraction;
    return p->cut.count ? join_cuts(f, p, element, share->f32, moments->f32, e) : 0;
}

double films_whole(const tled_problem *p, int64_t element)
{
    if (!p->films)
        return tled_fraction(p, element);
    return p->films->whole ? (double)p->films->whole[element] : 1;
}

/* ---- strain and stress */

void films_bone(const tled_problem *p, int64_t film, const double *value, double u[3], double turn[3][3])
{
    const int32_t *hold = p->hold + 3 * (p->nodes + film);
    memset(turn, 0, 9 * sizeof turn[0][0]);
    for (int a = 0; a < 3; a++)
        u[a] = hold[a] >= 0 ? moves_to(value, hold[a], a, p->films->point + 3 * film) : 0;
    if (hold[0] < 0 || !(hold[0] & MOVES_BODY))
        return;
    for (int i = 0; i < 9; i++) /* columns of A: the curves after the first */
        turn[i / 3][i % 3] = value[3 * ((int64_t)(hold[0] & MOVES_CURVE) + 1 + i % 3) + i / 3];
}

/* What a film's gradient has of the bone: R - I - (R - I) T / 2 - u n / d. */
static void of_bone(const tled_problem *p, int64_t film, const double *value, double h[3][3])
{
    const double *n = p->films->normal + 3 * film;
    double u[3], turn[3][3];
    films_bone(p, film, value, u, turn);
    for (int i = 0; i < 3; i++) {
        const double along = turn[i][0] * n[0] + turn[i][1] * n[1] + turn[i][2] * n[2];
        for (int k = 0; k < 3; k++)
            h[i][k] = (turn[i][k] + along * n[k]) / 2 - u[i] / p->films->depth[film] * n[k];
    }
}

element_tensor films_gradient(const tled_problem *p, int64_t film, const double *moved, const int32_t *at,
                              const double *value)
{
    const double *slope = p->films->slope + 24 * film;
    double h[3][3];
    of_bone(p, film, value, h);
    for (int c = 0; c < 8; c++)
        for (int i = 0; i < 9; i++)
            h[i / 3][i % 3] += moved[3 * (int64_t)at[c] + i / 3] * slope[3 * c + i % 3];
    const element_tensor to = {h[0][0], h[0][1], h[0][2], h[1][0], h[1][1], h[1][2], h[2][0], h[2][1], h[2][2]};
    return to;
}

static const tled_law *law_of(const tled_problem *p, int64_t element)
{
    return p->mixed && p->mixed[element] >= 0 ? &p->law[p->mixed[element]] : &p->volume[p->element_volume[element]].law;
}

element_tensor films_stress(const tled_problem *p, int64_t film, element_tensor h, const double *value)
{
    const int64_t element = p->films->element[film];
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
    const int64_t element = f->element[film];
    const fibre_sets sets = fibre_sets_at(&p->fibres, element);
    return f->area[film] * f->depth[film] *
           (form_energy(p->form, h, law_of(p, element)->c) + muscle_fibre_energy(p, element, h) +
            fibre_sets_energy(&sets, h));
}

void films_pull(const films *f, int64_t film, int corner, const element_tensor *s, double pull[3])
{
    const double *g = f->slope + 24 * film + 3 * (int64_t)corner, volume = f->area[film] * f->depth[film];
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
    w->stress = mem_array(p->films->count, 9 * sizeof *w->stress, "the films", e);
    w->stiffness = mem_array(p->films->count, 8 * sizeof *w->stiffness, "the films", e);
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
    return f ? (int64_t)sizeof(double) * (3 * f->nodes + 17 * f->count) : 0;
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
    pool_run(threads, w->p->films->count, CHUNK, strain_work, w);
}

void films_sum(const films_work *w, int64_t i, double force[3])
{
    const films *f = w->p->films;
    double sum[3] = {0};
    for (int32_t k = f->pull_start[i]; k < f->pull_start[i + 1]; k++) {
        const double *p = w->stress + 9 * (int64_t)(f->pull[k] / 8);
        const element_tensor stress = {p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]};
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
        sum +=
            films_energy(p, i, films_gradient(p, i, displacement, p->element_node + 8 * (int64_t)f->element[i], value));
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
    const int64_t element = f->element[film];
    const step_fibres of = step_fibres_of(p, element, value);
    double all = 0;
    step_matrix a;
    stability_matrix_fibred(p->form, law_of(p, element)->c, 4, unit, h, of.own, of.other, of.sets.of, of.sets.count,
                            &a);
    for (int c = 0; c < 8; c++) {
        to[c] = root_of(&a, f->slope + 24 * film + 3 * (int64_t)c);
        all += to[c];
    }
    for (int c = 0; c < 8; c++)
        to[c] *= f->area[film] * f->depth[film] * all;
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
        const int32_t *node = p->element_node + 8 * (int64_t)p->films->element[i];
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
    pool_run(threads, f->count, CHUNK, stiffness_work, &s);
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
        stiffness_work(&s, 0, 0, f->count);
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
    for (int64_t i = 0; i < f->count; i++)
        all += f->area[i] * f->depth[i];
    f->taken = all > 0 ? taken / all : 0;
}

int films_make(tled_problem *p, const model *m, err *e)
{
    films *f = p->films;
    if (!f)
        return 0;
    find_taken(f, p);
    return check_muscles(f, p, e) || take_normals(f, m, e) || find_slopes(f, p, e) || find_fibres(f, p, e) ||
                   list_nodes(f, p, e) || find_square(f, p, e)
               ? -1
               : 0;
}
