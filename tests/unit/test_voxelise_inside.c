// needs: voxelise/surfaces/expansion.c voxelise/surfaces/grid.c voxelise/surfaces/crossing.c voxelise/inside.c
/* The inside test against an exact reference of another making: whole numbers, the centre moved by a real e = 2^-14,
 * and a ray in a skew direction that no edge of these meshes can meet; signs of 4 x 4 determinants only. Meshes whose
 * faces, edges, diagonals and vertices lie on centres; every axis; translated; scaled to awkward units.
 */
#include "tap.h"

#include "voxelise/inside.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

__extension__ typedef __int128 wide;

enum { VERTICES = 64, TRIANGLES = 96, SIDE = 12, CELLS = SIDE * SIDE * SIDE, MOVE = 14 };

typedef struct mesh {
    int64_t at[VERTICES][3]; /* halves of a unit */
    int32_t triangle[TRIANGLES][3];
    int vertices, triangles;
} mesh;

static uint64_t state = 88172645463325252u;

static int64_t draw(int64_t low, int64_t high)
{
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    return low + (int64_t)(state % (uint64_t)(high - low + 1));
}

static void add_triangle(mesh *m, int a, int b, int c)
{
    int32_t *t = m->triangle[m->triangles++];
    t[0] = a, t[1] = b, t[2] = c;
}

static int add_vertex(mesh *m, int64_t x, int64_t y, int64_t z)
{
    int64_t *p = m->at[m->vertices];
    p[0] = x, p[1] = y, p[2] = z;
    return m->vertices++;
}

/* Any four points: often flat, now and then without any area. */
static void add_tetrahedron(mesh *m, int64_t size)
{
    int v[4];
    for (int i = 0; i < 4; i++)
        v[i] = add_vertex(m, draw(0, size), draw(0, size), draw(0, size));
    add_triangle(m, v[0], v[1], v[2]);
    add_triangle(m, v[0], v[3], v[1]);
    add_triangle(m, v[1], v[3], v[2]);
    add_triangle(m, v[2], v[3], v[0]);
}

static void add_octahedron(mesh *m, int64_t size)
{
    int64_t r = draw(1, size / 2), x = draw(r, size - r), y = draw(r, size - r), z = draw(r, size - r);
    int low[3], high[3];
    for (int a = 0; a < 3; a++) {
        low[a] = add_vertex(m, x - r * (a == 0), y - r * (a == 1), z - r * (a == 2));
        high[a] = add_vertex(m, x + r * (a == 0), y + r * (a == 1), z + r * (a == 2));
    }
    for (int i = 0; i < 8; i++)
        add_triangle(m, i & 1 ? low[0] : high[0], i & 2 ? low[1] : high[1], i & 4 ? low[2] : high[2]);
}

/* A box, its faces cut along either diagonal. */
static void add_box(mesh *m, int64_t size)
{
    int64_t low[3], high[3];
    int v[8];
    for (int a = 0; a < 3; a++)
        low[a] = draw(0, size - 1), high[a] = draw(low[a] + 1, size);
    for (int i = 0; i < 8; i++)
        v[i] = add_vertex(m, i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]);
    static const int quad[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int f = 0; f < 6; f++) {
        int turn = (int)draw(0, 1);
        const int *q = quad[f];
        add_triangle(m, v[q[turn]], v[q[turn + 1]], v[q[turn + 2]]);
        add_triangle(m, v[q[turn]], v[q[turn + 2]], v[q[(turn + 3) % 4]]);
    }
}

/* A box each of whose faces is a fan about a point of its own, inside of it or at its rim: coplanar triangles, some
 * without area. */
static void add_fans(mesh *m, int64_t size)
{
    int64_t low[3], high[3];
    int v[8];
    for (int a = 0; a < 3; a++)
        low[a] = draw(0, size - 1), high[a] = draw(low[a] + 1, size);
    for (int i = 0; i < 8; i++)
        v[i] = add_vertex(m, i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]);
    static const int quad[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    static const int across[6] = {2, 2, 1, 1, 0, 0};
    for (int f = 0; f < 6; f++) {
        int64_t p[3];
        for (int a = 0; a < 3; a++)
            if (a != across[f])
                p[a] = draw(low[a], high[a]);
            else
                p[a] = f % 2 == 0 ? low[a] : high[a];
        int middle = add_vertex(m, p[0], p[1], p[2]);
        for (int i = 0; i < 4; i++)
            add_triangle(m, middle, v[quad[f][i]], v[quad[f][(i + 1) % 4]]);
    }
}

/* Two corners next to each other, two far away: all but flat, and as long as the lattice. */
static void add_sliver(mesh *m, int64_t size)
{
    int64_t at[2][3], next[2][3];
    int v[4];
    for (int a = 0; a < 3; a++) {
        at[0][a] = draw(0, 2), at[1][a] = draw(size - 2, size);
        if (draw(0, 1))
            at[0][a] = size - at[0][a], at[1][a] = size - at[1][a];
        for (int i = 0; i < 2; i++)
            next[i][a] = at[i][a] + draw(-1, 1);
    }
    for (int i = 0; i < 2; i++) {
        v[i] = add_vertex(m, at[i][0], at[i][1], at[i][2]);
        v[2 + i] = add_vertex(m, next[i][0], next[i][1], next[i][2]);
    }
    add_triangle(m, v[0], v[1], v[2]);
    add_triangle(m, v[0], v[3], v[1]);
    add_triangle(m, v[1], v[3], v[2]);
    add_triangle(m, v[2], v[3], v[0]);
}

static mesh any_mesh(int64_t size)
{
    mesh m = {0};
    for (int parts = (int)draw(1, 3); parts > 0; parts--)
        switch (draw(0, 4)) {
        case 3:
            add_fans(&m, size);
            break;
        case 4:
            add_sliver(&m, size);
            break;
        case 0:
            add_tetrahedron(&m, size);
            break;
        case 1:
            add_octahedron(&m, size);
            break;
        default:
            add_box(&m, size);
        }
    return m;
}

static wide determinant(const wide *a, const wide *b, const wide *c)
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

static int sign(wide x)
{
    return (x > 0) - (x < 0);
}

/* Whether a centre (halves of a unit) is inside: the parity of triangles met by a ray from the moved centre. */
static bool reference(const mesh *m, const int64_t *centre)
{
    static const wide direction[3] = {10007, 7919, -9001};
    wide moved[3], unit = (wide)1 << (3 * MOVE);
    bool within = false;
    for (int a = 0; a < 3; a++)
        moved[a] = (wide)centre[a] * unit + ((wide)1 << (MOVE * (2 - a)));
    for (int t = 0; t < m->triangles; t++) {
        wide to[3][3], normal[3], e[3], f[3];
        for (int i = 0; i < 3; i++)
            for (int a = 0; a < 3; a++)
                to[i][a] = (wide)m->at[m->triangle[t][i]][a] * unit - moved[a];
        for (int a = 0; a < 3; a++) {
            e[a] = m->at[m->triangle[t][1]][a] - m->at[m->triangle[t][0]][a];
            f[a] = m->at[m->triangle[t][2]][a] - m->at[m->triangle[t][0]][a];
        }
        for (int a = 0; a < 3; a++)
            normal[a] = e[(a + 1) % 3] * f[(a + 2) % 3] - e[(a + 2) % 3] * f[(a + 1) % 3];
        wide height = normal[0] * to[0][0] + normal[1] * to[0][1] + normal[2] * to[0][2];
        wide rise = normal[0] * direction[0] + normal[1] * direction[1] + normal[2] * direction[2];
        if (sign(height) * sign(rise) <= 0)
            continue;
        int s = sign(determinant(direction, to[0], to[1]));
        if (s && s == sign(determinant(direction, to[1], to[2])) && s == sign(determinant(direction, to[2], to[0])))
            within = !within;
    }
    return within;
}

/* How a mesh in halves becomes doubles: x = base + half * at, with the lattice's origin and spacing alike. */
typedef struct setting {
    double base[3], half[3]; /* of a unit */
    int64_t origin[3];       /* of the lattice, halves */
    int64_t spacing[3];      /* even: centres are whole halves */
    int64_t shift[3];        /* cells by which the mesh is moved and the lattice is not */
} setting;

/* Rays along an axis; false on no memory. */
static bool fill_mask(const grid *g, const inside_triangles *t, int axis, pool *threads, uint8_t *mask)
{
    static const int step[3] = {1, SIDE, SIDE * SIDE};
    inside test;
    inside_slab slab = {0};
    err e = {0};
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    memset(mask, 0, CELLS);
    if (inside_create(&test, g, t, axis, 1, threads, &e))
        return false;
    bool good = true;
    for (int64_t n = 0; good && n < test.slabs; n++) {
        good = inside_look(&test, n, &slab, &e) == 0;
        for (int64_t i = 0; good && i < slab.parts; i++) {
            const inside_part *p = &slab.part[i];
            for (int64_t layer = p->box.low[u]; layer < p->box.high[u]; layer++)
                for (int64_t x = p->box.low[axis]; x < p->box.high[axis]; x++)
                    for (int64_t y = p->box.low[v]; y < p->box.high[v]; y++) {
                        int64_t bit = y - p->box.low[v];
                        if (inside_words(&test, p, layer, x)[bit / 64] >> bit % 64 & 1)
                            mask[(layer - g->low[u]) * step[u] + (x - g->low[axis]) * step[axis] +
                                 (y - g->low[v]) * step[v]] |= (uint8_t)(1 << p->volume);
                    }
        }
    }
    inside_slab_free(&slab);
    inside_free(&test);
    return good;
}

/* The mask along each axis, bit `volume` where inside. Returns whether all three agree. */
static bool masks(const mesh *m, const setting *s, uint8_t *mask)
{
    double position[3 * VERTICES];
    int32_t volume[TRIANGLES] = {0};
    for (int i = 0; i < m->vertices; i++)
        for (int a = 0; a < 3; a++)
            position[3 * i + a] = s->base[a] + s->half[a] * (double)(m->at[i][a] + s->shift[a] * s->spacing[a]);
    grid g = {0};
    for (int a = 0; a < 3; a++) {
        g.origin[a] = s->base[a];
        g.offset[a] = s->half[a] * (double)s->origin[a];
        g.spacing[a] = s->half[a] * (double)s->spacing[a];
        g.low[a] = s->shift[a], g.high[a] = s->shift[a] + SIDE;
    }
    inside_triangles t = {position, m->vertices, m->triangle[0], volume, m->triangles};
    err e = {0};
    pool *threads = pool_create(1, &e);
    uint8_t other[CELLS];
    bool same = threads && fill_mask(&g, &t, 0, threads, mask);
    for (int axis = 1; axis < 3; axis++)
        same = same && fill_mask(&g, &t, axis, threads, other) && memcmp(mask, other, CELLS) == 0;
    pool_destroy(threads);
    return same;
}

static int differing(const mesh *m, const setting *s, const uint8_t *mask)
{
    int count = 0;
    for (int i = 0; i < CELLS; i++) {
        int64_t cell[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE}, centre[3];
        for (int a = 0; a < 3; a++)
            centre[a] = s->origin[a] + cell[a] * s->spacing[a] + s->spacing[a] / 2;
        count += reference(m, centre) != (mask[i] & 1);
    }
    return count;
}

/* So many meshes, or more with SINEW_LONG; a fifth with sanitizers. */
static int meshes_of(int count)
{
    const char *is_long = getenv("SINEW_LONG");
    if (is_long && *is_long)
        return 25 * count;
    return getenv("SINEW_SANITIZED") ? count / 5 : count;
}

static void test_reference(const char *name, setting s, int64_t size, int meshes)
{
    meshes = meshes_of(meshes);
    int wrong = 0, unlike = 0;
    int64_t within = 0;
    for (int n = 0; n < meshes; n++) {
        mesh m = any_mesh(size);
        uint8_t mask[CELLS] = {0};
        unlike += !masks(&m, &s, mask);
        wrong += differing(&m, &s, mask);
        for (int i = 0; i < CELLS; i++)
            within += mask[i] & 1;
    }
    ok(wrong == 0, "%s: %d of %d voxels differ from the reference", name, wrong, meshes * CELLS);
    ok(unlike == 0, "%s: %d of %d meshes differ between rays along x, y and z", name, unlike, meshes);
    ok(within > meshes, "%s: %lld voxels are inside", name, (long long)within);
}

/* The same mesh moved by whole cells, far away: the same mask. */
static void test_translation(void)
{
    static const int64_t far[4] = {3, 1000000, 999999999, -1000000000};
    int unlike = 0, meshes = meshes_of(400);
    for (int n = 0; n < meshes; n++) {
        mesh m = any_mesh(24);
        setting here = {.half = {0.5, 0.5, 0.5}, .spacing = {2, 4, 2}, .origin = {1, 0, 0}}, there = here;
        for (int a = 0; a < 3; a++)
            there.shift[a] = far[draw(0, 3)];
        uint8_t first[CELLS], second[CELLS];
        bool same = masks(&m, &here, first) && masks(&m, &there, second);
        unlike += !same || memcmp(first, second, CELLS) != 0;
    }
    ok(unlike == 0, "%d of %d meshes differ after a move by up to 1e9 voxels", unlike, meshes);
}

/* In units whose doubles are rounded, nothing lies where the whole numbers said; the axes agree all the same. */
static void test_rounded(void)
{
    static const double unit[4] = {0.1, 1e-6 / 3, 123.4567, 2.54e-2};
    int unlike = 0, meshes = meshes_of(800);
    for (int n = 0; n < meshes; n++) {
        mesh m = any_mesh(24);
        double h = unit[n % 4];
        setting s = {.base = {0.3 * h, 1e7 * h, -1e3 * h}, .half = {h, h * 0.7, h}, .spacing = {2, 2, 2}};
        uint8_t mask[CELLS] = {0};
        unlike += !masks(&m, &s, mask);
    }
    ok(unlike == 0, "%d of %d meshes in rounded units differ between rays along x, y and z", unlike, meshes);
}

/* A cube of whole cells whose sides lie on centres owns those of its low sides. */
static void test_cube(void)
{
    mesh m = {0};
    static const int quad[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int i = 0; i < 8; i++)
        add_vertex(&m, i & 1 ? 9 : 3, i & 2 ? 9 : 3, i & 4 ? 9 : 3);
    for (int f = 0; f < 6; f++) {
        add_triangle(&m, quad[f][0], quad[f][1], quad[f][2]);
        add_triangle(&m, quad[f][0], quad[f][2], quad[f][3]);
    }
    setting s = {.half = {0.5, 0.5, 0.5}, .spacing = {2, 2, 2}};
    uint8_t mask[CELLS] = {0};
    ok(masks(&m, &s, mask), "a cube: the same along x, y and z");
    int count = 0;
    for (int i = 0; i < CELLS; i++)
        count += mask[i] & 1;
    ok(count == 27, "a cube of 3 cells a side, its corners on centres, has %d voxels", count);
    ok(mask[(1 * SIDE + 1) * SIDE + 1] == 1 && mask[(4 * SIDE + 4) * SIDE + 4] == 0, "its low corner's, not its high");
}

int main(void)
{
    test_cube();
    test_reference("faces on centres", (setting){.half = {0.5, 0.5, 0.5}, .spacing = {2, 2, 2}}, 24, 1200);
    test_reference("faces on and between", (setting){.half = {1, 1, 1}, .spacing = {4, 2, 6}, .origin = {1, 0, -1}}, 24,
                   600);
    test_reference("small meshes", (setting){.half = {0.25, 0.25, 0.25}, .spacing = {2, 2, 2}}, 6, 800);
    test_reference("far away",
                   (setting){.base = {0x1p40, -0x1p45, 0x1p30}, .half = {0.5, 0.5, 0.5}, .spacing = {2, 2, 2}}, 20,
                   400);
    test_reference("micrometres in metres",
                   (setting){.half = {0x1p-21, 0x1p-21, 0x1p-21}, .spacing = {2, 2, 4}, .origin = {-2, -1, 0}}, 20,
                   400);
    test_translation();
    test_rounded();
    return done_testing();
}
