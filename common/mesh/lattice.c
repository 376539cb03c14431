#include "mesh/lattice.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>

const int32_t lattice_vtk[8][3] = {
    {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1},
};

int lattice_of(const model *m, lattice *l, err *e)
{
    if (model_meta_numbers(m, "lattice.origin", l->origin, 3, e) ||
        model_meta_numbers(m, "lattice.spacing", l->spacing, 3, e))
        return -1;
    for (int a = 0; a < 3; a++) {
        if (!isfinite(l->origin[a]))
            return err_set(e, NULL, 0, "lattice.origin holds %g; three finite numbers are needed", l->origin[a]);
        if (!isfinite(l->spacing[a]) || l->spacing[a] <= 0)
            return err_set(e, NULL, 0, "lattice.spacing holds %g; three finite numbers above 0 are needed",
                           l->spacing[a]);
    }
    return 0;
}

int lattice_save(const lattice *l, model *m, err *e)
{
    if (model_meta_set_numbers(m, "lattice.origin", l->origin, 3, e))
        return -1;
    return model_meta_set_numbers(m, "lattice.spacing", l->spacing, 3, e);
}

/* A table of cells may be this large, or larger by so many cells for an element: a few elements
 * far apart may not ask for any memory. */
enum { CELLS_FREE = 1 << 22, CELLS_EACH = 1000 };

/* The box of cells that the elements take, and its count of cells. -1 where no memory could hold a table of it. */
static int64_t cells_covered(lattice_map *map, const int32_t *ijk, int64_t elements)
{
    int64_t cells = 1;
    for (int a = 0; a < 3; a++) {
        int32_t low = elements ? INT32_MAX : 0;
        int32_t high = elements ? INT32_MIN : -1;
        for (int64_t n = 0; n < elements; n++) {
            int32_t at = ijk[3 * n + a];
            low = at < low ? at : low;
            high = at > high ? at : high;
        }
        int64_t size = (int64_t)high - low + 1;
        if (size > INT32_MAX || (size && cells > INT64_MAX / 8 / size))
            return -1;
        map->low[a] = low;
        map->size[a] = (int32_t)size;
        cells *= size;
    }
    return cells;
}

/* Puts an element before another one of its cell. */
static int chain(lattice_map *map, int32_t element, int32_t before, int64_t elements, err *e)
{
    if (!map->next) {
        map->next = mem_array(elements, sizeof *map->next, "the cells of the lattice", e);
        if (!map->next)
            return -1;
        for (int64_t n = 0; n < elements; n++)
            map->next[n] = -1;
    }
    map->next[element] = before;
    return 0;
}

/* Enters each element into its cell: from the highest, so that the lowest of a cell is its first. */
static int fill(lattice_map *map, const int32_t *ijk, int64_t elements, err *e)
{
    for (int64_t n = elements - 1; n >= 0; n--) {
        int64_t at[3];
        for (int a = 0; a < 3; a++)
            at[a] = (int64_t)ijk[3 * n + a] - map->low[a];
        int32_t *cell = &map->element[(at[2] * map->size[1] + at[1]) * map->size[0] + at[0]];
        const int32_t last = *cell;
        *cell = (int32_t)n;
        if (last >= 0 && chain(map, (int32_t)n, last, elements, e))
            return -1;
    }
    return 0;
}

int lattice_map_build(lattice_map *map, const model *m, err *e)
{
    *map = (lattice_map){0};
    const model_array *ijk = model_need(m, "element.lattice", e);
    if (!ijk)
        return -1;
    if (ijk->rows > INT32_MAX)
        return err_set(e, NULL, 0, "%lld elements; at most %d are possible", (long long)ijk->rows, INT32_MAX);
    int64_t cells = cells_covered(map, ijk->i32, ijk->rows);
    if (cells > CELLS_FREE && cells / CELLS_EACH > ijk->rows)
        return err_set(e, NULL, 0,
                       "element.lattice: %lld elements are spread over %lld cells; expected a model of one piece",
                       (long long)ijk->rows, (long long)cells);
    if (cells < 0 || cells > mem_available() / (int64_t)sizeof *map->element)
        return err_set(e, NULL, 0, "element.lattice: %lld elements are spread over more cells than memory can hold",
                       (long long)ijk->rows);
    map->element = mem_array(cells, sizeof *map->element, "the cells of the lattice", e);
    if (!map->element)
        return -1;
    for (int64_t c = 0; c < cells; c++)
        map->element[c] = -1;
    if (fill(map, ijk->i32, ijk->rows, e)) {
        lattice_map_free(map);
        return -1;
    }
    return 0;
}

void lattice_map_free(lattice_map *map)
{
    free(map->element);
    free(map->next);
    *map = (lattice_map){0};
}
