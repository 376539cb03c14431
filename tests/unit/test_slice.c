/* us-slice's images against the definition, pixel by pixel; both methods, every
 * instruction set, regions and threads. */
// needs: msds/mesh/mesh_tets.c slice/image/slice_cells.c slice/image/slice_mesh.c slice/image/slice_cutter.c
// needs: slice/image/slice_paper.c slice/image/slice_lanes.c slice/image/slice_lanes_loops.c
#include "slice_block.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

enum { COLUMNS = 97, ROWS = 83, PIXELS = COLUMNS * ROWS };

typedef struct image {
    uint8_t grey[PIXELS];
    int32_t owner[PIXELS];
} image;

typedef struct how {
    const char *vectors;
    slice_method method;
    int regions, threads;
} how;

static slice_plane plane(const double middle[3], const double u[3], const double v[3], double pixel)
{
    slice_plane p;
    for (int a = 0; a < 3; a++) {
        p.column[a] = pixel * u[a];
        p.row[a] = pixel * v[a];
        p.origin[a] = middle[a] - p.column[a] * (COLUMNS - 1) / 2 - p.row[a] * (ROWS - 1) / 2;
    }
    return p;
}

/* Whether this processor can. */
static bool draw(const slice_block *b, const slice_plane *at, const how *h, image *to)
{
    err e = {0};
    slice_shown shown[ROWS];
    setenv("SINEW_VECTORS", h->vectors, 1);
    const slice_lanes *lanes = slice_lanes_choose(&e);
    if (!lanes)
        return false;
    for (int r = 0; r < ROWS; r++)
        shown[r] = (slice_shown){.to = {COLUMNS, 0}};
    pool *threads = pool_create(h->threads, &e);
    const slice_setup s = {&b->cells, &b->mesh, {COLUMNS, ROWS}, shown, lanes, h->method, h->regions, threads};
    slice_cutter *c = threads ? slice_cutter_make(&s, &e) : NULL;
    tets_must(c && !slice_cutter_image(c, at, b->u, to->grey, to->owner, &e), &e);
    slice_cutter_free(c);
    pool_destroy(threads);
    return true;
}

typedef struct found {
    int wrong, worst, beside,
        lit; /* owners that are wrong; grey levels; owners that share the face; pixels that are not black */
} found;

static void check_pixel(const slice_block *b, const double place[3], uint8_t grey, int32_t owner, found *f)
{
    double share[4], other[4], rest[3], value = 0;
    const int32_t tet = block_find(b, place, share);
    const double least = tet >= 0 ? block_shares(b, tet, place, share) : -1;
    if (tet >= 0) {
        block_rest(b, tet, share, rest);
        value = block_value(b, rest);
    }
    f->lit += grey > 0;
    if (owner >= 0 && owner != tet) {
        const bool on = block_shares(b, owner, place, other) >= -1e-7;
        f->wrong += !on;
        f->beside += on;
        if (on) {
            block_rest(b, owner, other, rest);
            value = block_value(b, rest);
        }
    } else if (owner < 0 && tet >= 0 && value >= 0) {
        f->wrong += least > 1e-7;
        value = 0;
    } else if (owner >= 0 && value < 0) {
        f->wrong++;
    }
    const int off = abs((int)floor(fmax(value, 0) + .5) - grey);
    f->worst = off > f->worst ? off : f->worst;
}

static found check(const slice_block *b, const slice_plane *at, const image *i)
{
    found f = {0};
    for (int p = 0; p < PIXELS; p++) {
        double place[3];
        for (int a = 0; a < 3; a++)
            place[a] = at->origin[a] + at->column[a] * (p % COLUMNS) + at->row[a] * (p / COLUMNS);
        check_pixel(b, place, i->grey[p], i->owner[p], &f);
    }
    return f;
}

static void test_plane(const slice_block *b, const slice_plane *at, const char *name, int lit)
{
    static image spans, paper, other;
    const how one = {"plain", SLICE_SPANS, 32, 1}, printed = {"plain", SLICE_PAPER, 32, 1};
    const how others[] = {
        {"AVX2", SLICE_SPANS, 32, 1}, {"AVX-512", SLICE_SPANS, 32, 1}, {"plain", SLICE_SPANS, 1, 3},
        {"AVX2", SLICE_SPANS, 7, 2},  {"AVX-512", SLICE_SPANS, 83, 8}, {"AVX-512", SLICE_SPANS, 200, 2},
        {"plain", SLICE_PAPER, 5, 3}, {"AVX2", SLICE_PAPER, 1, 1},     {"AVX-512", SLICE_PAPER, 32, 2}};
    draw(b, at, &one, &spans);
    found f = check(b, at, &spans);
    ok(f.worst <= 1 && !f.wrong, "%s, spans: within a grey level (%d), in the right tetrahedra (%d wrong, %d on faces)",
       name, f.worst, f.wrong, f.beside);
    ok(f.lit >= lit, "%s: %d pixels show tissue", name, f.lit);
    draw(b, at, &printed, &paper);
    f = check(b, at, &paper);
    ok(f.worst <= 1 && !f.wrong, "%s, as printed: within a grey level (%d), in the right tetrahedra (%d wrong)", name,
       f.worst, f.wrong);
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        const how *h = &others[i];
        const image *same = h->method == SLICE_PAPER ? &paper : &spans;
        if (draw(b, at, h, &other))
            ok(!memcmp(&other, same, sizeof other), "%s: the same bytes by %s, %d regions, %d threads", name,
               h->vectors, h->regions, h->threads);
        else
            skip(1, "this processor has no such vectors");
    }
}

/* Mesh faces in the slice's plane, nodes on pixels and edges along rows: no pixel is missed. */
static void test_aligned(pool *threads)
{
    static image spans;
    const int32_t nodes[3] = {9, 7, 6};
    slice_block b;
    block_make(&b, nodes, 0, threads);
    const slice_plane at = {{0, .03, 0}, {.08 / (COLUMNS - 1), 0, 0}, {0, 0, .05 / (ROWS - 1)}};
    const how one = {"", SLICE_SPANS, 32, 1};
    int missed = 0;
    draw(&b, &at, &one, &spans);
    for (int p = 0; p < PIXELS; p++) {
        const double x = .08 / (COLUMNS - 1) * (p % COLUMNS), z = .05 / (ROWS - 1) * (p / COLUMNS);
        const bool within = p % COLUMNS < COLUMNS - 1 && p / COLUMNS < ROWS - 1;
        missed += within && spans.owner[p] < 0 && block_value(&b, (double[3]){x, .03, z}) >= 0;
    }
    ok(!missed, "a slice along faces misses no pixel (%d)", missed);
    test_plane(&b, &at, "along faces", 2000);
    block_free(&b);
}

/* Rigid: the volume at the pixel's own place. */
static void test_rigid(pool *threads)
{
    static image got;
    const int32_t nodes[3] = {3, 3, 3};
    slice_block b;
    slice_shown shown[ROWS];
    err e = {0};
    int worst = 0, lit = 0;
    block_make(&b, nodes, 0, threads);
    for (int r = 0; r < ROWS; r++)
        shown[r] = (slice_shown){.to = {COLUMNS, 0}};
    const slice_plane at = plane((double[3]){.03, .03, .02}, (double[3]){.8, .6, 0}, (double[3]){.36, -.48, .8}, 1e-3);
    setenv("SINEW_VECTORS", "", 1);
    const slice_setup s = {&b.cells, NULL, {COLUMNS, ROWS}, shown, slice_lanes_choose(&e), SLICE_SPANS, 32, threads};
    slice_cutter *c = slice_cutter_make(&s, &e);
    tets_must(c && !slice_cutter_image(c, &at, NULL, got.grey, NULL, &e), &e);
    for (int p = 0; p < PIXELS; p++) {
        double place[3];
        for (int a = 0; a < 3; a++)
            place[a] = at.origin[a] + at.column[a] * (p % COLUMNS) + at.row[a] * (p / COLUMNS);
        const int off = abs((int)floor(fmax(block_value(&b, place), 0) + .5) - got.grey[p]);
        worst = off > worst ? off : worst;
        lit += got.grey[p] > 0;
    }
    ok(worst <= 1 && lit > 1000, "the volume as it lies: within a grey level (%d), %d lit", worst, lit);
    slice_cutter_free(c);
    block_free(&b);
}

/* A mesh that is folded over: any tetrahedron that holds a pixel will do, and nothing is read that is not there. */
static void test_folded(pool *threads)
{
    static image one, two;
    const int32_t nodes[3] = {6, 5, 4};
    slice_block b;
    uint32_t seed = 3;
    block_make(&b, nodes, 0, threads);
    for (int64_t i = 0; i < 3 * b.mesh.nodes; i++)
        b.u[i] = .03 * ((double)block_random(&seed) / (1 << 24) - .5);
    b.u[5] = 1e300;
    b.u[7] = -1e30;
    const slice_plane at = plane((double[3]){.04, .03, .025}, (double[3]){1, 0, 0}, (double[3]){0, .6, .8}, 8e-4);
    const how first = {"plain", SLICE_SPANS, 32, 1}, second = {"", SLICE_SPANS, 3, 2};
    draw(&b, &at, &first, &one);
    draw(&b, &at, &second, &two);
    ok(!memcmp(&one, &two, sizeof one), "a folded mesh gives the same bytes whatever draws it");
    block_free(&b);
}

/* Linear between the voxels of a volume of 8 bits, at a place in cells. */
static double linear(const uint8_t *voxel, const int64_t size[3], const int32_t at[3])
{
    double sum = 0;
    for (int c = 0; c < 8; c++) {
        double weight = 1;
        int64_t index = 0;
        for (int a = 2; a >= 0; a--) {
            const int32_t cell = at[a] >> 16;
            const double share = (at[a] & 0xffff) / 65536.;
            int64_t i = cell - 1 + (c >> a & 1);
            i = num_clamp_int(i, 0, size[a] - 1);
            weight *= c >> a & 1 ? share : 1 - share;
            index = index * size[a] + i;
        }
        sum += weight * voxel[index];
    }
    return sum;
}

/* Samples at random places of a volume, with its ends and one row of odd length, against the definition; by each set of
 * instructions. */
static void test_cells(const int64_t size[3], volume_type type, pool *threads)
{
    enum { PLACES = 2003 };
    static const char *const vectors[] = {"plain", "AVX2", "AVX-512"};
    static int32_t at[3][PLACES];
    static uint8_t first[PLACES], got[PLACES], voxel[4096];
    err e = {0};
    uint32_t seed = 11;
    slice_cells c;
    volume v = {.type = type, .size = {size[0], size[1], size[2]}, .axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    tets_must(!volume_make(&v, &e), &e);
    for (int64_t i = 0; i < volume_count(&v); i++) {
        voxel[i] = (uint8_t)block_random(&seed);
        if (type == VOLUME_U8)
            ((uint8_t *)v.data)[i] = voxel[i];
        else
            ((int32_t *)v.data)[i] = voxel[i];
    }
    tets_must(!slice_cells_make(&c, &v, (slice_window){0, 255}, threads, &e), &e);
    for (int i = 0; i < PLACES; i++)
        for (int a = 0; a < 3; a++)
            at[a][i] = i == 1 ? SLICE_ONE / 2
                              : (int32_t)(block_random(&seed) % (uint32_t)(size[a] * SLICE_ONE + 1)) + SLICE_ONE / 2;
    at[2][0] = c.black;
    double worst = 0;
    for (int k = 0; k < 3; k++) {
        setenv("SINEW_VECTORS", vectors[k], 1);
        const slice_lanes *lanes = slice_lanes_choose(&e);
        e = (err){0};
        if (!lanes)
            continue;
        lanes->sample(&c, at[0], at[1], at[2], PLACES, k ? got : first);
        ok(!k || !memcmp(got, first, sizeof got), "%d x %d x %d voxels: samples by %s", (int)size[0], (int)size[1],
           (int)size[2], vectors[k]);
    }
    for (int i = 1; i < PLACES; i++)
        worst = fmax(worst, fabs(linear(voxel, size, (int32_t[3]){at[0][i], at[1][i], at[2][i]}) - first[i]));
    ok(worst <= 1.05 && !first[0], "are linear between voxels, to %.3g grey levels, and black beyond", worst);
    ok(!v.data, "in the volume's own memory");
    slice_cells_free(&c);
    volume_free(&v);
}

/* Bricks whose numbers take more than 32 bits: the same samples as from bricks close together. Only what is touched
 * takes memory. */
static void test_far(uint64_t layer, pool *threads)
{
    enum { SIDE = 9, LAYERS = (SIDE + 2) / 2, PLACES = 1003 };
    static const char *const vectors[] = {"plain", "AVX2", "AVX-512"};
    static int32_t at[3][PLACES];
    static uint8_t expected[PLACES], got[PLACES];
    err e = {0};
    uint32_t seed = 7;
    slice_cells c;
    volume v = {.type = VOLUME_U8, .size = {SIDE, SIDE, SIDE}, .axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    tets_must(!volume_make(&v, &e), &e);
    for (int64_t i = 0; i < volume_count(&v); i++)
        ((uint8_t *)v.data)[i] = (uint8_t)block_random(&seed);
    tets_must(!slice_cells_make(&c, &v, (slice_window){0, 255}, threads, &e), &e);
    for (int i = 0; i < PLACES; i++) /* rows along every axis, places anywhere, and black ones among them */
        for (int a = 0; a < 3; a++)
            if (i % 7 == 5 && i > 400)
                at[a][i] = c.black;
            else if (i / 100 % 4 == a)
                at[a][i] = SLICE_ONE / 2 + i % 100 * (SIDE * SLICE_ONE / 100);
            else if (i > 800)
                at[a][i] = (int32_t)(block_random(&seed) % (SIDE * SLICE_ONE)) + SLICE_ONE / 2;
            else
                at[a][i] = (i / 100 + 1) * SLICE_ONE;
    slice_lanes_plain.sample(&c, at[0], at[1], at[2], PLACES, expected);
    const size_t size = (size_t)layer * (LAYERS + 1) + 64;
    slice_cells far = c;
    far.layer = layer;
    far.byte = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (far.byte == MAP_FAILED) {
        skip(3, "no room for so many addresses");
    } else {
        for (int k = 0; k < LAYERS; k++)
            memcpy(far.byte + (size_t)k * layer, c.byte + (size_t)k * c.layer, c.layer);
        for (int k = 0; k < 3; k++) {
            setenv("SINEW_VECTORS", vectors[k], 1);
            const slice_lanes *lanes = slice_lanes_choose(&e);
            e = (err){0};
            if (lanes)
                lanes->sample(&far, at[0], at[1], at[2], PLACES, got);
            ok(!lanes || !memcmp(got, expected, sizeof got), "bricks in %.3g bytes: samples by %s", (double)size,
               vectors[k]);
        }
        munmap(far.byte, size);
    }
    slice_cells_free(&c);
    volume_free(&v);
}

int main(void)
{
    err e = {0};
    const int32_t nodes[3] = {9, 7, 6};
    pool *threads = pool_create(2, &e);
    slice_block b;
    block_make(&b, nodes, 1, threads);
    const slice_plane across = plane((double[3]){.04, .03, .02}, (double[3]){1, 0, 0}, (double[3]){0, 0, 1}, 7e-4);
    const slice_plane oblique =
        plane((double[3]){.04, .031, .025}, (double[3]){.8, .6, 0}, (double[3]){.36, -.48, .8}, 6e-4);
    const slice_plane wide = plane((double[3]){.04, .03, .02}, (double[3]){0, 1, 0}, (double[3]){.6, 0, -.8}, 2e-3);
    const slice_plane close = plane((double[3]){.03, .03, .02}, (double[3]){.6, .8, 0}, (double[3]){0, 0, 1}, 2e-5);
    test_plane(&b, &across, "across", 3000);
    test_plane(&b, &oblique, "oblique", 3000);
    test_plane(&b, &wide, "wide", 500);
    test_plane(&b, &close, "close", 7000);
    test_aligned(threads);
    test_rigid(threads);
    test_folded(threads);
    test_cells((const int64_t[3]){1, 1, 1}, VOLUME_U8, threads);
    test_cells((const int64_t[3]){7, 2, 1}, VOLUME_U8, threads);
    test_cells((const int64_t[3]){3, 40, 2}, VOLUME_U8, threads);
    test_cells((const int64_t[3]){4, 5, 9}, VOLUME_I32, threads);
    test_cells((const int64_t[3]){13, 12, 14}, VOLUME_U8, threads);
    test_far(0x20000000, threads);
    test_far(0x70000000, threads);
    test_far(5000000000, threads);
    block_free(&b);
    pool_destroy(threads);
    return done_testing();
}
