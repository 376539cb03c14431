#include "mesh/motion.h"

#include "base/mem.h"
#include "mesh/lattice.h"
#include "mesh/weights.h"
#include "surface/coincident.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 1024 };

/* ---- tables */

/* This is what the tables are made with. */
typedef struct making {
    motion *m;
    const bound *b;
    int64_t nodes, elements;
    int32_t *place;  /* nodes: coincident.h; -1: of no element that has an entry */
    int32_t *copies; /* places: such nodes at one place */
} making;

static const int32_t *nodes_of(const bound *b, int64_t element)
{
    return &b->node[8 * element];
}

/* Gives a place to each node of an element that a blended vertex is bound to, and an entry to each such element. */
static int find_places(making *k, err *e)
{
    motion *m = k->m;
    m->place = mem_array(k->nodes, sizeof *m->place, "the surface's nodes", e);
    m->entry = mem_array(k->elements, sizeof *m->entry, "the surface's elements", e);
    if (!m->place || !m->entry)
        return -1;
    for (int64_t v = 0; v < k->b->shape.vertices; v++)
        if (k->b->blended[v]) {
            m->entry[k->b->element[v]] = 1;
            for (int c = 0; c < 8; c++)
                m->place[nodes_of(k->b, k->b->element[v])[c]] = 1;
        }
    for (int64_t n = 0; n < k->nodes; n++)
        m->place[n] = m->place[n] ? (int32_t)m->places++ : -1;
    m->node = mem_array(m->places, sizeof *m->node, "the surface's nodes", e);
    m->start = m->node ? mem_array(m->places + 2, sizeof *m->start, "the surface's nodes", e) : NULL;
    for (int64_t n = 0; m->start && n < k->nodes; n++)
        if (m->place[n] >= 0)
            m->node[m->place[n]] = (int32_t)n;
    return m->start ? 0 : -1;
}

/* Lists the elements around each place, and gives them entries. */
static int find_around(making *k, err *e)
{
    motion *m = k->m;
    for (int64_t i = 0; i < 8 * k->elements; i++) {
        const int32_t place = m->place[k->b->node[i]];
        if (place >= 0) {
            m->start[place + 2]++;
            m->entry[i / 8] = 1;
        }
    }
    for (int64_t i = 0; i < m->places; i++)
        m->start[i + 2] += m->start[i + 1];
    for (int64_t i = 0; i < k->elements; i++)
        m->entry[i] = m->entry[i] ? (int32_t)m->entries++ : -1;
    m->around = mem_array(m->start[m->places + 1], sizeof *m->around, "the surface's elements", e);
    m->element = m->around ? mem_array(m->entries, sizeof *m->element, "the surface's elements", e) : NULL;
    for (int64_t i = 0; m->element && i < k->elements; i++)
        for (int c = 0; c < 8 && m->entry[i] >= 0; c++) {
            const int32_t place = m->place[k->b->node[8 * i + c]];
            m->element[m->entry[i]] = (int32_t)i;
            if (place >= 0)
                m->around[m->start[place + 1]++] = m->entry[i];
        }
    return m->element ? 0 : -1;
}

/* ---- slits */

/* Tells whether one of these elements has another node where the element `which` has one. */
static bool conflicts(const making *k, const int32_t *entry, int64_t count, int64_t which)
{
    const int32_t *mine = nodes_of(k->b, k->m->element[entry[which]]);
    for (int c = 0; c < 8; c++) {
        if (k->copies[k->place[mine[c]]] < 2)
            continue;
        for (int64_t i = 0; i < count; i++) {
            const int32_t *other = nodes_of(k->b, k->m->element[entry[i]]);
            for (int j = 0; j < 8; j++)
                if (other[j] != mine[c] && k->place[other[j]] == k->place[mine[c]])
                    return true;
        }
    }
    return false;
}

/* Takes the elements that conflict out of the lists. */
static int part_slits(making *k, err *e)
{
    motion *m = k->m;
    int64_t kept = 0, most = 0;
    for (int64_t i = 0; i < m->places; i++)
        most = m->start[i + 1] - m->start[i] > most ? m->start[i + 1] - m->start[i] : most;
    int32_t *list = mem_array(most, sizeof *list, "the surface's elements", e);
    if (!list)
        return -1;
    for (int64_t i = 0; i < m->places; i++) {
        const int64_t count = m->start[i + 1] - m->start[i];
        memcpy(list, m->around + m->start[i], (size_t)count * sizeof *list);
        m->start[i] = kept;
        for (int64_t j = 0; j < count; j++)
            if (!conflicts(k, list, count, j))
                m->around[kept++] = list[j];
    }
    m->start[m->places] = kept;
    free(list);
    return 0;
}

/* Numbers the nodes of the elements that have entries, which are few, and gathers where they are. Returns how many. */
static int64_t gather_nodes(making *k, double *position)
{
    int64_t count = 0;
    for (int64_t n = 0; n < k->nodes; n++)
        k->place[n] = -1;
    for (int64_t i = 0; i < 8 * k->m->entries; i++) {
        const int32_t node = nodes_of(k->b, k->m->element[i / 8])[i % 8];
        if (k->place[node] >= 0)
            continue;
        k->place[node] = (int32_t)count;
        memcpy(position + 3 * count++, k->b->rest + 3 * (int64_t)node, 3 * sizeof *position);
    }
    return count;
}

/* Only these nodes can conflict. */
static int find_copies(making *k, err *e)
{
    const int64_t most = 8 * k->m->entries < k->nodes ? 8 * k->m->entries : k->nodes;
    double *position = mem_array(3 * most, sizeof *position, "the surface's nodes", e);
    int32_t *at = position ? mem_array(most, sizeof *at, "the surface's nodes", e) : NULL;
    k->copies = at ? mem_array(most, sizeof *k->copies, "the surface's nodes", e) : NULL;
    k->place = k->copies ? mem_array(k->nodes, sizeof *k->place, "the surface's nodes", e) : NULL;
    const int64_t count = k->place ? gather_nodes(k, position) : 0;
    const int status = k->place && coincident_places(position, count, at, e) >= 0 ? 0 : -1;
    for (int64_t n = 0; n < count && !status; n++)
        k->copies[at[n]]++;
    for (int64_t n = 0; n < k->nodes && !status; n++)
        k->place[n] = k->place[n] < 0 ? -1 : at[k->place[n]];
    free(position);
    free(at);
    return status;
}

/* ---- opening */

static void find_centre(const bound *b, int32_t element, double *centre)
{
    const int32_t *node = nodes_of(b, element);
    for (int a = 0; a < 3; a++)
        centre[a] = (b->rest[3 * (int64_t)node[0] + a] + b->rest[3 * (int64_t)node[6] + a]) / 2;
}

static void find_offset(const motion *m, int64_t place)
{
    const int64_t count = m->start[place + 1] - m->start[place];
    const double *rest = m->of->rest + 3 * (int64_t)m->node[place];
    double *offset = m->offset + 3 * place, centre[3];
    for (int64_t i = m->start[place]; i < m->start[place + 1]; i++) {
        find_centre(m->of, m->element[m->around[i]], centre);
        for (int a = 0; a < 3; a++)
            offset[a] += (rest[a] - centre[a]) / (double)count;
    }
}

static bool has_blended(const bound *b)
{
    int64_t v = 0;
    while (b->blended && v < b->shape.vertices && !b->blended[v])
        v++;
    return b->blended && v < b->shape.vertices;
}

int motion_open(motion *m, const bound *b, int64_t nodes, int64_t elements, err *e)
{
    making k = {.m = m, .b = b, .nodes = nodes, .elements = elements};
    *m = (motion){.of = b};
    if (!has_blended(b))
        return 0;
    int status = find_places(&k, e) || find_around(&k, e) || find_copies(&k, e) || part_slits(&k, e) ? -1 : 0;
    free(k.place);
    free(k.copies);
    if (!status) {
        m->offset = mem_array(3 * m->places, sizeof *m->offset, "the surface's nodes", e);
        m->at_node = mem_array(m->places, sizeof *m->at_node, "the surface's nodes", e);
        m->at_element = mem_array(m->entries, sizeof *m->at_element, "the surface's elements", e);
        status = m->offset && m->at_node && m->at_element ? 0 : -1;
    }
    for (int64_t i = 0; !status && i < m->places; i++)
        find_offset(m, i);
    if (status)
        motion_free(m);
    return status;
}

void motion_free(motion *m)
{
    free(m->place);
    free(m->entry);
    free(m->node);
    free(m->start);
    free(m->around);
    free(m->element);
    free(m->offset);
    free(m->at_node);
    free(m->at_element);
    *m = (motion){0};
}

/* ---- a displacement */

/* Differences from one node are summed, so that a motion without gradient comes out to the bit. */
static void map_of_element(const motion *m, int32_t element, motion_map *map)
{
    const int32_t *node = nodes_of(m->of, element);
    const weights_box box = weights_box_of(node, m->of->rest);
    const double *first = m->u + 3 * (int64_t)node[0];
    *map = (motion_map){{0}, {0}};
    for (int c = 1; c < 8; c++) {
        const double *u = m->u + 3 * (int64_t)node[c];
        for (int i = 0; i < 3; i++) {
            const double d = u[i] - first[i];
            map->u[i] += d;
            for (int j = 0; j < 3; j++)
                map->gradient[3 * i + j] += lattice_vtk[c][j] ? d : -d;
        }
    }
    for (int i = 0; i < 3; i++) {
        map->u[i] = first[i] + map->u[i] / 8;
        for (int j = 0; j < 3; j++)
            map->gradient[3 * i + j] /= 4 * box.side[j];
    }
}

static void map_elements(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const motion *m = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        map_of_element(m, m->element[i], &m->at_element[i]);
}

static void map_of_node(const motion *m, int64_t place, motion_map *map)
{
    const int64_t from = m->start[place], to = m->start[place + 1];
    const double *offset = m->offset + 3 * place;
    *map = (motion_map){{0}, {0}};
    if (from == to)
        return;
    const motion_map *first = &m->at_element[m->around[from]];
    for (int64_t k = from; k < to; k++) {
        const motion_map *of = &m->at_element[m->around[k]];
        for (int i = 0; i < 3; i++)
            map->u[i] += of->u[i] - first->u[i];
        for (int i = 0; i < 9; i++)
            map->gradient[i] += of->gradient[i];
    }
    const double count = (double)(to - from);
    for (int i = 0; i < 9; i++)
        map->gradient[i] /= count;
    for (int i = 0; i < 3; i++) {
        const double *g = map->gradient + 3 * i;
        map->u[i] = first->u[i] + map->u[i] / count + (g[0] * offset[0] + g[1] * offset[1] + g[2] * offset[2]);
    }
}

static void map_nodes(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const motion *m = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        map_of_node(m, i, &m->at_node[i]);
}

void motion_set(motion *m, const double *u, pool *threads)
{
    m->u = u;
    if (!m->place)
        return;
    pool_run(threads, m->entries, CHUNK, map_elements, m);
    pool_run(threads, m->places, CHUNK, map_nodes, m);
}

/* ---- a vertex */

/* The vertex's place in its element, or the nearest one: weights as of equation (1). */
static void clamp(const bound *b, int64_t vertex, double *weight)
{
    for (int a = 0; a < 3; a++)
        weight[a] = fmin(fmax(b->weight[3 * vertex + a], 0), 1);
}

/* What the map of corner c of an element gives a place x, and the map's gradient. */
static const double *apply(const motion *m, int32_t element, int c, const double *x, double *to)
{
    const int32_t node = nodes_of(m->of, element)[c], place = m->place[node];
    const bool own = m->start[place] == m->start[place + 1];
    const motion_map *map = own ? &m->at_element[m->entry[element]] : &m->at_node[place];
    double from[3];
    if (own)
        find_centre(m->of, element, from);
    else
        memcpy(from, m->of->rest + 3 * (int64_t)node, sizeof from);
    for (int i = 0; i < 3; i++) {
        const double *g = map->gradient + 3 * i;
        to[i] = map->u[i] + (g[0] * (x[0] - from[0]) + g[1] * (x[1] - from[1]) + g[2] * (x[2] - from[2]));
    }
    return map->gradient;
}

void motion_displacement(const motion *m, int64_t vertex, double *d)
{
    const bound *b = m->of;
    if (!m->place || !b->blended[vertex]) {
        bound_displacement(b, vertex, m->u, d);
        return;
    }
    const double *x = b->shape.position + 3 * vertex;
    double weight[3], share[8], first[3], at[3], sum[3] = {0};
    clamp(b, vertex, weight);
    weights_shares(weight, share);
    apply(m, b->element[vertex], 0, x, first);
    for (int c = 1; c < 8; c++) {
        apply(m, b->element[vertex], c, x, at);
        for (int i = 0; i < 3; i++)
            sum[i] += share[c] * (at[i] - first[i]);
    }
    for (int i = 0; i < 3; i++)
        d[i] = first[i] + sum[i];
}

/* Along an axis on which the vertex is outside, the nearest place in the element does not change. */
static void slopes(const bound *b, int64_t vertex, const double *weight, double *slope)
{
    const weights_box box = weights_box_of(nodes_of(b, b->element[vertex]), b->rest);
    weights_gradients(&box, weight, slope);
    for (int a = 0; a < 3; a++)
        for (int c = 0; c < 8 && weight[a] != b->weight[3 * vertex + a]; c++)
            slope[3 * c + a] = 0;
}

void motion_gradient(const motion *m, int64_t vertex, double *f)
{
    const bound *b = m->of;
    if (!m->place || !b->blended[vertex]) {
        bound_gradient(b, vertex, m->u, f);
        return;
    }
    double weight[3], share[8], slope[24], at[3];
    clamp(b, vertex, weight);
    weights_shares(weight, share);
    slopes(b, vertex, weight, slope);
    for (int i = 0; i < 9; i++)
        f[i] = i % 4 == 0;
    for (int c = 0; c < 8; c++) {
        const double *gradient = apply(m, b->element[vertex], c, b->shape.position + 3 * vertex, at);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                f[3 * i + j] += share[c] * gradient[3 * i + j] + at[i] * slope[3 * c + j];
    }
}
