#include "muscle.h"

#include "base/mem.h"
#include "cli/listing.h"
#include "fibre_field.h"
#include "mesh/lattice.h"
#include "muscle_body.h"

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

/* One Jacobi rotation: makes c[p][q] zero, and turns the columns of v along. */
static void rotate(double c[3][3], double v[3][3], int p, int q)
{
    if (c[p][q] == 0)
        return;
    double theta = (c[q][q] - c[p][p]) / (2 * c[p][q]);
    double t = copysign(1, theta) / (fabs(theta) + sqrt(theta * theta + 1));
    double cosine = 1 / sqrt(t * t + 1), sine = t * cosine;
    for (int k = 0; k < 3; k++) {
        double cp = c[k][p], cq = c[k][q], vp = v[k][p], vq = v[k][q];
        c[k][p] = cosine * cp - sine * cq;
        c[k][q] = sine * cp + cosine * cq;
        v[k][p] = cosine * vp - sine * vq;
        v[k][q] = sine * vp + cosine * vq;
    }
    for (int k = 0; k < 3; k++) {
        double cp = c[p][k], cq = c[q][k];
        c[p][k] = cosine * cp - sine * cq;
        c[q][k] = sine * cp + cosine * cq;
    }
}

/* The axis along which the elements' centres spread most: the eigenvector of the largest eigenvalue of their
 * covariance. Where two axes are equally long there is none: 0 0 0. Returns the spread along it (m). */
static double longest_axis(const body *b, const muscle *m, double *axis)
{
    double c[3][3] = {{0}}, v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    covariance(b, m, c);
    for (int sweep = 0; sweep < 20; sweep++) { /* converges in 4 or 5 */
        rotate(c, v, 0, 1);
        rotate(c, v, 0, 2);
        rotate(c, v, 1, 2);
    }
    int first = 0;
    for (int a = 1; a < 3; a++)
        if (c[a][a] > c[first][first])
            first = a;
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
static rule set_fibre(const body *b, const muscle *m, muscle_fibre kind, int64_t element)
{
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
    if (kind == MUSCLE_FIELD && (fibre[0] != 0 || fibre[1] != 0 || fibre[2] != 0))
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

static lack lack_of(const muscle *m, muscle_fibre kind)
{
    if (!m->elements)
        return NO_ELEMENT;
    if (m->still == m->elements)
        return NO_FREE_NODE;
    if (!m->rigid_nodes && kind == MUSCLE_CENTRE)
        return NO_RIGID_NODE;
    return m->without ? NO_AXIS : NOTHING;
}

/* One muscle: its own sentence. */
static void warn_of_one(const muscle *m, muscle_fibre kind, notes *warnings)
{
    switch (lack_of(m, kind)) {
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
                  kind == MUSCLE_FIELD ? "smaller voxels give it a shape" : "--fibre field needs no axis");
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
              what == NO_AXIS && kind == MUSCLE_FIELD ? "smaller voxels give them a shape" : remedy[what]);
}

/* One line for each thing that muscles lack. */
static void warn_of_all(const muscles *list, notes *warnings)
{
    for (lack what = NO_ELEMENT; what < LACKS; what++) {
        listing names = {0};
        const muscle *last = NULL;
        for (int64_t i = 0; i < list->count; i++)
            if (lack_of(&list->of[i], list->kind) == what) {
                last = &list->of[i];
                listing_add(&names, "%s", last->name);
            }
        if (names.count == 1)
            warn_of_one(last, list->kind, warnings);
        else if (names.count)
            warn_of_many(what, &names, list->kind, warnings);
    }
}

static void set_fibres(const body *b, muscle *m, muscle_fibre kind)
{
    for (int64_t at = b->start[m->volume]; at < b->start[m->volume + 1]; at++) {
        const rule by = set_fibre(b, m, kind, b->element[at]);
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

/* --fibre field: each muscle's attachments are found again, since b->part holds one muscle's. */
static int follow_fields(const model *m, const body *b, const muscles *list, pool *threads, err *e)
{
    lattice grid;
    attachments own = {0};
    field *f = lattice_of(m, &grid, e) ? NULL : field_create(b, threads, grid.spacing, e);
    int rc = f ? 0 : -1;
    for (int64_t i = 0; !rc && i < list->count; i++) {
        const muscle *of = &list->of[i];
        own.count = 0;
        if (of->elements)
            rc = attachments_find(&own, b, (int32_t)i, of->volume, e) ||
                 field_fibres(f, of->volume, own.of, own.count, e);
    }
    free(own.of);
    field_free(f);
    return rc ? -1 : 0;
}

int muscle_make(model *m, muscle_fibre fibre, pool *threads, muscles *list, notes *warnings, err *e)
{
    body b = {0};
    int rc = -1;
    *list = (muscles){.kind = fibre};
    model_axis_drop(m, "muscle", warnings);
    model_axis_drop(m, "attachment", warnings);
    model_remove(m, "element.fibre");
    model_remove(m, "element.mixfibre");
    if (find_arrays(m, &b, e) || find_muscles(m, list, e) || sort_elements(&b, model_count(m, "volume"), e))
        goto out;
    for (int64_t i = 0; i < list->count; i++) {
        find_centres(&b, &list->of[i], (int32_t)i);
        find_axis(&b, &list->of[i]);
        if (attachments_find(&list->attached, &b, (int32_t)i, list->of[i].volume, e))
            goto out;
    }
    if (add_arrays(m, &b, list, e) || (fibre == MUSCLE_FIELD && follow_fields(m, &b, list, threads, e)))
        goto out;
    for (int64_t i = 0; i < list->count; i++)
        set_fibres(&b, &list->of[i], fibre);
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
