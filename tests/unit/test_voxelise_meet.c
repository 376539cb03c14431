// needs: voxelise/surfaces/meet.c voxelise/surfaces/expansion.c
/* Where triangles cross, against whole numbers: triangles whose corners are few places of a lattice, so that corners,
 * edges and planes fall together all the time; and boxes in lattices of squares that cross along their edges. */
#include "tap.h"

#include "voxelise/surfaces/meet.h"

#include <stdint.h>
#include <string.h>

static uint64_t seed = 1;

static int64_t draw(int64_t below)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (int64_t)(seed >> 33) % below;
}

typedef struct triangle {
    int64_t at[3][3];
} triangle;

static void normal(const triangle *t, int64_t *n)
{
    for (int a = 0; a < 3; a++) {
        int j = (a + 1) % 3, k = (a + 2) % 3;
        n[a] = (t->at[1][j] - t->at[0][j]) * (t->at[2][k] - t->at[0][k]) -
               (t->at[1][k] - t->at[0][k]) * (t->at[2][j] - t->at[0][j]);
    }
}

static int64_t dot(const int64_t *a, const int64_t *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

typedef struct ratio {
    int64_t of, by; /* by > 0 */
} ratio;

static bool less(ratio a, ratio b)
{
    return a.of * b.by < b.of * a.by;
}

/* What the inside of t has of a plane, along a direction in it: false where that is nothing. */
static bool cut(const triangle *t, const int64_t *plane, int64_t offset, const int64_t *along, ratio *from, ratio *to)
{
    int found = 0;
    for (int i = 0; i < 3; i++) {
        const int64_t *p = t->at[i], *q = t->at[(i + 1) % 3];
        int64_t dp = dot(plane, p) - offset, dq = dot(plane, q) - offset;
        ratio x = {dot(along, p) * dq - dot(along, q) * dp, dq - dp};
        if ((dp <= 0) == (dq <= 0))
            continue;
        if (x.by < 0)
            x = (ratio){-x.of, -x.by};
        *(found ? to : from) = x;
        found++;
    }
    if (found == 2 && less(*to, *from)) {
        ratio x = *from;
        *from = *to, *to = x;
    }
    return found == 2 && less(*from, *to);
}

/* Whether insides meet along a line; in the same plane they do not. A corner on the plane is on its lower side here,
 * which makes an interval of a triangle that only touches with an edge: hence the look at both sides. */
static bool meets(const triangle *a, const triangle *b)
{
    int64_t m[3], n[3], along[3];
    normal(a, m);
    normal(b, n);
    for (int i = 0; i < 3; i++)
        along[i] = m[(i + 1) % 3] * n[(i + 2) % 3] - m[(i + 2) % 3] * n[(i + 1) % 3];
    if (!dot(along, along))
        return false;
    bool sides[4] = {false};
    for (int i = 0; i < 3; i++) {
        int64_t of_a = dot(n, a->at[i]) - dot(n, b->at[0]), of_b = dot(m, b->at[i]) - dot(m, a->at[0]);
        sides[0] |= of_a > 0, sides[1] |= of_a<0, sides[2] |= of_b> 0, sides[3] |= of_b < 0;
    }
    ratio from, to, low, high;
    return sides[0] && sides[1] && sides[2] && sides[3] && cut(a, n, dot(n, b->at[0]), along, &from, &to) &&
           cut(b, m, dot(m, a->at[0]), along, &low, &high) && less(from, high) && less(low, to);
}

static void test_triangles(int64_t lattice, double scale)
{
    int wrong = 0, met = 0;
    const int32_t one[3] = {0, 1, 2}, other[3] = {3, 4, 5};
    for (int i = 0; i < 200000; i++) {
        triangle t[2];
        double position[18];
        for (int c = 0; c < 18; c++) {
            t[c / 9].at[c / 3 % 3][c % 3] = draw(lattice);
            position[c] = scale * (double)t[c / 9].at[c / 3 % 3][c % 3];
        }
        bool want = meets(&t[0], &t[1]);
        met += want;
        wrong += meet_triangles(position, one, other) != want;
        wrong += meet_triangles(position, other, one) != want;
    }
    ok(!wrong && met > 10000, "%d pairs of %lld places a side meet, in units of %g: %d wrong", met, (long long)lattice,
       scale, wrong);
}

/* ---- surfaces */

typedef struct mesh {
    double position[3 * 6 * 200];
    int32_t vertex[3 * 6 * 400];
    int32_t vertices, triangles;
} mesh;

static int32_t place(mesh *m, const double *p)
{
    for (int32_t v = 0; v < m->vertices; v++)
        if (!memcmp(&m->position[3 * v], p, 3 * sizeof *p))
            return v;
    memcpy(&m->position[3 * m->vertices], p, 3 * sizeof *p);
    return m->vertices++;
}

/* A cube from low to high, each of its sides in count x count squares. */
static void add_cube(mesh *m, double low, double high, int count)
{
    for (int s = 0; s < 6 * count * count; s++) {
        int axis = s / count / count % 3, i = s / count % count, j = s % count;
        int32_t v[4];
        for (int c = 0; c < 4; c++) {
            double p[3];
            p[axis] = s < 3 * count * count ? low : high;
            p[(axis + 1) % 3] = low + (high - low) * (i + c % 2) / count;
            p[(axis + 2) % 3] = low + (high - low) * (j + c / 2) / count;
            v[c] = place(m, p);
        }
        const int32_t corner[6] = {v[0], v[1], v[2], v[1], v[3], v[2]};
        memcpy(&m->vertex[3 * m->triangles], corner, sizeof corner);
        m->triangles += 2;
    }
}

static int64_t count(const mesh *m)
{
    int64_t pairs = -1;
    err e = {0};
    double deepest;
    if (meet_count(m->position, m->vertex, m->triangles, 2, &pairs, &deepest, &e))
        ok(false, "%s", e.text);
    return pairs;
}

static void test_cubes(double low, double high, int squares, bool cross, const char *what)
{
    mesh m = {.vertices = 0};
    add_cube(&m, 0, 4, 4);
    ok(count(&m) == 0, "a cube alone");
    add_cube(&m, low, high, squares);
    int64_t pairs = count(&m);
    ok((pairs > 0) == cross, "%s: %lld pairs", what, (long long)pairs);
}

int main(void)
{
    for (int64_t lattice = 3; lattice < 10; lattice += 2) {
        test_triangles(lattice, 1);
        test_triangles(lattice, 0x1p-20);
    }
    test_cubes(2, 6, 1, true, "a cube whose faces run along the other's edges");
    test_cubes(2.5, 6.5, 1, true, "one whose faces run between them");
    test_cubes(-1, 1, 1, true, "one across the other's corner");
    test_cubes(4, 8, 1, false, "one that touches in a corner");
    test_cubes(1, 3, 2, false, "one inside");
    test_cubes(0, 2, 1, false, "one inside, three of whose faces lie in the other's");
    test_cubes(0, 8, 1, false, "one outside, likewise");
    return done_testing();
}
