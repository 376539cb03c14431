/* The lattice of voxels that a model stands on: cell (i, j, k) spans origin + spacing * [i, i + 1) and so on.
 * Indices may be negative. The lookup from cell to element owns its table.
 */
#ifndef SINEW_LATTICE_H
#define SINEW_LATTICE_H

#include "base/pool.h"
#include "model/model.h"

typedef struct lattice {
    double origin[3], spacing[3]; /* m */
} lattice;

/* From and to the metadata lattice.origin and lattice.spacing. */
int lattice_of(const model *m, lattice *l, err *e);
int lattice_save(const lattice *l, model *m, err *e);

/* A point in units of cells from the origin. */
static inline void lattice_local(const lattice *l, const double *point, double *local)
{
    for (int a = 0; a < 3; a++)
        local[a] = (point[a] - l->origin[a]) / l->spacing[a];
}

/* Corner (i, j, k) of the lattice in m. One product and one sum an axis: the same bytes everywhere. */
static inline void lattice_corner(const lattice *l, const int32_t *ijk, double *point)
{
    for (int a = 0; a < 3; a++)
        point[a] = l->origin[a] + l->spacing[a] * ijk[a];
}

/* The offsets of a hexahedron's 8 corners in VTK order, each 0 or 1 along i, j, k. */
extern const int32_t lattice_vtk[8][3];

typedef struct lattice_map {
    int32_t low[3], size[3]; /* cells covered: low to low + size - 1 */
    int32_t *element;        /* size[2] x size[1] x size[0], i fastest: the lowest in a cell; -1: none */
    int32_t *next;           /* elements: the next higher one in the same cell, or -1; NULL: no cell has several */
} lattice_map;

/* Builds the lookup from element.lattice. threads: NULL for the caller alone. -1 with e filled on no memory, and on
 * cells too far apart. */
int lattice_map_build(lattice_map *map, const model *m, pool *threads, err *e);
void lattice_map_free(lattice_map *map);

/* The next element in the cell of an element, or -1: where a slit parts a cell. */
static inline int32_t lattice_next(const lattice_map *map, int32_t element)
{
    return map->next ? map->next[element] : -1;
}

/* The lowest element in a cell, or -1. */
static inline int32_t lattice_element(const lattice_map *map, int64_t i, int64_t j, int64_t k)
{
    i -= map->low[0], j -= map->low[1], k -= map->low[2];
    if (i < 0 || j < 0 || k < 0 || i >= map->size[0] || j >= map->size[1] || k >= map->size[2])
        return -1;
    return map->element[(k * map->size[1] + j) * map->size[0] + i];
}

#endif
