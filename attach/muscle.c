#include "muscle.h"

#include "base/mem.h"
#include "fibre_rule.h"
#include "mesh/lattice.h"
#include "muscle_body.h"
#include "place/principal.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* The elements of each muscle's volume, in their order, then those that it is the second in. */
static int sort_elements(body *b, const model_array *is_muscle, err *e)
{
    const int64_t volumes = is_muscle->rows;
    int64_t entries = 0;
    /* Counted two places up, so that filling leaves each volume's first in its place. */
    b->start = mem_array(volumes + 2, sizeof *b->start, "volumes", e);
    if (!b->start)
        return -1;
    for (int64_t i = 0; i < b->elements; i++) {
        const int32_t volume = b->volume[i], second = b->mix ? b->mix[i] : -1;
        b->start[volume + 2] += is_muscle->u8[volume];
        if (second >= 0)
            b->start[second + 2] += is_muscle->u8[second];
    }
    for (int64_t v = 0; v < volumes; v++) {
        entries += b->start[v + 2];
        b->start[v + 2] += b->start[v + 1];
    }
    b->element = mem_array(entries, sizeof *b->element, "elements", e);
    if (!b->element)
        return -1;
    for (int64_t i = 0; i < b->elements; i++)
        if (is_muscle->u8[b->volume[i]])
            b->element[b->start[b->volume[i] + 1]++] = i;
    for (int64_t i = 0; b->mix && i < b->elements; i++)
        if (b->mix[i] >= 0 && is_muscle->u8[b->mix[i]])
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

static void body_free(body *b)
{
    if (!b)
        return;
    free(b->seen);
    free(b->held);
    free(b->part);
    free(b->start);
    free(b->element);
    free(b);
}

int muscle_find(model *m, const opt_list *asked, muscles *list, notes *warnings, err *e)
{
    body *b = mem_array(1, sizeof *b, "muscles", e);
    *list = (muscles){.body = b};
    model_axis_drop(m, "muscle", warnings);
    model_axis_drop(m, "attachment", warnings);
    model_remove(m, "element.fibre");
    model_remove(m, "element.mixfibre");
    if (!b || find_arrays(m, b, e) || find_muscles(m, list, e) || sort_elements(b, model_find(m, "volume.muscle"), e) ||
        fibre_rules_asked(list, asked, e))
        return -1;
    for (int64_t i = 0; i < list->count; i++) {
        find_centres(b, &list->of[i], (int32_t)i);
        find_axis(b, &list->of[i]);
        if (attachments_find(&list->attached, b, (int32_t)i, list->of[i].volume, e))
            return -1;
    }
    return add_arrays(m, b, list, e);
}

void muscles_free(muscles *list)
{
    body_free(list->body);
    free(list->of);
    free(list->attached.of);
    *list = (muscles){0};
}
