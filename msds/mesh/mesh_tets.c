#include "msds/mesh/mesh_tets.h"

#include "base/mem.h"
#include "model/known.h"
#include "physics/law.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const int8_t mesh_five[2][MESH_TETS][4] = {
    {{0, 2, 7, 5}, {1, 0, 5, 2}, {3, 0, 2, 7}, {4, 0, 7, 5}, {6, 2, 5, 7}},
    {{1, 3, 4, 6}, {0, 1, 3, 4}, {2, 1, 6, 3}, {5, 1, 4, 6}, {7, 3, 6, 4}},
};

/* node: MESH_TETS x 4. mirrored: the lattice is left-handed. */
static void put_cell(int32_t *node, const int32_t corner[8], int64_t parity, bool mirrored)
{
    for (int t = 0; t < MESH_TETS; t++, node += 4) {
        const int8_t *of = mesh_five[parity & 1][t];
        node[0] = corner[of[0]];
        node[1] = corner[of[1]];
        node[2] = corner[of[mirrored ? 3 : 2]];
        node[3] = corner[of[mirrored ? 2 : 3]];
    }
}

static double triple(const double *u, const double *v, const double *w)
{
    return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0]);
}

double mesh_six_volumes(const int32_t *node, const double *position)
{
    double side[3][3];
    const double *a = &position[3 * (int64_t)node[0]];
    for (int s = 0; s < 3; s++)
        for (int i = 0; i < 3; i++)
            side[s][i] = position[3 * (int64_t)node[s + 1] + i] - a[i];
    return triple(side[0], side[1], side[2]);
}

/* ---- a box */

static void put_positions(const mesh_box *b, double *to)
{
    double share[3];
    for (int32_t k = 0; k < b->nodes[2]; k++)
        for (int32_t j = 0; j < b->nodes[1]; j++)
            for (int32_t i = 0; i < b->nodes[0]; i++, to += 3) {
                share[0] = (double)i / (b->nodes[0] - 1);
                share[1] = (double)j / (b->nodes[1] - 1);
                share[2] = (double)k / (b->nodes[2] - 1);
                for (int a = 0; a < 3; a++)
                    to[a] =
                        b->origin[a] + b->edge[0][a] * share[0] + b->edge[1][a] * share[1] + b->edge[2][a] * share[2];
            }
}

static void put_elements(const mesh_box *b, bool mirrored, int32_t *to)
{
    const int32_t row = b->nodes[0], layer = b->nodes[0] * b->nodes[1];
    for (int32_t k = 0; k + 1 < b->nodes[2]; k++)
        for (int32_t j = 0; j + 1 < b->nodes[1]; j++)
            for (int32_t i = 0; i + 1 < b->nodes[0]; i++, to += 4 * MESH_TETS) {
                int32_t n = k * layer + j * row + i;
                const int32_t corner[8] = {n,         n + 1,         n + row + 1,         n + row,
                                           n + layer, n + layer + 1, n + layer + row + 1, n + layer + row};
                put_cell(to, corner, (int64_t)i + j + k, mirrored);
            }
}

/* Nodes and elements of the box. -1: too many. */
static int count_box(const mesh_box *b, int64_t *nodes, int64_t *elements, err *e)
{
    *nodes = 1;
    *elements = MESH_TETS;
    for (int a = 0; a < 3; a++) {
        if (b->nodes[a] < 2)
            return err_set(e, NULL, 0, "%d nodes along a side; expected 2 or more", b->nodes[a]);
        *nodes = *nodes > INT32_MAX ? *nodes : *nodes * b->nodes[a];
        *elements = *elements > INT32_MAX ? *elements : *elements * (b->nodes[a] - 1);
    }
    if (*nodes <= INT32_MAX && *elements <= INT32_MAX)
        return 0;
    return err_set(e, NULL, 0, "%dx%dx%d nodes are more than can be numbered; expected at most %d nodes and tetrahedra",
                   b->nodes[0], b->nodes[1], b->nodes[2], INT32_MAX);
}

int mesh_box_check(const mesh_box *b, bool *mirrored, err *e)
{
    const double volume = triple(b->edge[0], b->edge[1], b->edge[2]);
    *mirrored = volume < 0;
    if (isfinite(volume) && fabs(volume) > 0)
        return 0;
    return err_set(e, NULL, 0, "a box of %g m3; expected edges that span a volume", fabs(volume));
}

int mesh_box_add(model *m, const mesh_box *b, err *e)
{
    int64_t nodes, elements;
    bool mirrored;
    if (count_box(b, &nodes, &elements, e) || mesh_box_check(b, &mirrored, e))
        return -1;
    if (model_axis_add(m, "node", nodes, e) || model_axis_add(m, "element", elements, e) ||
        !model_add(m, "node.position", e) || !model_add_as(m, "element.node", MODEL_I32, "@node", "element", 4, e))
        return -1;
    put_positions(b, model_find(m, "node.position")->f64);
    put_elements(b, mirrored, model_find(m, "element.node")->i32);
    return 0;
}

/* ---- a voxel model */

/* What stays of an element, by the names of arrays: every tetrahedron has its cell's row. */
#define KEY_ARRAY(key, unit, low, high, meaning) "element." #key,
static const char *const kept[] = {"element.volume",
                                   "element.fibre",
                                   "element.fraction",
                                   "element.mix",
                                   "element.mixture",
                                   "element.mixfibre",
                                   LAW_KEYS(KEY_ARRAY) LAW_DENSITY_KEY(KEY_ARRAY)};

enum { KEPT = sizeof kept / sizeof *kept };

typedef struct split {
    int32_t *node; /* tetrahedra x 4 */
    int64_t cells;
    void *data[KEPT]; /* MESH_TETS rows a cell, NULL: the model has no such array */
    size_t row[KEPT]; /* bytes of one */
} split;

static void split_free(split *s)
{
    free(s->node);
    for (int i = 0; i < KEPT; i++)
        free(s->data[i]);
}

static int cut_cells(split *s, const model *m, err *e)
{
    const model_array *node = model_need(m, "element.node", e);
    if (node && node->columns != 8)
        return err_set(e, NULL, 0, "the model's elements have %d nodes; expected hexahedra, from voxelise",
                       node->columns);
    const model_array *ijk = node ? model_need(m, "element.lattice", e) : NULL;
    const model_array *position = ijk ? model_need(m, "node.position", e) : NULL;
    if (!position)
        return -1;
    if (node->rows > INT32_MAX / MESH_TETS)
        return err_set(e, NULL, 0, "%lld elements give more tetrahedra than can be numbered; expected at most %d",
                       (long long)node->rows, INT32_MAX / MESH_TETS);
    s->cells = node->rows;
    s->node = mem_array(s->cells, 4 * MESH_TETS * sizeof *s->node, "tetrahedra", e);
    for (int64_t c = 0; s->node && c < s->cells; c++) {
        const int32_t *at = &ijk->i32[3 * c];
        int32_t *to = &s->node[4 * MESH_TETS * c];
        put_cell(to, &node->i32[8 * c], (int64_t)at[0] + at[1] + at[2], false);
        for (int t = 0; t < MESH_TETS; t++)
            if (!(mesh_six_volumes(to + 4 * t, position->f64) > 0))
                return err_set(e, NULL, 0,
                               "element.node, row %lld: a hexahedron that is inside out or flat; expected VTK's order",
                               (long long)c);
    }
    return s->node ? 0 : -1;
}

static int keep(split *s, const model *m, err *e)
{
    for (int i = 0; i < KEPT; i++) {
        const model_array *a = model_find(m, kept[i]);
        if (!a)
            continue;
        s->row[i] = (size_t)a->columns * model_type_size(a->type);
        char *to = s->data[i] = mem_array(s->cells * MESH_TETS, s->row[i], kept[i], e);
        if (!to)
            return -1;
        for (int64_t n = 0; n < s->cells * MESH_TETS; n++)
            memcpy(to + (size_t)n * s->row[i], (const char *)a->data + (size_t)(n / MESH_TETS) * s->row[i], s->row[i]);
    }
    return 0;
}

static void note_bound(const model *m, notes *warnings)
{
    char name[MODEL_NAME], array[2 * MODEL_NAME];
    for (int at = 0; model_surface(m, &at, name, sizeof name);) {
        snprintf(array, sizeof array, "%s/vertex.element", name);
        if (model_find(m, array))
            notes_add(warnings, "surface %s is no longer bound: bind it to the tetrahedra", name);
    }
}

static bool is_weight(const model_array *a, const void *context)
{
    const known *k = known_find(a->name);
    (void)context;
    return k && (!strcmp(k->name, "*/vertex.weight") || !strcmp(k->name, "*/vertex.blended"));
}

int mesh_split(model *m, notes *warnings, err *e)
{
    split s = {0};
    int status = -1;
    if (cut_cells(&s, m, e) || keep(&s, m, e) || !s.node)
        goto out;
    note_bound(m, warnings);
    if (model_find(m, "slide.node"))
        notes_add(warnings, "nodes that slide on bone (attach --slide) are free in tetrahedra");
    if (model_find(m, "contact.element"))
        notes_add(warnings, "skin that touches itself (bind --self-contact) does not in tetrahedra");
    model_axis_drop(m, "slide", warnings);
    model_axis_drop(m, "field", warnings);
    model_axis_drop(m, "distance", warnings);
    model_axis_drop(m, "contact", warnings);
    model_axis_drop(m, "skin", warnings);
    model_remove_all(m, is_weight, NULL); /* in hexahedra, they mean nothing without the elements */
    model_axis_drop(m, "element", warnings);
    model_axis_drop(m, "bone", warnings);
    model_axis_drop(m, "film", warnings);
    model_axis_drop(m, "cut", warnings); /* tetrahedra have the share alone, and moduli between */
    model_axis_drop(m, "border", warnings);
    if (model_axis_add(m, "element", s.cells * MESH_TETS, e))
        goto out;
    model_array *node = model_add_as(m, "element.node", MODEL_I32, "@node", "element", 4, e);
    if (!node)
        goto out;
    memcpy(node->i32, s.node, (size_t)s.cells * 4 * MESH_TETS * sizeof *s.node);
    for (int i = 0; i < KEPT; i++) {
        model_array *a = s.data[i] ? model_add(m, kept[i], e) : NULL;
        if (s.data[i] && !a)
            goto out;
        if (a)
            memcpy(a->data, s.data[i], (size_t)(s.cells * MESH_TETS) * s.row[i]);
    }
    status = 0;
out:
    split_free(&s);
    return status;
}
