#include "mesh/lattice.h"

#include "base/mem.h"

#include <math.h>
#include <stdatomic.h>
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

/* What takes longer than to wake a thread. */
enum { CHUNK = 1 << 15, CELLS_CHUNK = 1 << 18 }; /* elements, cells */

typedef struct box {
    int32_t low[3], high[3];
} box;

/* A table on its way. */
typedef struct filling {
    lattice_map *map;
    const int32_t *ijk;
    int64_t elements;
    box *covered;          /* chunks of elements */
    atomic_bool is_shared; /* a cell has several elements */
} filling;

static void cover_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const filling *f = context;
    box b = {{INT32_MAX, INT32_MAX, INT32_MAX}, {INT32_MIN, INT32_MIN, INT32_MIN}};
    for (int64_t n = from; n < to; n++)
        for (int a = 0; a < 3; a++) {
            const int32_t at = f->ijk[3 * n + a];
            b.low[a] = at < b.low[a] ? at : b.low[a];
            b.high[a] = at > b.high[a] ? at : b.high[a];
        }
    f->covered[chunk] = b;
}

/* The box of cells that the elements take, and its count of cells. -1 where no memory could hold a table of it. */
static int64_t cells_covered(filling *f, pool *threads)
{
    lattice_map *map = f->map;
    int64_t cells = 1;
    pool_run(threads, f->elements, CHUNK, cover_some, f);
    for (int a = 0; a < 3; a++) {
        int32_t low = f->elements ? INT32_MAX : 0;
        int32_t high = f->elements ? INT32_MIN : -1;
        for (int64_t c = 0; c < pool_chunks(f->elements, CHUNK); c++) {
            low = f->covered[c].low[a] < low ? f->covered[c].low[a] : low;
            high = f->covered[c].high[a] > high ? f->covered[c].high[a] : high;
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

static int32_t *cell_of(const filling *f, int64_t element)
{
    const lattice_map *map = f->map;
    int64_t at[3];
    for (int a = 0; a < 3; a++)
        at[a] = (int64_t)f->ijk[3 * element + a] - map->low[a];
    return &map->element[(at[2] * map->size[1] + at[1]) * map->size[0] + at[0]];
}

static void clear_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const filling *f = context;
    (void)chunk;
    for (int64_t c = from; c < to; c++)
        f->map->element[c] = -1;
}

static void enter_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    filling *f = context;
    (void)chunk;
    for (int64_t n = from; n < to; n++)
        if (__atomic_exchange_n(cell_of(f, n), (int32_t)n, __ATOMIC_RELAXED) >= 0)
            atomic_store_explicit(&f->is_shared, true, memory_order_relaxed);
}

/* Enters each element into its cell: from the highest, so that the lowest of a cell is its first. */
static int enter_in_turn(filling *f, err *e)
{
    for (int64_t n = f->elements - 1; n >= 0; n--) {
        int32_t *cell = cell_of(f, n);
        const int32_t last = *cell;
        *cell = (int32_t)n;
        if (last >= 0 && chain(f->map, (int32_t)n, last, f->elements, e))
            return -1;
    }
    return 0;
}

/* All at once; only where cells turn out to have several elements, their order counts. */
static int fill(filling *f, int64_t cells, pool *threads, err *e)
{
    pool_run(threads, cells, CELLS_CHUNK, clear_some, f);
    pool_run(threads, f->elements, CHUNK, enter_some, f);
    if (!f->is_shared)
        return 0;
    pool_run(threads, cells, CELLS_CHUNK, clear_some, f);
    return enter_in_turn(f, e);
}

static int build(filling *f, pool *threads, err *e)
{
    lattice_map *map = f->map;
    f->covered = mem_array(pool_chunks(f->elements, CHUNK), sizeof *f->covered, "the cells of the lattice", e);
    if (!f->covered)
        return -1;
    const int64_t cells = cells_covered(f, threads);
    if (cells > CELLS_FREE && cells / CELLS_EACH > f->elements)
        return err_set(e, NULL, 0,
                       "element.lattice: %lld elements are spread over %lld cells; expected a model of one piece",
                       (long long)f->elements, (long long)cells);
    if (cells < 0 || cells > mem_available() / (int64_t)sizeof *map->element)
        return err_set(e, NULL, 0, "element.lattice: %lld elements are spread over more cells than memory can hold",
                       (long long)f->elements);
    map->element = mem_array(cells, sizeof *map->element, "the cells of the lattice", e);
    return map->element ? fill(f, cells, threads, e) : -1;
}

int lattice_map_build(lattice_map *map, const model *m, pool *threads, err *e)
{
    *map = (lattice_map){0};
    const model_array *ijk = model_need(m, "element.lattice", e);
    if (!ijk)
        return -1;
    if (ijk->rows > INT32_MAX)
        return err_set(e, NULL, 0, "%lld elements; at most %d are possible", (long long)ijk->rows, INT32_MAX);
    filling f = {.map = map, .ijk = ijk->i32, .elements = ijk->rows};
    const int failed = build(&f, threads, e);
    free(f.covered);
    if (failed)
        lattice_map_free(map);
    return failed;
}

void lattice_map_free(lattice_map *map)
{
    free(map->element);
    free(map->next);
    *map = (lattice_map){0};
}
