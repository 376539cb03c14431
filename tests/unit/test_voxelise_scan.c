// needs: voxelise/surfaces/expansion.c voxelise/surfaces/grid.c voxelise/surfaces/crossing.c voxelise/inside.c
// needs: tests/bench/scan.c
/* Scans of 25,000 triangles and, with SINEW_LONG, of up to 1.6 million in up to 512 cells a side, against
 * an exact reference of another making: coordinates are whole numbers, rays run along x, and each
 * crossing is the sign of a whole number. Vertices are kept to a fraction of a cell, so that thousands of
 * them, of edges and of faces hold centres.
 */
#include "tap.h"

#include "tests/bench/scan.h"
#include "voxelise/inside.h"

#include <stdlib.h>
#include <string.h>

__extension__ typedef __int128 wide;

/* One mesh over cells^3 cells, each `parts` long: a vertex lies at whole numbers, the centre of cell i at parts i +
 * parts / 2. In doubles all are times `unit`, from `base` on. */
typedef struct setting {
    int cells, parts;
    double unit, base[3];
} setting;

typedef struct mesh {
    scan s;
    int32_t (*at)[3];
} mesh;

static int64_t floor_of(int64_t a, int64_t b)
{
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}

/* Stretches the scan to the lattice, but for a cell at either end. */
static bool make_mesh(mesh *m, int64_t triangles, const setting *s)
{
    err e = {0};
    double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9};
    *m = (mesh){0};
    if (scan_make(&m->s, triangles, &e))
        return false;
    m->at = malloc((size_t)m->s.vertices * sizeof *m->at);
    if (!m->at)
        return false;
    for (int64_t i = 0; i < 3 * m->s.vertices; i++) {
        low[i % 3] = fmin(low[i % 3], m->s.position[i]);
        high[i % 3] = fmax(high[i % 3], m->s.position[i]);
    }
    for (int64_t i = 0; i < 3 * m->s.vertices; i++) {
        int a = (int)(i % 3);
        double share = (m->s.position[i] - low[a]) / (high[a] - low[a]);
        m->at[i / 3][a] = (int32_t)floor((1 + share * (s->cells - 2)) * s->parts + 0.5);
        m->s.position[i] = s->base[a] + s->unit * m->at[i / 3][a];
    }
    return true;
}

static void free_mesh(mesh *m)
{
    scan_free(&m->s);
    free(m->at);
}

static int sign(wide x)
{
    return (x > 0) - (x < 0);
}

/* The side of edge a b on which (y, z) is, moved by (e^2, e^3). */
static int turn(const int32_t *a, const int32_t *b, int64_t y, int64_t z)
{
    int64_t ey = b[1] - a[1], ez = b[2] - a[2], value = ey * (z - a[2]) - ez * (y - a[1]);
    if (value)
        return value > 0 ? 1 : -1;
    return ez ? sign(-ez) : sign(ey);
}

/* Turns over every cell of the column that is past the triangle. */
static void cross(const mesh *m, const int32_t *t, const setting *s, int j, int k, uint8_t *mask)
{
    const int32_t *a = m->at[t[0]], *b = m->at[t[1]], *c = m->at[t[2]];
    int64_t y = (int64_t)s->parts * j + s->parts / 2, z = (int64_t)s->parts * k + s->parts / 2;
    int side = turn(a, b, y, z);
    if (!side || turn(b, c, y, z) != side || turn(c, a, y, z) != side)
        return;
    int64_t e[3], f[3], n[3];
    for (int i = 0; i < 3; i++)
        e[i] = b[i] - a[i], f[i] = c[i] - a[i];
    for (int i = 0; i < 3; i++)
        n[i] = e[(i + 1) % 3] * f[(i + 2) % 3] - e[(i + 2) % 3] * f[(i + 1) % 3];
    wide across = (wide)n[1] * (y - a[1]) + (wide)n[2] * (z - a[2]);
    for (int i = 0; i < s->cells; i++) {
        int64_t x = (int64_t)s->parts * i + s->parts / 2;
        int past = sign((wide)n[0] * (x - a[0]) + across);
        for (int d = 0; !past && d < 3; d++)
            past = sign(n[d]);
        mask[((int64_t)k * s->cells + j) * s->cells + i] ^= past == sign(n[0]);
    }
}

static void reference(const mesh *m, const setting *s, uint8_t *mask)
{
    memset(mask, 0, (size_t)s->cells * s->cells * s->cells);
    for (int64_t t = 0; t < m->s.triangles; t++) {
        const int32_t *v = m->s.vertex + 3 * t;
        int64_t low[3], high[3];
        for (int a = 1; a < 3; a++) {
            low[a] = high[a] = m->at[v[0]][a];
            for (int i = 1; i < 3; i++) {
                int64_t x = m->at[v[i]][a];
                low[a] = x < low[a] ? x : low[a];
                high[a] = x > high[a] ? x : high[a];
            }
            low[a] = floor_of(low[a] - s->parts / 2, s->parts);
            high[a] = floor_of(high[a] - s->parts / 2, s->parts);
        }
        for (int64_t k = low[2]; k <= high[2]; k++)
            for (int64_t j = low[1]; j <= high[1]; j++)
                cross(m, v, s, (int)j, (int)k, mask);
    }
}

/* Cells in which the inside test differs, with rays along an axis; -1 on no memory. */
static int64_t differing(const mesh *m, const setting *s, int ray, const uint8_t *mask)
{
    err e = {0};
    grid g = {0};
    for (int a = 0; a < 3; a++) {
        g.origin[a] = s->base[a];
        g.spacing[a] = s->unit * s->parts;
        g.high[a] = s->cells;
    }
    inside test = {0};
    inside_slab slab = {0};
    int64_t wrong = 0, within = 0, u = (ray + 1) % 3, v = (ray + 2) % 3;
    int64_t step[3] = {1, s->cells, (int64_t)s->cells * s->cells};
    int32_t *volume = calloc((size_t)m->s.triangles, sizeof *volume);
    pool *threads = pool_create(2, &e);
    inside_triangles t = {m->s.position, m->s.vertices, m->s.vertex, volume, m->s.triangles};
    if (!volume || !threads || inside_create(&test, &g, &t, ray, 1, threads, &e))
        wrong = -1;
    for (int64_t n = 0; wrong >= 0 && n < test.slabs; n++) {
        if (inside_look(&test, n, &slab, &e))
            wrong = -1;
        for (int64_t i = 0; wrong >= 0 && i < slab.parts; i++) {
            const inside_part *p = &slab.part[i];
            for (int64_t layer = p->box.low[u]; layer < p->box.high[u]; layer++)
                for (int64_t x = p->box.low[ray]; x < p->box.high[ray]; x++) {
                    const uint64_t *bits = inside_words(&test, p, layer, x);
                    const uint8_t *want = mask + layer * step[u] + x * step[ray] + p->box.low[v] * step[v];
                    for (int64_t b = 0; b < p->box.high[v] - p->box.low[v]; b++) {
                        wrong += (bits[b / 64] >> b % 64 & 1) != want[b * step[v]];
                        within += bits[b / 64] >> b % 64 & 1;
                    }
                }
        }
    }
    for (int64_t c = 0; wrong >= 0 && c < (int64_t)s->cells * s->cells * s->cells; c++)
        within -= mask[c];
    inside_slab_free(&slab);
    inside_free(&test);
    pool_destroy(threads);
    free(volume);
    return wrong ? wrong : within; /* what is outside of the parts is told by the sums */
}

static void test_scan(int64_t triangles, setting s)
{
    mesh m;
    uint8_t *mask = malloc((size_t)s.cells * s.cells * s.cells);
    int64_t wrong = -1;
    if (make_mesh(&m, triangles, &s) && mask) {
        reference(&m, &s, mask);
        wrong = 0;
        for (int ray = 0; ray < 3 && wrong == 0; ray++)
            wrong = differing(&m, &s, ray, mask);
    }
    ok(wrong == 0, "%lld triangles in %d^3 cells of %d parts of %g: %lld cells differ", (long long)m.s.triangles,
       s.cells, s.parts, s.unit, (long long)wrong);
    free_mesh(&m);
    free(mask);
}

int main(void)
{
    const char *is_long = getenv("SINEW_LONG");
    test_scan(25000, (setting){64, 2, 0.5, {0, 0, 0}});
    test_scan(25000, (setting){64, 1 << 20, 0x1p-30, {0x1p-3, 0, -1}});
    test_scan(25000, (setting){100, 4, 0x1p-22, {0x1p5, -0x1p7, 3}});
    test_scan(100000, (setting){130, 4, 3, {3e9, -6e9, 12}});
    if (is_long && *is_long) {
        test_scan(100000, (setting){256, 2, 1, {0x1p40, 0, 0}});
        test_scan(100000, (setting){512, 1 << 16, 0x1p-16, {0, 0, 0}});
        test_scan(400000, (setting){512, 4, 0x1p-20, {0, 7, 0}});
        test_scan(1600000, (setting){256, 8, 1, {0, 0, 0}});
        test_scan(1600000, (setting){512, 2, 1, {-1e9, 1e9, 0}});
    }
    return done_testing();
}
