#include "muscle_fibres.h"

#include "base/mem.h"
#include "cli/listing.h"
#include "fibre_rule.h"
#include "muscle_surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A length to compare others with. */
static double element_size(const body *b, int64_t element)
{
    const double *x = &b->position[3 * (int64_t)b->node[b->columns * element]];
    const double *y = &b->position[3 * (int64_t)b->node[b->columns * element + b->columns - 1]];
    return sqrt((x[0] - y[0]) * (x[0] - y[0]) + (x[1] - y[1]) * (x[1] - y[1]) + (x[2] - y[2]) * (x[2] - y[2]));
}

/* Which rule gave an element its fibre: the one asked for, the axis in its place, or none. */
typedef enum rule { BY_RULE, BY_AXIS, BY_NONE } rule;

/* Sets the fibre of one element. */
static rule set_fibre(const body *b, const muscle *m, int64_t element)
{
    const muscle_fibre kind = m->rule;
    double line[3], length = 0, centre[3];
    body_centre(b, element, centre);
    for (int a = 0; a < 3; a++) {
        line[a] = m->centre[a] - centre[a];
        length += line[a] * line[a];
    }
    length = sqrt(length);
    if (kind == MUSCLE_CENTRE && !m->rigid_nodes)
        return BY_NONE;
    float *fibre = body_fibre(b, element, m->volume);
    if (fibre_rules[kind].fill && (fibre[0] != 0 || fibre[1] != 0 || fibre[2] != 0))
        return BY_RULE;
    bool along_axis = kind != MUSCLE_CENTRE || length <= 1e-9 * element_size(b, element);
    for (int a = 0; a < 3; a++)
        fibre[a] = (float)(along_axis ? m->axis[a] : line[a] / length);
    if (along_axis && m->axis[0] == 0 && m->axis[1] == 0 && m->axis[2] == 0)
        return BY_NONE;
    return along_axis && kind != MUSCLE_AXIS ? BY_AXIS : BY_RULE;
}

static bool can_move(const body *b, int64_t element)
{
    for (int n = 0; n < b->columns; n++)
        if (!b->rigid[b->node[b->columns * element + n]])
            return true;
    return false;
}

/* What of a muscle will not contract, and why. */
typedef enum lack { NOTHING, NO_ELEMENT, NO_FREE_NODE, NO_RIGID_NODE, NO_AXIS, LACKS } lack;

static lack lack_of(const muscle *m)
{
    if (!m->elements)
        return NO_ELEMENT;
    if (m->still == m->elements)
        return NO_FREE_NODE;
    if (!m->rigid_nodes && m->rule == MUSCLE_CENTRE)
        return NO_RIGID_NODE;
    return m->without ? NO_AXIS : NOTHING;
}

/* One muscle: its own sentence. */
static void warn_of_one(const muscle *m, notes *warnings)
{
    switch (lack_of(m)) {
    case NO_ELEMENT:
        notes_add(warnings, "%s has no elements: it will not contract; voxelise says why", m->name);
        break;
    case NO_FREE_NODE:
        notes_add(warnings,
                  "%s has no node that is free: it will not contract; smaller voxels or a lower --strictness may leave "
                  "some free",
                  m->name);
        break;
    case NO_RIGID_NODE:
        notes_add(warnings,
                  "%s has no rigid node, so no contraction centre and no fibres: it will not contract; --fibre field "
                  "gives it fibres without one",
                  m->name);
        break;
    case NO_AXIS:
        notes_add(warnings,
                  "%s has no axis that is the longest: %lld of its %lld elements have no fibre and will not contract; "
                  "%s",
                  m->name, (long long)m->without, (long long)m->elements,
                  fibre_rules[m->rule].fill ? "smaller voxels give it a shape" : "--fibre field needs no axis");
        break;
    default:
        break;
    }
}

/* Several muscles with the same lack: one sentence for all. */
static void warn_of_many(lack what, listing *names, muscle_fibre kind, notes *warnings)
{
    static const char *const have[LACKS] = {
        [NO_ELEMENT] = "no elements, and will not contract",
        [NO_FREE_NODE] = "no node that is free, and will not contract",
        [NO_RIGID_NODE] = "no rigid node, so no contraction centre and no fibres, and will not contract",
        [NO_AXIS] = "no axis that is the longest, and elements without a fibre, which will not contract"};
    static const char *const remedy[LACKS] = {[NO_ELEMENT] = "voxelise says why",
                                              [NO_FREE_NODE] =
                                                  "smaller voxels or a lower --strictness may leave some free",
                                              [NO_RIGID_NODE] = "--fibre field gives them fibres without one",
                                              [NO_AXIS] = "--fibre field needs no axis"};
    const long long count = names->count;
    notes_add(warnings, "%lld muscles have %s: %s; %s", count, have[what], listing_text(names),
              what == NO_AXIS && fibre_rules[kind].fill ? "smaller voxels give them a shape" : remedy[what]);
}

/* One line for each thing that muscles lack. */
static void warn_of_all(const muscles *list, notes *warnings)
{
    for (lack what = NO_ELEMENT; what < LACKS; what++) {
        listing names = {0};
        const muscle *last = NULL;
        for (int64_t i = 0; i < list->count; i++)
            if (lack_of(&list->of[i]) == what) {
                last = &list->of[i];
                listing_add(&names, "%s", last->name);
            }
        if (names.count == 1)
            warn_of_one(last, warnings);
        else if (names.count)
            warn_of_many(what, &names, last->rule, warnings);
    }
}

static void set_fibres(const body *b, muscle *m)
{
    for (int64_t at = b->start[m->volume]; at < b->start[m->volume + 1]; at++) {
        const rule by = set_fibre(b, m, b->element[at]);
        m->by_axis += by == BY_AXIS;
        m->without += by == BY_NONE;
        m->still += !can_move(b, b->element[at]);
    }
}

/* ---- rules */

/* Points that a muscle consists of: the cells of its shape, or else its elements' centres. */
static int find_points(const fibre_case *c, double **place, double **weight, ring_points *p, err *e)
{
    p->count = c->shape ? muscle_shape_cells(c->shape) : c->of->elements;
    *place = mem_array(3 * p->count, sizeof **place, "a muscle", e);
    *weight = *place ? mem_array(p->count, sizeof **weight, "a muscle", e) : NULL;
    if (!*weight)
        return -1;
    for (int64_t i = 0; i < p->count; i++) {
        (*weight)[i] = 1;
        if (c->shape) {
            muscle_shape_place(c->shape, i, *place + 3 * i);
            continue;
        }
        const int64_t element = c->b->element[c->b->start[c->of->volume] + i];
        body_centre(c->b, element, *place + 3 * i);
        (*weight)[i] = body_share(c->b, element, c->of->volume);
    }
    p->place = *place;
    p->weight = *weight;
    return 0;
}

static int find_ring(fibre_case *c, muscle *of, ring *r, err *e)
{
    double *place = NULL, *weight = NULL;
    ring_points p;
    const int rc = find_points(c, &place, &weight, &p, e);
    of->is_ring = !rc && ring_find(r, &p);
    c->ring = of->is_ring ? r : NULL;
    free(place);
    free(weight);
    return rc;
}

/* Fibres that a rule has laid run toward the contraction centre, as others do; those of a ring run round. */
static void turn_fibres(const body *b, const muscle *m)
{
    double along = 0;
    for (int64_t at = b->start[m->volume]; at < b->start[m->volume + 1]; at++)
        for (int a = 0; a < 3; a++)
            along += m->axis[a] * (double)body_fibre(b, b->element[at], m->volume)[a];
    for (int64_t at = b->start[m->volume]; along < 0 && at < b->start[m->volume + 1]; at++)
        for (int a = 0; a < 3; a++) {
            float *fibre = body_fibre(b, b->element[at], m->volume) + a;
            *fibre = *fibre != 0 ? -*fibre : 0;
        }
}

/* The shape of a muscle, or NULL where it has no closed surface that encloses something. -1 with e filled. */
static int find_shape(const muscle_surfaces *surfaces, int32_t index, muscle_shape **shape, err *e)
{
    trimesh own = {0};
    int rc = muscle_surface_take(surfaces, index, &own, e);
    if (!rc && own.triangles && !(*shape = muscle_shape_create(&own, e)))
        rc = -1;
    if (*shape && !muscle_shape_cells(*shape)) {
        muscle_shape_free(*shape);
        *shape = NULL;
    }
    trimesh_free(&own);
    return rc;
}

/* Chooses the muscle's rule, and lays its fibres by it, unless they are left. */
static int follow_rule(fibre_case *c, muscle *of, const muscle_surfaces *surfaces, err *e)
{
    muscle_shape *shape = NULL;
    ring r;
    const bool looks = of->asked < 0 || of->asked == MUSCLE_ROUND || of->asked == MUSCLE_SHAPE;
    int rc = looks ? find_shape(surfaces, c->index, &shape, e) : 0;
    c->of = of;
    c->shape = shape;
    c->ring = NULL;
    if (!rc && (of->asked < 0 || of->asked == MUSCLE_ROUND))
        rc = find_ring(c, of, &r, e);
    of->rule = of->asked >= 0 ? (muscle_fibre)of->asked : fibre_rule_for(c);
    if (!rc && fibre_rules[of->rule].fill)
        rc = fibre_rules[of->rule].fill(c, e);
    muscle_shape_free(shape);
    return rc;
}

static void finish_fibres(const body *b, muscle *of)
{
    if (fibre_rules[of->rule].fill && of->rule != MUSCLE_FIELD && !of->is_ring)
        turn_fibres(b, of);
    set_fibres(b, of);
}

/* Muscles on their way; what is one muscle's, is one thread's. */
typedef struct followed {
    fibre_case common;
    muscles *list;
    const muscle_surfaces *surfaces;
    bool *left;  /* muscles */
    err *failed; /* muscles */
} followed;

static void follow_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const followed *w = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        fibre_case c = w->common;
        c.index = (int32_t)i;
        const int failed = follow_rule(&c, &w->list->of[i], w->surfaces, &w->failed[i]);
        w->left[i] = c.is_left;
        if (!failed && !c.is_left)
            finish_fibres(c.b, &w->list->of[i]);
    }
}

/* With all threads, those that are too much for one: they have neither shape nor ring. */
static int follow_left(const followed *w, pool *threads, err *e)
{
    for (int64_t i = 0; i < w->list->count; i++) {
        muscle *of = &w->list->of[i];
        fibre_case c = w->common;
        c.index = (int32_t)i;
        c.of = of;
        c.threads = threads;
        if (!w->left[i])
            continue;
        if (fibre_rules[of->rule].fill(&c, e))
            return -1;
        finish_fibres(c.b, of);
    }
    return 0;
}

/* Each muscle on a thread of its own: of most the loops are too short to be shared. */
static int follow_all(followed *w, pool *threads, err *e)
{
    int rc = 0;
    w->left = mem_array(w->list->count, sizeof *w->left, "muscles", e);
    w->failed = w->left ? mem_array(w->list->count, sizeof *w->failed, "muscles", e) : NULL;
    if (!w->failed)
        return -1;
    pool_run(threads, w->list->count, 1, follow_some, w);
    for (int64_t i = 0; !rc && i < w->list->count; i++)
        rc = err_join(e, &w->failed[i]);
    return rc ? -1 : follow_left(w, threads, e);
}

static int follow_rules(const model *m, const body *b, muscles *list, pool *threads, err *e)
{
    muscle_surfaces surfaces = {0};
    fibre_voxels voxels = {PTHREAD_MUTEX_INITIALIZER, NULL};
    followed w = {.common = {.m = m, .b = b, .voxels = &voxels}, .list = list, .surfaces = &surfaces};
    const char **name = mem_array(list->count, sizeof *name, "muscles", e);
    int rc = name ? 0 : -1;
    for (int64_t i = 0; name && i < list->count; i++)
        name[i] = list->of[i].name;
    rc = rc || muscle_surfaces_find(&surfaces, m, name, list->count, e) || follow_all(&w, threads, e) ? -1 : 0;
    field_free(voxels.of);
    muscle_surfaces_free(&surfaces);
    free(w.left);
    free(w.failed);
    free(name);
    return rc;
}

static int add_rules(model *m, const muscles *list, err *e)
{
    model_array *a = model_add(m, "muscle.fibre", e);
    for (int64_t i = 0; a && i < list->count; i++)
        if (model_set_text(a, i, fibre_rules[list->of[i].rule].name, e))
            return -1;
    return a ? 0 : -1;
}

int muscle_fibres(model *m, const opt_list *asked, pool *threads, muscles *list, notes *warnings, err *e)
{
    if (follow_rules(m, list->body, list, threads, e) || (!fibre_rules_single(asked) && add_rules(m, list, e)))
        return -1;
    warn_of_all(list, warnings);
    return 0;
}
