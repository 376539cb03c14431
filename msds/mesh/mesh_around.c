#include "msds/mesh/mesh_around.h"

#include "base/mem.h"

#include <stdlib.h>

int mesh_around_make(mesh_around *a, const mesh_graded *g, err *e)
{
    a->start = mem_array(g->nodes + 1, sizeof *a->start, "nodes", e);
    a->element = a->start ? mem_array(4 * g->tets, sizeof *a->element, "tetrahedra", e) : NULL;
    if (!a->element)
        return -1;
    for (int64_t i = 0; i < 4 * g->tets; i++)
        a->start[g->node[i] + 1]++;
    for (int64_t n = 0; n < g->nodes; n++)
        a->start[n + 1] += a->start[n];
    for (int64_t i = 4 * g->tets - 1; i >= 0; i--) /* backwards, so that a start stands in its place at the end */
        a->element[--a->start[g->node[i] + 1]] = (int32_t)(i / 4);
    for (int64_t n = 0; n < g->nodes; n++)
        a->start[n] = a->start[n + 1];
    a->start[g->nodes] = 4 * g->tets;
    return 0;
}

void mesh_around_free(mesh_around *a)
{
    free(a->start);
    free(a->element);
    *a = (mesh_around){0};
}

void mesh_around_face(const mesh_graded *g, int64_t tet, int corner, int32_t face[3])
{
    static const int8_t of[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (int i = 0; i < 3; i++)
        face[i] = g->node[4 * tet + of[corner][i]];
}

static bool has(const int32_t node[4], int32_t of)
{
    return node[0] == of || node[1] == of || node[2] == of || node[3] == of;
}

int64_t mesh_around_beyond(const mesh_graded *g, const mesh_around *a, int64_t tet, int corner)
{
    int32_t face[3];
    mesh_around_face(g, tet, corner, face);
    for (int64_t i = a->start[face[0]]; i < a->start[face[0] + 1]; i++) {
        const int32_t *node = &g->node[4 * (int64_t)a->element[i]];
        if (a->element[i] != tet && has(node, face[1]) && has(node, face[2]))
            return a->element[i];
    }
    return -1;
}

/* ---- parts */

/* Gives all that hangs together with a tetrahedron its number. Returns how many. stack: tets. */
static int64_t spread(const mesh_graded *g, const mesh_around *a, int64_t from, int32_t number, int32_t *part,
                      int32_t *stack)
{
    int64_t count = 0, held = 0;
    part[from] = number;
    stack[held++] = (int32_t)from;
    while (held) {
        const int64_t t = stack[--held];
        count++;
        for (int c = 0; c < 4; c++) {
            const int64_t next = mesh_around_beyond(g, a, t, c);
            if (next < 0 || part[next])
                continue;
            part[next] = number;
            stack[held++] = (int32_t)next;
        }
    }
    return count;
}

/* The number of the largest part, from 1. */
static int32_t number_parts(const mesh_graded *g, const mesh_around *a, int32_t *part, int32_t *stack, mesh_left *left)
{
    int32_t number = 0, largest = 0;
    int64_t most = 0;
    for (int64_t t = 0; t < g->tets; t++) {
        if (part[t])
            continue;
        const int64_t count = spread(g, a, t, ++number, part, stack);
        largest = count > most ? number : largest;
        most = count > most ? count : most;
    }
    *left = (mesh_left){g->tets - most, number > 0 ? number - 1 : 0};
    return largest;
}

static int keep_largest(mesh_graded *g, const int32_t *part, int32_t largest, err *e)
{
    uint8_t *marked = mem_array(g->tets, 1, "tetrahedra", e);
    if (!marked)
        return -1;
    for (int64_t t = 0; t < g->tets; t++)
        marked[t] = part[t] == largest;
    const int status = mesh_graded_keep(g, marked, e);
    free(marked);
    return status;
}

int mesh_around_largest(mesh_graded *g, mesh_left *left, err *e)
{
    mesh_around a = {0};
    int status = mesh_around_make(&a, g, e);
    int32_t *part = status ? NULL : mem_array(g->tets, sizeof *part, "tetrahedra", e);
    int32_t *stack = part ? mem_array(g->tets, sizeof *stack, "tetrahedra", e) : NULL;
    *left = (mesh_left){0};
    if (stack) {
        const int32_t largest = number_parts(g, &a, part, stack, left);
        status = left->tets ? keep_largest(g, part, largest, e) : 0;
    }
    mesh_around_free(&a);
    free(part);
    free(stack);
    return stack ? status : -1;
}
