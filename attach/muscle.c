#include "muscle.h"

#include "base/mem.h"
#include "cli/listing.h"
#include "fibre_rule.h"
#include "mesh/lattice.h"
#include "muscle_body.h"
#include "muscle_surface.h"
#include "place/principal.h"

#include <float.h>
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

/* The part that the muscle has at each of its nodes. */
static void find_held(const body *b, const muscle *m, int32_t index)
{
    for (int64_t at = b->start[m->volume]; at < b->start[m->volume + 1]; at++) {
        float part = fmaxf((float)body_part(b, b->element[at], m->volume), FLT_EPSILON);
        for (int n = 0; n < b->columns; n++) {
            int32_t node = b->node[b->columns * b->element[at] + n];
            b->held[node] = b->seen[node] == index ? fmaxf(b->held[node], part) : part;
            b->seen[node] = index;
        }
    }
}

/* The mean of the muscle's rigid nodes, each counted once, by its part, and that of its elements' centres. */
static void find_centres(const body *b, muscle *m, int32_t index)
{
    double rigid[3] = {0}, middle[3] = {0}, centre[3], held = 0;
    const int32_t counted = -2 - index;
    find_held(b, m, index);
    m->elements = b->start[m->volume + 1] - b->start[m->volume];
    for (int64_t at = b->start[m->volume]; at < b->start[m->volume + 1]; at++) {
        int64_t i = b->element[at];
        double share = body_share(b, i, m->volume);
        body_centre(b, i, centre);
        m->weight += share;
        for (int a = 0; a < 3; a++)
            middle[a] += share * centre[a];
        for (int n = 0; n < b->columns; n++) {
            int32_t node = b->node[b->columns * i + n];
            if (!b->rigid[node] || b->seen[node] == counted)
                continue;
            b->seen[node] = counted;
            m->rigid_nodes++;
            held += (double)b->held[node];
            for (int a = 0; a < 3; a++)
                rigid[a] += (double)b->held[node] * b->position[3 * (int64_t)node + a];
        }
    }
    for (int a = 0; a < 3; a++) {
        m->middle[a] = m->weight > 0 ? middle[a] / m->weight : NAN;
        m->centre[a] = held > 0 ? rigid[a] / held : NAN;
    }
}

static void covariance(const body *b, const muscle *m, double c[3][3])
{
    double d[3];
    for (int64_t at = b->start[m->volume]; at < b->start[m->volume + 1]; at++) {
        double share = body_share(b, b->element[at], m->volume) / m->weight;
        body_centre(b, b->element[at], d);
        for (int p = 0; p < 3; p++)
            d[p] -= m->middle[p];
        for (int p = 0; p < 3; p++)
            for (int q = 0; q < 3; q++)
                c[p][q] += share * d[p] * d[q];
    }
}

/* The axis along which the elements' centres spread most: the eigenvector of the largest eigenvalue of their
 * covariance. Where two axes are equally long there is none: 0 0 0. Returns the spread along it (m). */
static double longest_axis(const body *b, const muscle *m, double *axis)
{
    double c[3][3] = {{0}}, v[3][3];
    covariance(b, m, c);
    principal_axes(c, v);
    const int first = principal_largest(c);
    double next = fmax(c[(first + 1) % 3][(first + 1) % 3], c[(first + 2) % 3][(first + 2) % 3]);
    bool longest = c[first][first] - next > 1e-6 * c[first][first];
    for (int a = 0; a < 3; a++)
        axis[a] = longest ? v[a][first] : 0;
    return longest ? sqrt(c[first][first]) : 0;
}

/* The axis points to the contraction centre; where that does not tell, its largest component is positive. */
static void find_axis(const body *b, muscle *m)
{
    double spread = longest_axis(b, m, m->axis), toward = 0;
    int largest = 0;
    for (int a = 0; a < 3; a++) {
        toward += m->axis[a] * (m->centre[a] - m->middle[a]);
        if (fabs(m->axis[a]) > fabs(m->axis[largest]) + 1e-9)
            largest = a;
    }
    if (!(fabs(toward) > 1e-9 * spread)) /* also where there is no centre: nan */
        toward = m->axis[largest];
    if (toward < 0)
        for (int a = 0; a < 3; a++)
            m->axis[a] = -m->axis[a];
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

static int check_mixes(const body *b, const model_array *mix, err *e)
{
    for (int64_t i = 0; mix && i < mix->rows; i++)
        if (mix->i32[i] == b->volume[i])
            return err_set(e, NULL, 0,
                           "element.mix, row %lld repeats the volume of the element; expected another, or -1",
                           (long long)i);
    return 0;
}

/* The second volumes of elements, where the model has any. */
static int find_mixes(const model *m, body *b, err *e)
{
    const model_array *mix = model_find(m, "element.mix");
    const model_array *mixture = mix ? model_need(m, "element.mixture", e) : NULL;
    if ((mix && !mixture) || check_mixes(b, mix, e))
        return -1;
    b->mix = mix ? mix->i32 : NULL;
    b->mixture = mixture ? mixture->f32 : NULL;
    return 0;
}

/* The arrays that are needed, and node and element counts. */
static int find_arrays(const model *m, body *b, err *e)
{
    const model_array *position = model_need(m, "node.position", e), *rigid = model_need(m, "node.rigid", e);
    const model_array *node = model_need(m, "element.node", e), *volume = model_need(m, "element.volume", e);
    const model_array *anchor = model_find(m, "node.anchor"), *fraction = model_find(m, "element.fraction");
    if (!position || !rigid || !node || !volume)
        return -1;
    *b = (body){.elements = node->rows,
                .nodes = position->rows,
                .columns = node->columns,
                .position = position->f64,
                .node = node->i32,
                .volume = volume->i32,
                .rigid = rigid->u8,
                .anchor = anchor ? anchor->i32 : NULL,
                .fraction = fraction ? fraction->f32 : NULL};
    b->seen = mem_array(b->nodes, sizeof *b->seen, "nodes", e);
    b->held = b->seen ? mem_array(b->nodes, sizeof *b->held, "nodes", e) : NULL;
    b->part = b->held ? mem_array(b->nodes, sizeof *b->part, "nodes", e) : NULL;
    for (int64_t n = 0; b->part && n < b->nodes; n++)
        b->seen[n] = b->part[n] = -1;
    return b->part ? find_mixes(m, b, e) : -1;
}

/* The elements of each volume, in their order, then those that it is the second in. */
static int sort_elements(body *b, int64_t volumes, err *e)
{
    /* Counted two places up, so that filling leaves each volume's first in its place. */
    b->start = mem_array(volumes + 2, sizeof *b->start, "volumes", e);
    int64_t entries = b->elements;
    for (int64_t i = 0; b->mix && i < b->elements; i++)
        entries += b->mix[i] >= 0;
    b->element = b->start ? mem_array(entries, sizeof *b->element, "elements", e) : NULL;
    if (!b->element)
        return -1;
    for (int64_t i = 0; i < b->elements; i++) {
        b->start[b->volume[i] + 2]++;
        if (b->mix && b->mix[i] >= 0)
            b->start[b->mix[i] + 2]++;
    }
    for (int64_t v = 0; v < volumes; v++)
        b->start[v + 2] += b->start[v + 1];
    for (int64_t i = 0; i < b->elements; i++)
        b->element[b->start[b->volume[i] + 1]++] = i;
    for (int64_t i = 0; b->mix && i < b->elements; i++)
        if (b->mix[i] >= 0)
            b->element[b->start[b->mix[i] + 1]++] = i;
    return 0;
}

/* The volumes that are muscles. */
static int find_muscles(const model *m, muscles *list, err *e)
{
    const model_array *is = model_need(m, "volume.muscle", e), *name = model_need(m, "volume.name", e);
    if (!is || !name)
        return -1;
    for (int64_t i = 0; i < is->rows; i++)
        list->count += is->u8[i] != 0;
    list->of = mem_array(list->count, sizeof *list->of, "muscles", e);
    if (!list->of)
        return -1;
    muscle *next = list->of;
    for (int64_t i = 0; i < is->rows; i++)
        if (is->u8[i])
            *next++ = (muscle){.name = name->str[i], .volume = (int32_t)i};
    return 0;
}

/* The axis attachment and its arrays. */
static int add_attachments(model *m, const attachments *list, err *e)
{
    if (model_axis_add(m, "attachment", list->count, e))
        return -1;
    model_array *a = model_add(m, "attachment.muscle", e);
    for (int64_t i = 0; a && i < list->count; i++)
        a->i32[i] = list->of[i].muscle;
    a = a && model_count(m, "anchor") >= 0 ? model_add(m, "attachment.anchor", e) : a;
    for (int64_t i = 0; a && model_count(m, "anchor") >= 0 && i < list->count; i++)
        a->i32[i] = list->of[i].anchor;
    a = a ? model_add(m, "attachment.nodes", e) : NULL;
    for (int64_t i = 0; a && i < list->count; i++)
        a->i32[i] = (int32_t)list->of[i].nodes;
    a = a ? model_add(m, "attachment.centre", e) : NULL;
    for (int64_t i = 0; a && i < list->count; i++)
        memcpy(&a->f64[3 * i], list->of[i].centre, sizeof list->of[i].centre);
    return a ? 0 : -1;
}

/* Adds the arrays; what they are made from stays where it is. */
static int add_arrays(model *m, body *b, const muscles *list, err *e)
{
    if (model_axis_add(m, "muscle", list->count, e))
        return -1;
    model_array *a = model_add(m, "muscle.volume", e);
    for (int64_t i = 0; a && i < list->count; i++)
        a->i32[i] = list->of[i].volume;
    a = a ? model_add(m, "muscle.centre", e) : NULL;
    for (int64_t i = 0; a && i < list->count; i++)
        memcpy(&a->f64[3 * i], list->of[i].centre, sizeof list->of[i].centre);
    if (!a || add_attachments(m, &list->attached, e))
        return -1;
    a = model_add(m, "element.fibre", e);
    b->fibre = a ? a->f32 : NULL;
    a = a && b->mix ? model_add(m, "element.mixfibre", e) : a;
    b->mixfibre = a && b->mix ? a->f32 : NULL;
    return a ? 0 : -1;
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

int muscle_make(model *m, const opt_list *asked, pool *threads, muscles *list, notes *warnings, err *e)
{
    body b = {0};
    int rc = -1;
    *list = (muscles){0};
    model_axis_drop(m, "muscle", warnings);
    model_axis_drop(m, "attachment", warnings);
    model_remove(m, "element.fibre");
    model_remove(m, "element.mixfibre");
    if (find_arrays(m, &b, e) || find_muscles(m, list, e) || sort_elements(&b, model_count(m, "volume"), e) ||
        fibre_rules_asked(list, asked, e))
        goto out;
    for (int64_t i = 0; i < list->count; i++) {
        find_centres(&b, &list->of[i], (int32_t)i);
        find_axis(&b, &list->of[i]);
        if (attachments_find(&list->attached, &b, (int32_t)i, list->of[i].volume, e))
            goto out;
    }
    if (add_arrays(m, &b, list, e) || follow_rules(m, &b, list, threads, e) ||
        (!fibre_rules_single(asked) && add_rules(m, list, e)))
        goto out;
    warn_of_all(list, warnings);
    rc = 0;
out:
    free(b.seen);
    free(b.held);
    free(b.part);
    free(b.start);
    free(b.element);
    return rc;
}

void muscles_free(muscles *list)
{
    free(list->of);
    free(list->attached.of);
    *list = (muscles){0};
}
