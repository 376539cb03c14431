/* Meshes of five tetrahedra a cell: counts, orientation, volume, and conformity, that every face inside is shared by
 * exactly two tetrahedra and every edge is counted once; over boxes, left-handed ones and voxel models.
 */
// needs: msds/mesh/mesh_tets.c
#include "msds/mesh/mesh_tets.h"

#include "mesh/lattice.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

/* A face or edge as its nodes in ascending order. */
typedef struct part {
    int32_t node[3];
} part;

static int compare(const void *a, const void *b)
{
    const part *x = a, *y = b;
    for (int i = 0; i < 3; i++)
        if (x->node[i] != y->node[i])
            return x->node[i] < y->node[i] ? -1 : 1;
    return 0;
}

static part sorted(int32_t a, int32_t b, int32_t c)
{
    int32_t v[3] = {a, b, c};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j + 1 < 3 - i; j++)
            if (v[j] > v[j + 1]) {
                int32_t one = v[j];
                v[j] = v[j + 1];
                v[j + 1] = one;
            }
    return (part){{v[0], v[1], v[2]}};
}

/* How many parts occur once, twice, and more often. */
typedef struct tally {
    int64_t once, twice, more;
} tally;

static tally count_parts(part *list, int64_t count)
{
    tally t = {0};
    qsort(list, (size_t)count, sizeof *list, compare);
    for (int64_t i = 0, next; i < count; i = next) {
        for (next = i; next < count && !compare(&list[next], &list[i]); next++)
            ;
        t.once += next - i == 1;
        t.twice += next - i == 2;
        t.more += next - i > 2;
    }
    return t;
}

static tally count_faces(const model_array *node)
{
    part *list = calloc((size_t)node->rows * 4 + 1, sizeof *list);
    int64_t count = 0;
    for (int64_t n = 0; list && n < node->rows; n++)
        for (int f = 0; f < 4; f++) {
            const int32_t *v = &node->i32[4 * n];
            list[count++] = sorted(v[(f + 1) % 4], v[(f + 2) % 4], v[(f + 3) % 4]);
        }
    tally t = list ? count_parts(list, count) : (tally){0};
    free(list);
    return t;
}

static int64_t count_edges(const model_array *node)
{
    part *list = calloc((size_t)node->rows * 6 + 1, sizeof *list);
    int64_t count = 0;
    for (int64_t n = 0; list && n < node->rows; n++)
        for (int a = 0; a < 4; a++)
            for (int b = a + 1; b < 4; b++)
                list[count++] = sorted(node->i32[4 * n + a], node->i32[4 * n + b], -1);
    tally t = list ? count_parts(list, count) : (tally){0};
    free(list);
    return t.once + t.twice + t.more;
}

/* The sum of volumes, m3; the smallest goes into least. */
static double volumes(const model *m, double *least)
{
    const model_array *node = model_find(m, "element.node");
    double sum = 0;
    *least = INFINITY;
    for (int64_t n = 0; n < node->rows; n++) {
        double v = mesh_six_volumes(&node->i32[4 * n], model_find(m, "node.position")->f64) / 6;
        *least = fmin(*least, v);
        sum += v;
    }
    return sum;
}

static void box(int32_t x, int32_t y, int32_t z, int64_t tets, int64_t springs, bool mirrored)
{
    mesh_box b = {.nodes = {x, y, z}, .origin = {.1, -.2, .3}, .edge = {{.16, 0, 0}, {.01, .08, 0}, {0, 0, .08}}};
    model m = {0};
    err e = {0};
    double least;
    if (mirrored)
        b.edge[0][0] = -b.edge[0][0];
    ok(!mesh_box_add(&m, &b, &e), "%dx%dx%d nodes%s %s", x, y, z, mirrored ? ", left-handed" : "", e.text);
    const model_array *node = model_find(&m, "element.node"), *position = model_find(&m, "node.position");
    ok(position->rows == (int64_t)x * y * z && node->rows == tets, "%lld tetrahedra", (long long)node->rows);
    near_(volumes(&m, &least), .16 * .08 * .08, 1e-15, "they fill the box");
    ok(least > 0, "the right way round, all of them");
    tally t = count_faces(node);
    int64_t outside = 4 * ((int64_t)(x - 1) * (y - 1) + (int64_t)(y - 1) * (z - 1) + (int64_t)(z - 1) * (x - 1));
    ok(t.once == outside && t.more == 0 && t.twice == (4 * tets - outside) / 2,
       "every face inside is shared by two, and every one outside is of one");
    ok(!springs || count_edges(node) == springs, "%lld edges", (long long)count_edges(node));
    const double *last = &position->f64[3 * (position->rows - 1)];
    ok(fabs(last[1] - (-.2 + .08)) < 1e-16 && fabs(last[2] - .38) < 1e-16, "the last node is at the far corner");
    model_free(&m);
}

/* A voxel model of the cells for which a hash says so, from a lattice that begins below 0. */
static int voxels(model *m, int side, unsigned seed, err *e)
{
    int32_t cell[512][3];
    int64_t count = 0;
    for (int i = 0; i < side * side * side && count < 512; i++) {
        seed = seed * 1664525U + 1013904223U;
        if (seed >> 30) {
            cell[count][0] = i % side - 3;
            cell[count][1] = i / side % side - 2;
            cell[count++][2] = i / side / side - 1;
        }
    }
    int n = side + 1;
    if (model_axis_add(m, "node", (int64_t)n * n * n, e) || model_axis_add(m, "element", count, e) ||
        model_axis_add(m, "volume", 3, e) || !model_add(m, "node.position", e) || !model_add(m, "node.lattice", e) ||
        !model_add(m, "element.node", e) || !model_add(m, "element.lattice", e) || !model_add(m, "element.volume", e) ||
        !model_add(m, "element.fibre", e) || !model_add(m, "element.c10", e) || !model_add(m, "element.density", e) ||
        !model_add(m, "element.mix", e) || !model_add(m, "element.mixture", e) ||
        !model_add_as(m, "x-kept", MODEL_U8, "1", "node", 1, e) ||
        !model_add_as(m, "x-lost", MODEL_U8, "1", "element", 1, e))
        return -1;
    for (int i = 0; i < n * n * n; i++)
        for (int a = 0; a < 3; a++) {
            const int at[3] = {i % n, i / n % n, i / n / n};
            model_find(m, "node.position")->f64[3 * i + a] = .5 * at[a];
        }
    for (int64_t c = 0; c < count; c++) {
        for (int v = 0; v < 8; v++) {
            const int32_t *o = lattice_vtk[v];
            model_find(m, "element.node")->i32[8 * c + v] =
                ((cell[c][2] + 1 + o[2]) * n + cell[c][1] + 2 + o[1]) * n + cell[c][0] + 3 + o[0];
        }
        memcpy(&model_find(m, "element.lattice")->i32[3 * c], cell[c], sizeof cell[c]);
        model_find(m, "element.volume")->i32[c] = (int32_t)(c % 3);
        model_find(m, "element.fibre")->f32[3 * c] = (float)c;
        model_find(m, "element.mix")->i32[c] = (int32_t)(c % 2) - 1;
        model_find(m, "element.mixture")->f32[c] = (float)c;
        model_find(m, "element.c10")->f64[c] = 1 + (double)c;
        model_find(m, "element.density")->f64[c] = 2 + (double)c;
    }
    return 0;
}

static bool rows_kept(const model *m)
{
    const model_array *of = model_find(m, "element.volume"), *fibre = model_find(m, "element.fibre");
    const model_array *mix = model_find(m, "element.mix"), *mixture = model_find(m, "element.mixture");
    const model_array *own = model_find(m, "element.c10"), *density = model_find(m, "element.density");
    bool same = of && fibre && mix && mixture && own && density;
    for (int64_t n = 0; same && n < of->rows; n++)
        same = of->i32[n] == n / 5 % 3 && (int64_t)fibre->f32[3 * n] == n / 5 && mix->i32[n] == n / 5 % 2 - 1 &&
               (int64_t)mixture->f32[n] == n / 5 && (int64_t)own->f64[n] == 1 + n / 5 &&
               (int64_t)density->f64[n] == 2 + n / 5;
    return same;
}

static void split(unsigned seed)
{
    model m = {0};
    notes warnings = {0};
    err e = {0};
    double least;
    if (voxels(&m, 7, seed, &e)) {
        ok(false, "a voxel model %s", e.text);
        return;
    }
    int64_t cells = model_count(&m, "element");
    ok(!mesh_split(&m, &warnings, &e) && model_count(&m, "element") == 5 * cells,
       "%lld voxels, five tetrahedra each %s", (long long)cells, e.text);
    near_(volumes(&m, &least), .125 * (double)cells, 1e-12, "they fill the voxels");
    ok(least > 0 && count_faces(model_find(&m, "element.node")).more == 0, "no face is shared by more than two");
    ok(rows_kept(&m), "each has its voxel's volume, fibre and mixture");
    ok(!model_find(&m, "element.lattice") && model_find(&m, "x-kept") && !model_find(&m, "x-lost") &&
           warnings.count == 1,
       "what is over elements and not known is dropped, with a word");
    notes_free(&warnings);
    model_free(&m);
}

/* Voxels that all touch face to face: conformity means that faces inside are shared by two, everywhere. */
static void split_block(void)
{
    model m = {0};
    notes warnings = {0};
    err e = {0};
    int status = voxels(&m, 7, 1, &e);
    int64_t cells = model_count(&m, "element"), shared = 0;
    const int32_t *at = status ? NULL : model_find(&m, "element.lattice")->i32;
    for (int64_t c = 0; at && c < cells; c++)
        for (int64_t d = 0; d < c; d++)
            shared +=
                abs(at[3 * c] - at[3 * d]) + abs(at[3 * c + 1] - at[3 * d + 1]) + abs(at[3 * c + 2] - at[3 * d + 2]) ==
                1;
    status |= mesh_split(&m, &warnings, &e);
    tally t = count_faces(model_find(&m, "element.node"));
    ok(!status && t.twice == 4 * cells + 2 * shared,
       "%lld faces between voxels are cut along one diagonal: two pairs of triangles each", (long long)shared);
    notes_free(&warnings);
    model_free(&m);
}

static void refuse_box(int32_t x, int32_t y, int32_t z, double edge, const char *want)
{
    mesh_box b = {.nodes = {x, y, z}, .edge = {{edge, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    model m = {0};
    err e = {0};
    ok(mesh_box_add(&m, &b, &e) == -1 && strstr(e.text, want), "%s", e.text);
    model_free(&m);
}

static void refuse_split(const char *what, const char *want)
{
    model m = {0};
    err e = {0};
    voxels(&m, 3, 5, &e);
    if (!strcmp(what, "inverted")) {
        int32_t *node = model_find(&m, "element.node")->i32 + 8, one = node[0];
        node[0] = node[6];
        node[6] = one;
    } else if (!strcmp(what, "nan"))
        model_find(&m, "node.position")->f64[3 * model_find(&m, "element.node")->i32[0]] = NAN;
    else
        model_remove(&m, what);
    ok(mesh_split(&m, NULL, &e) == -1 && strstr(e.text, want), "%s", e.text);
    model_free(&m);
}

int main(void)
{
    box(5, 5, 5, 320, 0, false);
    box(20, 10, 10, 7695, 10540, false);
    box(24, 12, 12, 13915, 18624, false);
    box(28, 14, 14, 22815, 30044, false);
    box(32, 16, 16, 34875, 45376, false);
    box(2, 3, 4, 30, 0, false);
    box(9, 4, 3, 240, 0, true);
    split(1);
    split(77);
    split_block();
    refuse_box(1, 5, 5, 1, "1 nodes along a side; expected 2 or more");
    refuse_box(2000, 2000, 2000, 1, "2000x2000x2000 nodes are more than can be numbered");
    refuse_box(1000, 1000, 1000, 1, "more than can be numbered");
    refuse_box(INT32_MAX, INT32_MAX, INT32_MAX, 1, "more than can be numbered");
    refuse_box(3, 3, 3, 0, "a box of 0 m3");
    refuse_box(3, 3, 3, NAN, "a box of nan m3");
    refuse_split("inverted", "element.node, row 1: a hexahedron that is inside out or flat");
    refuse_split("nan", "inside out or flat");
    refuse_split("element.lattice", "the model has no element.lattice; expected a model from voxelise");
    return done_testing();
}
