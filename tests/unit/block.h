/* Blocks of voxels for unit tests: models with a lattice, nodes, elements and three volumes, of which none is a muscle.
 */
#ifndef SINEW_VOXELS_FOR_TESTS_H
#define SINEW_VOXELS_FOR_TESTS_H

#include "mesh/lattice.h"

#include "tap.h"

#include <string.h>

static inline int32_t node_at(const int32_t *size, int32_t i, int32_t j, int32_t k)
{
    return (k * (size[1] + 1) + j) * (size[0] + 1) + i;
}

static inline void node_arrays(model *m, const lattice *l, const int32_t *size, err *e)
{
    model_axis_add(m, "node", (size[0] + 1) * (size[1] + 1) * (size[2] + 1), e);
    model_array *position = model_add(m, "node.position", e);
    int64_t n = 0;
    for (int32_t k = 0; position && k <= size[2]; k++)
        for (int32_t j = 0; j <= size[1]; j++)
            for (int32_t i = 0; i <= size[0]; i++)
                lattice_corner(l, (int32_t[]){i, j, k}, &position->f64[3 * n++]);
}

/* A block of size[0] x size[1] x size[2] voxels, all in volume 0, without every skip-th (0: with all). */
static inline void block(model *m, const lattice *l, const int32_t *size, int skip_each)
{
    err e = {0};
    int32_t cells = size[0] * size[1] * size[2];
    *m = (model){0};
    lattice_save(l, m, &e);
    node_arrays(m, l, size, &e);
    model_axis_add(m, "element", skip_each ? cells - (cells + skip_each - 1) / skip_each : cells, &e);
    model_axis_add(m, "material", 1, &e);
    model_axis_add(m, "volume", 3, &e);
    model_add(m, "element.lattice", &e);
    model_add(m, "element.node", &e);
    model_add(m, "element.volume", &e);
    model_add(m, "volume.muscle", &e);
    model_add(m, "volume.name", &e);
    int32_t *cell = model_find(m, "element.lattice")->i32, *node = model_find(m, "element.node")->i32;
    for (int32_t c = 0, n = 0; c < cells; c++) {
        if (skip_each && c % skip_each == 0)
            continue;
        int32_t at[] = {c % size[0], c / size[0] % size[1], c / size[0] / size[1]};
        memcpy(&cell[3 * n], at, sizeof at);
        for (int v = 0; v < 8; v++)
            node[8 * n + v] =
                node_at(size, at[0] + lattice_vtk[v][0], at[1] + lattice_vtk[v][1], at[2] + lattice_vtk[v][2]);
        n++;
    }
    if (e.status)
        ok(false, "a block: %s", e.text);
}

#endif
