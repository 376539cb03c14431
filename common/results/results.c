#include "results/results.h"

#include "base/mem.h"
#include "base/near.h"
#include "cli/spelling.h"
#include "mesh/bone_films.h"
#include "mesh/element_fibres.h"
#include "mesh/element_motion.h"
#include "mesh/fibre_sets.h"
#include "mesh/gradient.h"
#include "model/hourglass_text.h"
#include "model/materials.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 256 }; /* elements */

#define NAME_ROW(NAME, name, array, columns)   name,
#define ARRAY_ROW(NAME, name, array, columns)  array,
#define COLUMN_ROW(NAME, name, array, columns) columns,
static const char *const names[] = {RESULTS_ROWS(NAME_ROW) "all"}; /* `all` behind them, for messages */
static const char *const arrays[] = {RESULTS_ROWS(ARRAY_ROW)};
static const int columns_of[] = {RESULTS_ROWS(COLUMN_ROW)};

struct results {
    const model *m;
    pool *threads;
    unsigned which;
    element_mesh mesh;
    material *of_volume; /* owned */
    materials_map map;
    element_fibres muscles;
    fibres_view fibres; /* owned, as is what follows */
    bone_films films;
    film_rest rest;                   /* what films leave of elements */
    film_bone *own;                   /* films: how their bone has moved in a frame */
    const int32_t *volume, *material; /* elements, volumes */
    int64_t materials;
    const float *fraction;     /* elements; NULL: 1 */
    hourglass_control control; /* of the run, for laminates */
    double *part;              /* chunks of elements, then of films, x materials, J: owned */
    /* Of the frame that is looked at: */
    const double *u, *activation; /* nodes x 3, m; volumes, NULL: nothing contracts */
    const film_bone *bone;
    float *to[RESULTS]; /* of elements; NULL: not wanted */
    bool sums;          /* part is wanted */
};

/* ---- names */

int results_find(const char *name)
{
    char british[MODEL_NAME];
    int i = 0;
    const char *known = spelling_british(name, strlen(name), british, sizeof british) ? british : name;
    while (i < RESULTS && strcmp(known, names[i]) != 0 && strcmp(known, arrays[i]) != 0)
        i++;
    return i;
}

const char *results_array(int row)
{
    return arrays[row];
}

int results_columns(int row)
{
    return columns_of[row];
}

int results_read(const char *list, const char *option, unsigned *which, err *e)
{
    char name[MODEL_NAME];
    while (*list) {
        const size_t n = strcspn(list, ",");
        snprintf(name, sizeof name, "%.*s", (int)n, list);
        const int row = results_find(name);
        if (row == RESULTS && strcmp(name, "all") != 0)
            return near_option(e, option, "result", name, names, RESULTS + 1);
        *which |= row == RESULTS ? (1U << RESULTS) - 1 : 1U << row;
        list += n + (list[n] == ',');
    }
    return 0;
}

/* ---- an element */

static element_tensor linear_stress(element_tensor h, const double *c)
{
    const double mean = (h.xx + h.yy + h.zz) / 3, press = 3 * c[1] * mean;
    const double xy = c[0] * (h.xy + h.yx), yz = c[0] * (h.yz + h.zy), zx = c[0] * (h.zx + h.xz);
    return (element_tensor){2 * c[0] * (h.xx - mean) + press, xy, zx, xy, 2 * c[0] * (h.yy - mean) + press, yz, zx, yz,
                            2 * c[0] * (h.zz - mean) + press};
}

static double linear_energy(element_tensor h, const double *c)
{
    const double trace = h.xx + h.yy + h.zz, mean = trace / 3;
    const double xx = h.xx - mean, yy = h.yy - mean, zz = h.zz - mean;
    const double xy = (h.xy + h.yx) / 2, yz = (h.yz + h.zy) / 2, zx = (h.zx + h.xz) / 2;
    return c[0] * (xx * xx + yy * yy + zz * zz + 2 * (xy * xy + yz * yz + zx * zx)) + c[1] / 2 * trace * trace;
}

/* An element, its law, what its muscles do, and what of its fibres resists being stretched. */
typedef struct held {
    element_tensor h;
    double volume; /* m3, at rest, of what is tissue */
    form form;
    double c[FORM_NUMBERS];
    element_fibre fibre, second;
    fibre_sets sets;
    bool is_laminate; /* of these two parts, in place of its law */
    laminate_motion parts;
} held;

/* Fills what an element has in common with its films. */
static held held_at(const results *r, int64_t i, element_tensor h, double volume)
{
    const material_numbers own = materials_of_element(&r->map, i);
    held to = {.h = h,
               .volume = volume,
               .form = own.form,
               .fibre = element_fibres_first(&r->muscles, i, r->activation),
               .second = element_fibres_second(&r->muscles, i, r->activation),
               .sets = fibre_sets_at(&r->fibres, i)};
    memcpy(to.c, own.c, sizeof to.c);
    return to;
}

static held held_of(const results *r, int64_t i)
{
    const element_motion is = element_motion_of(&r->mesh, i, r->u);
    held to = held_at(r, i, is.h, is.volume * (r->fraction ? (double)r->fraction[i] : 1));
    to.is_laminate = laminates_at(&r->mesh, &r->map, r->control, i, &is, &to.parts);
    return to;
}

/* Of its law alone, by volume at rest. */
static double law_energy(const held *of)
{
    if (of->is_laminate)
        return laminates_energy(&of->parts, 0) + laminates_energy(&of->parts, 1);
    return of->form == FORM_LINEAR ? linear_energy(of->h, of->c) : form_energy(of->form, of->h, of->c);
}

/* And of its muscles and fibres that are stretched. */
static double energy_of_held(const held *of)
{
    return law_energy(of) + element_fibre_energy(of->h, of->fibre) + element_fibre_energy(of->h, of->second) +
           fibre_sets_energy(&of->sets, of->h);
}

/* P of muscles and fibres, and of the law but in laminates. */
static element_tensor stress_of(const held *of)
{
    double c[FORM_NUMBERS];
    memcpy(c, of->c, sizeof c);
    if (of->is_laminate)
        memset(c, 0, (size_t)form_moduli(of->form) * sizeof *c);
    return element_stress(of->form, of->h, c, of->fibre, element_fibre_which(of->fibre), of->second,
                          element_fibre_which(of->second), of->sets.of, of->sets.count);
}

/* Cauchy's, P F^T / J, Pa: 3 x 3. nan where J is not above 0. Of what is linear the stress of small strains. */
static void cauchy_of(const held *of, double to[9])
{
    const element_tensor h = of->h;
    element_tensor p = of->form == FORM_LINEAR ? linear_stress(h, of->c) : stress_of(of);
    const double volume = 1 + element_dilation(h);
    const element_tensor f = {1 + h.xx, h.yx, h.zx, h.xy, 1 + h.yy, h.zy, h.xz, h.yz, 1 + h.zz}; /* F^T */
    if (of->form != FORM_LINEAR)
        p = element_product(p, f);
    if (of->is_laminate)
        p = element_sum(p, laminates_stress(&of->parts));
    const double row[9] = {p.xx, p.xy, p.xz, p.yx, p.yy, p.yz, p.zx, p.zy, p.zz};
    for (int k = 0; k < 9; k++)
        to[k] = of->form == FORM_LINEAR ? row[k] : row[k] / (volume > 0 ? volume : (double)NAN);
}

/* xx yy zz xy yz xz, as VTK has them. */
static void put_symmetric(const double t[9], float *to)
{
    static const int at[6] = {0, 4, 8, 1, 5, 2};
    for (int k = 0; k < 6; k++)
        to[k] = (float)t[at[k]];
}

static void put_stretches(const element_symmetric *e, float *to)
{
    const double t[9] = {e->xx, e->xy, e->zx, e->xy, e->yy, e->yz, e->zx, e->yz, e->zz};
    double principal[3];
    gradient_principal(t, principal);
    for (int k = 0; k < 3; k++)
        to[k] = (float)sqrt(fmax(1 + principal[k], 0));
}

static void put_strain(const element_symmetric *e, float *to)
{
    const double t[9] = {e->xx / 2, e->xy / 2, e->zx / 2, 0, e->yy / 2, e->yz / 2, 0, 0, e->zz / 2};
    put_symmetric(t, to);
}

/* Along the element's fibre, or along the second volume's where it has none. */
static double fibre_stretch(const held *of)
{
    const element_vector a = element_length(of->fibre.along) > 0 ? of->fibre.along : of->second.along;
    return element_length(a) > 0 ? element_length(element_fibre_now(of->h, a)) : (double)NAN;
}

/* A row is nan as a whole or not at all. */
static void close_row(float *row, int columns)
{
    bool whole = true;
    for (int k = 0; k < columns; k++)
        whole &= isfinite(row[k]) != 0;
    for (int k = 0; k < columns && !whole; k++)
        row[k] = NAN;
}

static void put_element(const results *r, int64_t i, const held *of)
{
    double cauchy[9];
    const element_symmetric e = element_green(of->h);
    if (r->to[RESULTS_STRESS] || r->to[RESULTS_MISES])
        cauchy_of(of, cauchy);
    if (r->to[RESULTS_STRESS])
        put_symmetric(cauchy, r->to[RESULTS_STRESS] + 6 * i);
    if (r->to[RESULTS_MISES])
        r->to[RESULTS_MISES][i] = (float)gradient_mises(cauchy);
    if (r->to[RESULTS_STRAIN])
        put_strain(&e, r->to[RESULTS_STRAIN] + 6 * i);
    if (r->to[RESULTS_STRETCH])
        put_stretches(&e, r->to[RESULTS_STRETCH] + 3 * i);
    if (r->to[RESULTS_FIBRE_STRETCH])
        r->to[RESULTS_FIBRE_STRETCH][i] = (float)fibre_stretch(of);
    if (r->to[RESULTS_ENERGY])
        r->to[RESULTS_ENERGY][i] = (float)energy_of_held(of);
    for (int k = 0; k < RESULTS; k++)
        if (r->to[k])
            close_row(r->to[k] + columns_of[k] * i, columns_of[k]);
}

/* What is mixed of two volumes holds its law's energy in the materials of both, by their shares; muscles and fibres
 * that are stretched hold theirs in their own. */
static void add_energy(const results *r, int64_t i, const held *of, double *sum)
{
    const int32_t mix = r->map.mix ? r->map.mix[i] : -1;
    const double share = mix < 0 ? 0 : (double)r->map.mixture[i], energy = of->volume * law_energy(of);
    const double first = of->is_laminate ? of->volume * laminates_energy(&of->parts, 0) : (1 - share) * energy;
    const double second = of->is_laminate ? of->volume * laminates_energy(&of->parts, 1) : share * energy;
    sum[r->material[r->volume[i]]] += first + of->volume * element_fibre_energy(of->h, of->fibre);
    if (mix >= 0)
        sum[r->material[mix]] += second + of->volume * element_fibre_energy(of->h, of->second);
    for (int k = 0; k < of->sets.count; k++)
        sum[r->material[of->sets.second[k] ? mix : r->volume[i]]] += of->volume * fibre_energy(of->h, &of->sets.of[k]);
}

/* ---- a frame */

static void work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const results *r = context;
    double *sum = r->part + chunk * r->materials;
    memset(sum, 0, (size_t)r->materials * sizeof *sum);
    for (int64_t i = from; i < to; i++) {
        const held of = held_of(r, i);
        put_element(r, i, &of);
        if (r->sums)
            add_energy(r, i, &of, sum);
    }
}

static int64_t chunks_of_elements(const results *r)
{
    return pool_chunks(r->mesh.elements, CHUNK);
}

static void film_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const results *r = context;
    double *sum = r->part + (chunks_of_elements(r) + chunk) * r->materials;
    memset(sum, 0, (size_t)r->materials * sizeof *sum);
    for (int64_t i = from; i < to; i++) {
        const int64_t element = r->films.element[i];
        double h[9];
        bone_films_gradient(&r->films, i, &r->bone[i], r->u, r->mesh.node + 8 * element, h);
        const held of = held_at(r, element, element_tensor_of(h), r->films.area[i] * r->films.depth[i]);
        add_energy(r, element, &of, sum);
    }
}

static void look(results *r, double *energies)
{
    const int64_t chunks = chunks_of_elements(r) + pool_chunks(r->films.count, CHUNK);
    r->sums = energies != NULL;
    pool_run(r->threads, r->mesh.elements, CHUNK, work, r);
    if (r->sums && r->films.count)
        pool_run(r->threads, r->films.count, CHUNK, film_work, r);
    for (int64_t i = 0; energies && i < r->materials; i++) {
        energies[i] = 0;
        for (int64_t c = 0; c < chunks; c++)
            energies[i] += r->part[c * r->materials + i];
    }
    memset(r->to, 0, sizeof r->to);
}

void results_energies(results *r, const double *u, const film_bone *bone, double *to)
{
    r->u = u;
    r->bone = bone;
    r->activation = NULL;
    r->muscles.contractile = r->muscles.mixcontractile = NULL;
    look(r, to);
}

static const double *doubles_of(const frame *f, const char *name)
{
    const model_array *a = frame_find(f, name);
    return a ? a->f64 : NULL;
}

static void take_frame(results *r, const frame *f)
{
    const model_array *activation = frame_find(f, arrays[RESULTS_ACTIVATION]);
    r->u = frame_find(f, "node.displacement")->f64;
    r->muscles.contractile = doubles_of(f, "element.contractile");
    r->muscles.mixcontractile = doubles_of(f, "element.mixcontractile");
    r->activation = activation ? activation->f64 : NULL;
    bone_films_moved(&r->films, f, r->own);
    r->bone = r->own;
}

void results_of_elements(results *r, int row, const frame *f, float *to)
{
    take_frame(r, f);
    r->to[row] = to;
    look(r, NULL);
}

/* What is not computed but told. */
static int add_activation(const results *r, frame *f, const double *activation, err *e)
{
    if (!activation || !(r->which >> RESULTS_ACTIVATION & 1))
        return 0;
    const model_array *a = frame_add(f, r->m, arrays[RESULTS_ACTIVATION], e);
    if (!a)
        return -1;
    memcpy(a->f64, activation, (size_t)a->rows * sizeof *activation);
    return 0;
}

int results_add(results *r, frame *f, const double *activation, err *e)
{
    double *energies = NULL;
    if (!frame_find(f, "node.displacement"))
        return err_set(e, NULL, 0, "frame %lld has no node.displacement; expected results of tled-run or msds-run",
                       (long long)f->index);
    if (add_activation(r, f, activation, e))
        return -1;
    take_frame(r, f);
    r->activation = activation ? activation : r->activation;
    for (int k = 0; k < RESULTS; k++) {
        if (!(r->which >> k & 1) || k == RESULTS_ACTIVATION)
            continue;
        const model_array *a = frame_add(f, r->m, arrays[k], e);
        if (!a)
            return -1;
        if (k == RESULTS_MATERIAL_ENERGY)
            energies = a->f64;
        else
            r->to[k] = a->f32;
    }
    look(r, energies);
    return 0;
}

/* ---- of a model */

/* How hourglass modes were held, which the model says where tled-run moved it. */
static int take_control(results *r, err *e)
{
    const char *control = model_meta_of(r->m, "hourglass.control");
    if (r->mesh.borders.count && control && hourglass_read(control, &r->control))
        return err_set(e, NULL, 0, "hourglass.control holds '%.60s'; expected physical or isotropic:KAPPA", control);
    return 0;
}

/* Makes the films; an element then counts as what they leave of it. */
static int take_films(results *r, err *e)
{
    r->fraction = r->mesh.fraction;
    if (bone_films_make(&r->films, &r->mesh, r->m, e))
        return -1;
    if (!r->films.count)
        return 0;
    r->own = mem_array(r->films.count, sizeof *r->own, "the results", e);
    if (!r->own || film_rest_make(&r->rest, r->m, r->mesh.elements, r->fraction, &r->mesh.borders, &r->mesh.cut, e))
        return -1;
    r->fraction = r->rest.fraction;
    return 0;
}

static int open_model(results *r, err *e)
{
    const model *m = r->m;
    const model_array *volume = model_need(m, "element.volume", e);
    if (!volume || element_mesh_of(&r->mesh, m, e) || !(r->of_volume = materials_of_volumes(m, e)) ||
        fibres_make(&r->fibres, m, r->of_volume, e) || take_control(r, e) || take_films(r, e))
        return -1;
    r->map = materials_map_of(m, r->of_volume);
    r->volume = volume->i32;
    r->material = model_find(m, "volume.material")->i32;
    r->materials = model_count(m, "material");
    r->muscles = element_fibres_of(m, &r->map);
    const int64_t chunks = chunks_of_elements(r) + pool_chunks(r->films.count, CHUNK);
    r->part = mem_array(chunks * r->materials, sizeof *r->part, "the results", e);
    return r->part ? 0 : -1;
}

int results_create(results **r, const model *m, unsigned which, pool *threads, err *e)
{
    *r = mem_array(1, sizeof **r, "the results", e);
    if (!*r)
        return -1;
    (*r)->m = m;
    (*r)->which = which;
    (*r)->threads = threads;
    if (!open_model(*r, e))
        return 0;
    results_destroy(*r);
    *r = NULL;
    return -1;
}

void results_destroy(results *r)
{
    if (!r)
        return;
    fibres_free(&r->fibres);
    bone_films_free(&r->films);
    film_rest_free(&r->rest);
    free(r->own);
    free(r->of_volume);
    free(r->part);
    free(r);
}
