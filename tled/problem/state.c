#include "tled/problem/state.h"

#include "base/mem.h"
#include "mesh/lattice.h"
#include "model/material_elements.h"
#include "model/materials.h"
#include "physics/stability.h"
#include "tled/problem/bodies.h"
#include "tled/problem/conforming.h"
#include "tled/problem/conforming_step.h"
#include "tled/problem/cut.h"
#include "tled/problem/films.h"
#include "tled/problem/followers.h"
#include "tled/problem/loads.h"
#include "tled/problem/muscle_fibre.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* How a run begins without contractile elements. */
#define WITHOUT_CONTRACTILE "muscles as strong as if they had not moved"

/* velocity: where the velocity is written. */
#define STATE_FIELDS(velocity)                                                                                         \
    {                                                                                                                  \
        [TLED_DISPLACEMENT] = {"node.displacement", "m", FIELD_NODE, 3, FIELD_IN_FRAMES | FIELD_IN_CHECKPOINTS, NULL}, \
        [TLED_VELOCITY] = {"node.velocity", "m/s", FIELD_NODE, 3, velocity, "velocity 0"},                             \
        [TLED_CONTRACTILE] = {"element.contractile", "1", FIELD_ELEMENT, 1, FIELD_IN_FRAMES | FIELD_IN_CHECKPOINTS,    \
                              WITHOUT_CONTRACTILE},                                                                    \
        [TLED_MIXCONTRACTILE] = {                                                                                      \
            "element.mixcontractile", "1", FIELD_ELEMENT, 1, FIELD_IN_FRAMES | FIELD_IN_CHECKPOINTS,                   \
            WITHOUT_CONTRACTILE},                                                                                      \
    }

static const field state_field[] = STATE_FIELDS(FIELD_IN_FRAMES | FIELD_IN_CHECKPOINTS);
static const field state_field_still[] = STATE_FIELDS(FIELD_IN_CHECKPOINTS);

fields tled_fields(int64_t nodes, int64_t elements)
{
    return (fields){
        .field = state_field, .count = TLED_CONTRACTILE, .rows = {[FIELD_NODE] = nodes, [FIELD_ELEMENT] = elements}};
}

void tled_problem_still(tled_problem *p)
{
    p->fields.field = state_field_still;
}

/* Where all is known that the state may have. */
static int make_fields(tled_problem *p, err *e)
{
    p->fields = tled_fields(p->nodes, p->elements);
    if (p->serial)
        p->fields.count = p->mixfibre ? TLED_MIXCONTRACTILE + 1 : TLED_CONTRACTILE + 1;
    return fields_allocate(&p->fields, FIELDS_ALL, &p->at_start, "the nodes", e);
}

static void forget_loads(tled_problem *p)
{
    free(p->force_start);
    free(p->force_curve);
    free(p->force_spring);
    free(p->force_share);
    followers_free(p->followers);
    p->force_start = p->force_curve = p->force_spring = NULL;
    p->force_share = NULL;
    p->followers = NULL;
}

void tled_problem_free(tled_problem *p)
{
    fibres_free(&p->fibres);
    free(p->mixed);
    free(p->own_mix);
    free(p->own_mixture);
    free(p->law);
    free(p->volume);
    conforming_free(p->conforming);
    free(p->corner);
    free(p->corner_start);
    free(p->mass);
    free(p->weight);
    free(p->border);
    free(p->hold);
    bodies_free(p->bodies);
    films_free(p->films);
    forget_loads(p);
    fields_free(&p->at_start);
    memset(p, 0, sizeof *p);
}

/* What some elements are mixed of, if any is. */
static int borrow_mixes(tled_problem *p, const model *m, err *e)
{
    const model_array *mix = model_find(m, "element.mix"), *mixfibre = model_find(m, "element.mixfibre");
    const model_array *mixture = mix ? model_need(m, "element.mixture", e) : NULL;
    bool any = false;
    if (!mix)
        return 0;
    if (!mixture || (mixfibre && !model_need(m, "element.fibre", e)))
        return -1;
    for (int64_t i = 0; i < mix->rows; i++)
        any |= mix->i32[i] >= 0;
    p->mix = any ? mix->i32 : NULL;
    p->mixture = any ? mixture->f32 : NULL;
    p->mixfibre = any && mixfibre ? mixfibre->f32 : NULL;
    return 0;
}

static int borrow_mesh(tled_problem *p, const model *m, err *e)
{
    const model_array *node = model_need(m, "element.node", e), *position = model_need(m, "node.position", e);
    const model_array *volume = model_need(m, "element.volume", e), *fibre = model_find(m, "element.fibre");
    const model_array *fraction = model_find(m, "element.fraction");
    if (!node || !position || !volume || !model_need(m, "volume.name", e) || !model_need(m, "volume.material", e))
        return -1;
    if (node->columns != 8)
        return err_set(e, NULL, 0,
                       "the model's elements have %d nodes; expected hexahedra, as voxelise makes them (msds-run "
                       "moves tetrahedra)",
                       node->columns);
    if (node->rows < 1 || node->rows > INT32_MAX / 8 - 1)
        return err_set(e, NULL, 0, "the model has %lld elements; expected 1 to %d", (long long)node->rows,
                       INT32_MAX / 8 - 1);
    p->nodes = position->rows;
    p->elements = node->rows;
    p->position = position->f64;
    p->element_node = node->i32;
    p->element_volume = volume->i32;
    p->fibre = fibre ? fibre->f32 : NULL;
    p->fraction = fraction ? fraction->f32 : NULL;
    return borrow_mixes(p, m, e);
}

/* An element without mass has no step that is stable. */
static int check_fractions(const tled_problem *p, err *e)
{
    for (int64_t i = 0; p->fraction && i < p->elements; i++)
        if (!(p->fraction[i] > 0))
            return err_set(e, NULL, 0, "element.fraction of element %lld is %g; expected above 0, and at most 1",
                           (long long)i, (double)p->fraction[i]);
    return 0;
}

static int check_mixes(const tled_problem *p, err *e)
{
    for (int64_t i = 0; p->mix && i < p->elements; i++)
        if (p->mix[i] == p->element_volume[i])
            return err_set(e, NULL, 0,
                           "element.mix of element %lld repeats the volume of the element; expected another, or -1",
                           (long long)i);
    return 0;
}

/* Elements that have values of their own go the way of mixed ones. */
static int join_own(tled_problem *p, const model *m, err *e)
{
    const material_elements own = material_elements_of(m);
    if (!own.any)
        return 0;
    p->own_mix = mem_array(p->elements, sizeof *p->own_mix, "the mixed elements", e);
    p->own_mixture = p->own_mix ? mem_array(p->elements, sizeof *p->own_mixture, "the mixed elements", e) : NULL;
    for (int64_t i = 0; p->own_mixture && i < p->elements; i++) {
        const int32_t mix = tled_mix(p, i);
        p->own_mix[i] = mix < 0 && material_elements_has(&own, i) ? p->element_volume[i] : mix;
        p->own_mixture[i] = mix < 0 ? 0 : p->mixture[i];
    }
    p->mix = p->own_mix;
    p->mixture = p->own_mixture;
    return p->own_mixture ? 0 : -1;
}

static int64_t find_curve(const script *s, script_verb verb, int32_t volume)
{
    for (int64_t i = 0; i < s->curves; i++)
        if (s->curve[i].verb == verb && s->curve[i].volume == volume)
            return i;
    return -1;
}

/* Of the matrix of step.h, and of the hourglass modes. */
static double square_at_rest(const tled_problem *p, const tled_volume *v)
{
    const element_tensor rest = {0};
    const element_fibre none = {0};
    step_matrix a;
    stability_matrix(p->form, v->law.c, v->law.density, p->side, rest, none, none, &a);
    return fmax(stability_largest(&a), v->law.twists);
}

static const char *law_of_volume(const model *m, int64_t i)
{
    return model_find(m, "material.law")->str[model_find(m, "volume.material")->i32[i]];
}

/* The coefficients of a volume in a form; false: it does not express the volume's law. */
static bool express(const material *of, form f, double c[FORM_NUMBERS])
{
    double own[FORM_NUMBERS] = {0};
    material_coefficients(of, own);
    return form_express(material_form(of), f, own, c);
}

/* How many volumes, from the first on, a form expresses. */
static int32_t expressed(const material *of, int32_t volumes, form f)
{
    double c[FORM_NUMBERS];
    int32_t i = 0;
    while (i < volumes && express(&of[i], f, c))
        i++;
    return i;
}

/* "NAME or NAME": the laws of which steppers have the form. */
static void words_of_laws(char *to, size_t size)
{
    to[0] = '\0';
    for (int i = 0; law_at(i); i++)
        if (law_at(i)->form < FORM_STEPPED) {
            const size_t at = strlen(to);
            snprintf(to + at, size - at, "%s%s", at ? " or " : "", law_at(i)->name);
        }
}

/* The first form that expresses all volumes. of: of each volume. */
static int choose_form(tled_problem *p, const model *m, const material *of, err *e)
{
    char words[200];
    int32_t most = 0;
    for (int f = 0; f < FORM_STEPPED; f++) {
        const int32_t count = expressed(of, p->volumes, (form)f);
        if (count > most || f == 0) {
            most = count;
            p->form = (form)f;
        }
    }
    if (most == p->volumes)
        return 0;
    words_of_laws(words, sizeof words);
    return err_set(e, NULL, 0, "volume '%s' has the law '%s'; expected %s, here or by -m MATERIAL.law=",
                   model_find(m, "volume.name")->str[most], law_of_volume(m, most), words);
}

/* What holds the hourglass modes of a box of that law. A corner has an eighth of the mass, and the squares of a mode's
 * signs are 8: so their frequencies are those of 64/(rho V) times the stiffness by modes. */
static void hold_modes(const tled_problem *p, tled_law *law)
{
    const double *side = p->side;
    hourglass_numbers(p->control, law->mu, law->bulk, side, law->hourglass);
    law->twists =
        64 * hourglass_stiffest(p->control.kind, law->hourglass, side) / (law->density * side[0] * side[1] * side[2]);
}

static tled_law law_of(const tled_problem *p, const material *of)
{
    tled_law law = {.mu = material_mu(of), .bulk = material_bulk(of), .density = of->density};
    express(of, p->form, law.c);
    hold_modes(p, &law);
    return law;
}

static const char *material_of_volume(const model *m, int64_t i)
{
    return model_find(m, "material.name")->str[model_find(m, "volume.material")->i32[i]];
}

/* The curves of a volume's muscle. */
static int make_muscle(tled_volume *v, const model *m, int32_t i, const material *of, err *e)
{
    v->peak = of->peak;
    v->optimum = of->optimum;
    if (v->contract >= 0 && !(v->peak > 0))
        return err_set(e, NULL, 0,
                       "volume '%s' is to contract, but its material '%s' has no peak stress; expected peak=PASCAL",
                       v->name, material_of_volume(m, i));
    if (of->passive > 0 && !(v->peak > 0))
        return err_set(e, NULL, 0,
                       "material '%s' has passive=%g, a share of the peak stress, but no peak stress; expected "
                       "peak=PASCAL",
                       material_of_volume(m, i), of->passive);
    if (of->vmax > 0 && !(v->peak > 0))
        return err_set(e, NULL, 0,
                       "material '%s' has vmax=%g, the velocity of its muscles, but no peak stress; expected "
                       "peak=PASCAL",
                       material_of_volume(m, i), of->vmax);
    v->curved = material_muscle(of, v->muscle);
    v->serial = v->muscle[MUSCLE_SPRING] > 0;
    return 0;
}

static int make_volume(tled_problem *p, const model *m, int32_t i, const material *of, err *e)
{
    tled_volume *v = &p->volume[i];
    v->name = model_find(m, "volume.name")->str[i];
    v->row = of->law;
    v->law = law_of(p, of);
    v->square = square_at_rest(p, v);
    v->contract = find_curve(p->script, SCRIPT_CONTRACT, i);
    return make_muscle(v, m, i, of, e);
}

static int make_volumes(tled_problem *p, const model *m, const material *of, err *e)
{
    p->volumes = (int32_t)model_find(m, "volume.name")->rows;
    p->volume = mem_array(p->volumes, sizeof *p->volume, "the volumes", e);
    if (!p->volume || choose_form(p, m, of, e) || fibres_make(&p->fibres, m, of, e))
        return -1;
    for (int32_t i = 0; i < p->volumes; i++)
        if (make_volume(p, m, i, &of[i], e))
            return -1;
    for (int32_t i = 0; i < p->volumes; i++) {
        p->curved |= p->volume[i].curved;
        p->serial |= p->fibre && p->volume[i].serial;
    }
    for (int64_t i = 0; i < p->elements; i++)
        p->volume[p->element_volume[i]].elements++;
    return 0;
}

/* s: the share of w. */
static tled_law mix_laws(const tled_problem *p, const tled_law *v, const tled_law *w, double s)
{
    tled_law law = {.mu = material_between(v->mu, w->mu, s),
                    .bulk = material_between(v->bulk, w->bulk, s),
                    .density = (1 - s) * v->density + s * w->density};
    form_between(p->form, law.mu, law.bulk, v->c, w->c, s, law.c);
    hold_modes(p, &law);
    return law;
}

/* Of an element that is mixed, or has values of its own. */
static tled_law own_law(const tled_problem *p, int64_t i, const material *of, const material_elements *own)
{
    const int32_t volume = p->element_volume[i], mix = tled_mix(p, i);
    material first = of[volume];
    material_elements_put(own, i, &first);
    const tled_law law = material_elements_has(own, i) ? law_of(p, &first) : p->volume[volume].law;
    return mix < 0 || mix == volume ? law : mix_laws(p, &law, &p->volume[mix].law, tled_mixture(p, i));
}

/* The laws of what is mixed, and of what has values of its own. */
static int make_mixtures(tled_problem *p, const model *m, const material *of, err *e)
{
    const material_elements own = material_elements_of(m);
    p->own_values = own.any;
    if (!p->mix && !own.any)
        return 0;
    p->mixed = mem_array(p->elements, sizeof *p->mixed, "the mixed elements", e);
    for (int64_t i = 0; p->mixed && i < p->elements; i++)
        p->mixed[i] = tled_mix(p, i) < 0 && !material_elements_has(&own, i) ? -1 : (int32_t)p->laws++;
    p->law = p->mixed ? mem_array(p->laws, sizeof *p->law, "the mixed elements", e) : NULL;
    for (int64_t i = 0; p->law && i < p->elements; i++)
        if (p->mixed[i] >= 0)
            p->law[p->mixed[i]] = own_law(p, i, of, &own);
    return p->law ? 0 : -1;
}

static int make_laws(tled_problem *p, const model *m, err *e)
{
    material *of = materials_of_volumes(m, e);
    const int status = !of || make_volumes(p, m, of, e) || make_mixtures(p, m, of, e) ? -1 : 0;
    free(of);
    return status;
}

enum { CHUNK = 1 << 14 }; /* nodes */

typedef struct holding {
    tled_problem *p;
    const uint8_t *rigid; /* nodes, or NULL */
    int64_t held;
} holding;

static void hold_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const holding *h = context;
    (void)chunk;
    for (int64_t n = from; n < to; n++)
        for (int a = 0; a < 3; a++)
            h->p->hold[3 * n + a] = h->rigid && h->rigid[n] ? HOLD_STILL : HOLD_FREE;
}

static void count_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    holding *h = context;
    int64_t held = 0;
    (void)chunk;
    for (const int32_t *of = h->p->hold + 3 * from; of < h->p->hold + 3 * to; of += 3)
        held += of[0] != HOLD_FREE || of[1] != HOLD_FREE || of[2] != HOLD_FREE;
    __atomic_fetch_add(&h->held, held, __ATOMIC_RELAXED);
}

/* Rigid nodes stay where they are, but for components that the script displaces. */
static void make_holds(tled_problem *p, const model *m)
{
    const model_array *rigid = model_find(m, "node.rigid");
    holding h = {p, rigid ? rigid->u8 : NULL, 0};
    for (int64_t i = 0; i < films_count(p) * 3; i++)
        p->hold[3 * p->nodes + i] = HOLD_STILL;
    pool_run(p->threads, p->nodes, CHUNK, hold_work, &h);
    for (int64_t c = 0; c < p->script->curves; c++) {
        const script_curve *curve = &p->script->curve[c];
        const bool prescribes = curve->verb == SCRIPT_DISPLACE || curve->verb == SCRIPT_MOVE;
        const int32_t hold = (int32_t)c | (curve->verb == SCRIPT_MOVE ? MOVES_BODY : 0);
        for (int32_t i = 0; prescribes && i < curve->node_count; i++)
            for (int a = 0; a < 3; a++)
                if (curve->mask & 1u << a)
                    p->hold[3 * (int64_t)p->script->node[curve->node_first + i] + a] = hold;
    }
    pool_run(p->threads, p->nodes, CHUNK, count_work, &h);
    p->held = h.held;
}

static void find_slides(tled_problem *p, const model *m)
{
    const model_array *node = model_find(m, "slide.node"), *lifts = model_find(m, "slide.lifts");
    p->slide = node ? node->i32 : NULL;
    p->slides = node ? node->rows : 0;
    p->slide_lifts = lifts ? lifts->u8 : NULL;
}

int tled_problem_make(tled_problem *p, const model *m, const script *s, hourglass_control control, err *e)
{
    lattice l;
    const bool boxes = model_meta_of(m, "lattice.spacing") || model_find(m, "element.lattice");
    p->script = s;
    p->control = control;
    p->gravity = find_curve(s, SCRIPT_GRAVITY, -1);
    if (borrow_mesh(p, m, e) || (boxes ? lattice_of(m, &l, e) : conforming_create(p, e)))
        return -1;
    if (boxes)
        memcpy(p->side, l.spacing, sizeof p->side);
    p->corner = mem_array(boxes ? p->nodes : p->elements, 8 * sizeof *p->corner, "the nodes", e);
    p->mass = mem_array(p->nodes, sizeof *p->mass, "the nodes", e);
    if (!p->corner || !p->mass)
        return -1;
    if ((boxes && boxes_check(p, e)) || check_fractions(p, e) || check_mixes(p, e) || (boxes && join_own(p, m, e)) ||
        cut_borrow(p, m, e) || border_borrow(p, m, e) || films_share(p, m, e) || make_laws(p, m, e) ||
        make_fields(p, e) || (boxes ? boxes_corners(p, e) : conforming_corners(p, e)) || cut_weigh(p, e) ||
        films_make(p, e) || loads_make(p, m, e) || followers_make(p, m, e) || bodies_make(p, m, e))
        return -1;
    p->hold = mem_array(p->nodes + films_count(p), 3 * sizeof *p->hold, "the nodes", e);
    if (!p->hold)
        return -1;
    if (!boxes)
        conforming_join(p);
    make_holds(p, m);
    find_slides(p, m);
    return 0;
}

int tled_problem_reload(tled_problem *p, const model *m, err *e)
{
    p->gravity = find_curve(p->script, SCRIPT_GRAVITY, -1);
    for (int32_t i = 0; i < p->volumes; i++)
        p->volume[i].contract = find_curve(p->script, SCRIPT_CONTRACT, i);
    make_holds(p, m);
    forget_loads(p);
    return loads_make(p, m, e) || followers_make(p, m, e) ? -1 : 0;
}

static int start_field(tled_problem *p, int i, const frame *f, notes *warnings, err *e)
{
    const field *row = &p->fields.field[i];
    const double *found = fields_find(&p->fields, i, f);
    if (found)
        memcpy(p->at_start.of[i], found, (size_t)fields_size(&p->fields, i) * sizeof *found);
    else if (row->without)
        notes_add(warnings, "frame %lld has no %s: the run begins with %s", (long long)f->index, row->name,
                  row->without);
    else
        return err_set(e, NULL, 0, "frame %lld has no %s, so the run cannot go on from it", (long long)f->index,
                       row->name);
    return 0;
}

int tled_problem_start(tled_problem *p, const frame *f, notes *warnings, err *e)
{
    if (!isfinite(f->time))
        return err_set(e, NULL, 0, "frame %lld has no time, so the run cannot go on from it", (long long)f->index);
    for (int i = 0; i < p->fields.count; i++)
        if (start_field(p, i, f, warnings, e))
            return -1;
    for (int i = TLED_CONTRACTILE; i < p->fields.count; i++)
        if (!fields_find(&p->fields, i, f) && muscle_fibre_rest(p, i, f->time, e))
            return -1;
    for (int64_t i = 0; i < 3 * p->nodes; i++)
        if (p->hold[i] == HOLD_STILL)
            p->at_start.of[TLED_VELOCITY][i] = 0;
    p->start = f->time;
    return 0;
}

double tled_activation(const tled_problem *p, int32_t volume, const double *value)
{
    const int64_t contract = p->volume[volume].contract;
    return contract < 0 ? 0 : value[3 * contract];
}

double tled_tension(const tled_problem *p, int32_t volume, const double *value)
{
    const tled_volume *v = &p->volume[volume];
    return v->peak * tled_activation(p, volume, value) / v->optimum;
}

void tled_curves(const tled_problem *p, double time, double *value)
{
    script_values(p->script, time, value);
}

void tled_external(const tled_problem *p, const double *value, const double *u, int64_t n, double *force)
{
    for (int a = 0; a < 3; a++) {
        force[a] = p->gravity < 0 ? 0 : tled_weight(p, n) * value[3 * p->gravity + a];
        for (int32_t i = p->force_start[n]; i < p->force_start[n + 1]; i++)
            force[a] += loads_entry(p, i, value, a, u[a]);
    }
}
