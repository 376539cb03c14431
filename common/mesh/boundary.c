#include "mesh/boundary.h"

#include "base/mem.h"
#include "mesh/lattice.h"

#include <stdlib.h>
#include <string.h>

/* The faces of an element, VTK order: for hexahedra -i, +i, -j, +j, -k, +k. */
static const int8_t hexahedron[6][4] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                        {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
static const int8_t tetrahedron[4][4] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

typedef struct elements {
    const int32_t *node;
    int64_t count;
    int corners, sides;
    const bool *keep, *beside;
} elements;

static bool kept(const elements *x, int64_t element)
{
    return !x->keep || x->keep[element];
}

/* Whether an element takes part: its own faces, or only those that it covers. */
static bool counts(const elements *x, int64_t element)
{
    return kept(x, element) || (x->beside && x->beside[element]);
}

static int32_t face_node(const elements *x, int64_t element, int side, int corner)
{
    int at = x->corners == 8 ? hexahedron[side][corner] : tetrahedron[side][corner];
    return x->node[element * x->corners + at];
}

static int add(boundary *b, const elements *x, int64_t element, int side, err *e)
{
    if (mem_grow(&b->node, &b->capacity, (b->faces + 1) * b->corners, sizeof *b->node, "faces", e) ||
        mem_grow(&b->element, &b->element_capacity, b->faces + 1, sizeof *b->element, "faces", e))
        return -1;
    for (int i = 0; i < b->corners; i++)
        b->node[b->faces * b->corners + i] = face_node(x, element, side, i);
    b->element[b->faces++] = (int32_t)element;
    return 0;
}

/* ---- in a lattice the neighbours are known */

/* Whether two elements that are beside each other have all nodes of the face between them: not across a slit. */
static bool share_face(const elements *x, int64_t element, int side, int64_t beside)
{
    for (int i = 0; i < 4; i++) {
        const int corner = (uint8_t)hexahedron[side][i];
        int opposite = 0;
        while (lattice_vtk[opposite][side / 2] == lattice_vtk[corner][side / 2] ||
               lattice_vtk[opposite][(side / 2 + 1) % 3] != lattice_vtk[corner][(side / 2 + 1) % 3] ||
               lattice_vtk[opposite][(side / 2 + 2) % 3] != lattice_vtk[corner][(side / 2 + 2) % 3])
            opposite++;
        if (x->node[8 * element + corner] != x->node[8 * beside + opposite])
            return false;
    }
    return true;
}

/* Whether one of the elements in the cell on that side covers the element's face. */
static bool is_covered(const elements *x, const lattice_map *map, const int32_t *cell, int64_t element, int side)
{
    int64_t at[3] = {cell[3 * element], cell[3 * element + 1], cell[3 * element + 2]};
    at[side / 2] += side % 2 ? 1 : -1;
    for (int32_t n = lattice_element(map, at[0], at[1], at[2]); n >= 0; n = lattice_next(map, n))
        if (counts(x, n) && share_face(x, element, side, n))
            return true;
    return false;
}

static int of_lattice(boundary *b, const elements *x, const model *m, const int32_t *cell, err *e)
{
    lattice_map map = {0};
    int bad = lattice_map_build(&map, m, NULL, e);
    for (int64_t n = 0; n < x->count && !bad; n++)
        for (int side = 0; side < 6 && kept(x, n) && !bad; side++)
            if (!is_covered(x, &map, cell, n, side))
                bad = add(b, x, n, side, e);
    lattice_map_free(&map);
    return bad;
}

/* ---- elsewhere faces are sorted by their lowest node, and compared with the few that share it */

typedef struct face {
    int32_t node[3]; /* the others, rising; of a triangle the last is -1 */
    int32_t side;
    int64_t element;
} face;

/* Its nodes in rising order. */
static face face_of(const elements *x, int64_t element, int side, int corners, int32_t *lowest)
{
    int32_t n[4] = {0, 0, 0, -1};
    for (int i = 0; i < corners; i++) {
        int32_t v = face_node(x, element, side, i);
        int at = i;
        for (; at && n[at - 1] > v; at--)
            n[at] = n[at - 1];
        n[at] = v;
    }
    *lowest = n[0];
    return (face){{n[1], n[2], n[3]}, side, element};
}

/* start[n] to start[n + 1] - 1: the faces whose lowest node is n. */
static face *sort(const elements *x, int corners, int64_t nodes, int64_t *start, err *e)
{
    int32_t lowest;
    for (int64_t n = 0; n < x->count; n++)
        for (int side = 0; side < x->sides && counts(x, n); side++) {
            face_of(x, n, side, corners, &lowest);
            start[lowest + 1]++;
        }
    for (int64_t i = 0; i < nodes; i++)
        start[i + 1] += start[i];
    face *all = mem_array(start[nodes], sizeof *all, "faces", e);
    if (!all)
        return NULL;
    for (int64_t n = 0; n < x->count; n++)
        for (int side = 0; side < x->sides && counts(x, n); side++) {
            face f = face_of(x, n, side, corners, &lowest);
            all[start[lowest]++] = f;
        }
    memmove(start + 1, start, (size_t)nodes * sizeof *start);
    start[0] = 0;
    return all;
}

static bool shared(const face *all, int64_t from, int64_t to, int64_t at)
{
    for (int64_t i = from; i < to; i++)
        if (i != at && !memcmp(all[i].node, all[at].node, sizeof all[i].node))
            return true;
    return false;
}

static int by_nodes(boundary *b, const elements *x, int64_t nodes, err *e)
{
    int64_t *start = mem_array(nodes + 1, sizeof *start, "faces", e);
    face *all = start ? sort(x, b->corners, nodes, start, e) : NULL;
    int bad = all ? 0 : -1;
    for (int64_t n = 0; n < nodes && !bad; n++)
        for (int64_t i = start[n]; i < start[n + 1] && !bad; i++)
            if (kept(x, all[i].element) && !shared(all, start[n], start[n + 1], i))
                bad = add(b, x, all[i].element, all[i].side, e);
    free(start);
    free(all);
    return bad;
}

int boundary_of(boundary *b, const model *m, const bool *keep, const bool *beside, err *e)
{
    const model_array *node = model_need(m, "element.node", e), *cell = model_find(m, "element.lattice");
    *b = (boundary){0};
    if (!node)
        return -1;
    if (node->columns != 8 && node->columns != 4)
        return err_set(e, NULL, 0, "element.node has %d columns; expected 8 (hexahedra) or 4 (tetrahedra)",
                       (int)node->columns);
    elements x = {node->i32, node->rows, node->columns, node->columns == 8 ? 6 : 4, keep, beside};
    b->corners = node->columns == 8 ? 4 : 3;
    int bad =
        cell && node->columns == 8 ? of_lattice(b, &x, m, cell->i32, e) : by_nodes(b, &x, model_count(m, "node"), e);
    if (bad)
        boundary_free(b);
    return bad;
}

void boundary_free(boundary *b)
{
    free(b->node);
    free(b->element);
    *b = (boundary){0};
}
