/* The lattice: metadata, corners, and the lookup from cells to elements. */
#include "mesh/lattice.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

static void set_cells(model *m, const int32_t *ijk, int64_t elements)
{
    err e = {0};
    model_axis_drop(m, "element", NULL);
    model_axis_add(m, "element", elements, &e);
    model_array *a = model_add(m, "element.lattice", &e);
    if (a && elements)
        memcpy(a->i32, ijk, 3 * (size_t)elements * sizeof *ijk);
    ok(a && !e.status, "a model of %d cells %s", (int)elements, e.text);
}

static void metadata(void)
{
    err e = {0};
    model m = {0};
    lattice l = {{0.1, -2, 1e-9}, {0.0025, 0.001, 1.0 / 3}}, back;
    ok(lattice_of(&m, &back, &e) && strstr(e.text, "lattice.origin"), "none in an empty model: %s", e.text);
    e = (err){0};
    ok(!lattice_save(&l, &m, &e) && !lattice_of(&m, &back, &e), "saved %s", e.text);
    for (int a = 0; a < 3; a++)
        ok(l.origin[a] == back.origin[a] && l.spacing[a] == back.spacing[a], "comes back to the bit");
    double corner[3], local[3];
    lattice_corner(&l, (int32_t[]){4, -3, 6}, corner);
    lattice_local(&l, corner, local);
    near_(corner[0], 0.11, 1e-15, "corner x");
    near_(corner[1], -2.003, 1e-15, "corner y");
    near_(local[0], 4, 1e-12, "local x");
    near_(local[2], 6, 1e-12, "local z");
    static const double bad[] = {0, -1, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        l.spacing[1] = bad[i];
        e = (err){0};
        lattice_save(&l, &m, &e);
        e = (err){0};
        ok(lattice_of(&m, &back, &e) && e.status == STATUS_BAD && strstr(e.text, "lattice.spacing"), "spacing %g: %s",
           bad[i], e.text);
    }
    model_free(&m);
}

static void find_places(void)
{
    err e = {0};
    model m = {0};
    lattice_map map;
    static const int32_t cells[] = {-2, 5, 0, 3, 5, 1, -2, 6, 1, 0, 5, 0};
    set_cells(&m, cells, 4);
    ok(!lattice_map_build(&map, &m, NULL, &e), "built %s", e.text);
    int wrong = 0, found = 0;
    for (int k = -2; k < 5; k++)
        for (int j = 3; j < 9; j++)
            for (int i = -4; i < 6; i++) {
                int32_t want = -1;
                for (int n = 0; n < 4; n++)
                    if (cells[3 * n] == i && cells[3 * n + 1] == j && cells[3 * n + 2] == k)
                        want = n;
                wrong += lattice_element(&map, i, j, k) != want;
                found += want >= 0;
            }
    ok(!wrong && found == 4, "each cell in and around the box has its element or none");
    ok(lattice_element(&map, INT64_MAX / 2, 5, 0) == -1, "far away there is none");
    lattice_map_free(&map);
    set_cells(&m, NULL, 0);
    ok(!lattice_map_build(&map, &m, NULL, &e) && lattice_element(&map, 0, 0, 0) == -1, "no elements, no cells %s",
       e.text);
    lattice_map_free(&map);
    model_free(&m);
}

/* Where a slit parts a cell. */
static void find_several(void)
{
    err e = {0};
    model m = {0};
    lattice_map map;
    set_cells(&m, (int32_t[]){1, 2, 3, 4, 5, 6, 1, 2, 3, 1, 2, 4, 1, 2, 3}, 5);
    ok(!lattice_map_build(&map, &m, NULL, &e), "built %s", e.text);
    const int32_t first = lattice_element(&map, 1, 2, 3), second = lattice_next(&map, first);
    ok(first == 0 && second == 2 && lattice_next(&map, second) == 4 && lattice_next(&map, 4) == -1,
       "a cell of three elements gives them in their order");
    ok(lattice_element(&map, 4, 5, 6) == 1 && lattice_next(&map, 1) == -1 && lattice_next(&map, 3) == -1,
       "others have one");
    lattice_map_free(&map);
    set_cells(&m, (int32_t[]){1, 2, 3}, 1);
    ok(!lattice_map_build(&map, &m, NULL, &e) && !map.next && lattice_next(&map, 0) == -1,
       "without any, no list is kept");
    lattice_map_free(&map);
    model_free(&m);
}

/* Many elements, by several threads: as one after another, where some cells have several and where none has. */
static void find_by_threads(void)
{
    enum { SIDE = 60, ALL = SIDE * SIDE * SIDE };
    err e = {0};
    pool *threads = pool_create(3, &e);
    int32_t *cells = malloc(sizeof *cells * 3 * ALL);
    for (int several = 0; cells && several < 2; several++) {
        model m = {0};
        lattice_map one, other;
        int wrong = 0, shared = 0;
        for (int n = 0; n < ALL; n++) {
            /* Backwards, and every hundredth in the cell of one far before it. */
            const int at = several && n % 100 == 99 ? ALL - 1 - n / 2 : ALL - 1 - n;
            cells[3 * n] = at % SIDE - 7;
            cells[3 * n + 1] = at / SIDE % SIDE;
            cells[3 * n + 2] = at / SIDE / SIDE + 11;
        }
        set_cells(&m, cells, ALL);
        ok(!lattice_map_build(&one, &m, NULL, &e) && !lattice_map_build(&other, &m, threads, &e), "built %s", e.text);
        wrong += memcmp(one.low, other.low, sizeof one.low) || memcmp(one.size, other.size, sizeof one.size);
        for (int n = 0; n < ALL; n++) {
            wrong += one.element[n] != other.element[n] || lattice_next(&one, n) != lattice_next(&other, n);
            shared += lattice_next(&one, n) >= 0;
        }
        ok(!wrong && (shared > 1000) == several, "%d cells of several elements: the same by threads", shared);
        lattice_map_free(&one);
        lattice_map_free(&other);
        model_free(&m);
    }
    free(cells);
    pool_destroy(threads);
}

static void refused(void)
{
    err e = {0};
    model m = {0};
    lattice_map map;
    ok(lattice_map_build(&map, &m, NULL, &e) && strstr(e.text, "element.lattice"), "no array: %s", e.text);
    e = (err){0};
    ok(!map.element, "nothing is left");
    static const int32_t wide[][6] = {
        {INT32_MIN, INT32_MIN, INT32_MIN, INT32_MAX, INT32_MAX, INT32_MAX},
        {0, 0, 0, INT32_MAX - 1, INT32_MAX - 1, INT32_MAX - 1},
        {0, 0, 0, 1000000, 1000000, 3},
    };
    for (int i = 0; i < 3; i++) {
        e = (err){0};
        set_cells(&m, wide[i], 2);
        ok(lattice_map_build(&map, &m, NULL, &e) && strstr(e.text, i < 2 ? "memory" : "one piece"), "too wide: %s",
           e.text);
    }
    model_free(&m);
}

int main(void)
{
    metadata();
    find_places();
    find_several();
    find_by_threads();
    refused();
    for (int n = 0; n < 8; n++) /* VTK_HEXAHEDRON: round the bottom, then round the top */
        ok(lattice_vtk[n][0] == (n % 4 == 1 || n % 4 == 2) && lattice_vtk[n][1] == (n % 4 > 1) &&
               lattice_vtk[n][2] == n / 4,
           "corner %d of a hexahedron", n);
    return done_testing();
}
