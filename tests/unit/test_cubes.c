// needs: slice/contour/cubes.c
/* The cases of marching cubes: each face is cut as that face alone says, every line on a face is a side of one
 * triangle, every line within the cube of two, and none of these lies on a face.
 */
#include "slice/contour/cubes.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

static unsigned faces_of(int edge)
{
    int axis = edge / 4, b = edge % 2, c = edge % 4 / 2;
    return 1U << (2 * ((axis + 1) % 3) + b) | 1U << (2 * ((axis + 2) % 3) + c);
}

/* Whether an edge's ends differ. */
static bool crossed(int edge, unsigned inside)
{
    int axis = edge / 4, b = edge % 2, c = edge % 4 / 2;
    int low = b << ((axis + 1) % 3) | c << ((axis + 2) % 3), high = low | 1 << axis;
    return (inside >> low & 1) != (inside >> high & 1);
}

/* How often the triangles run along p, q. */
static int runs(const cubes_case *k, int p, int q)
{
    int count = 0;
    for (int t = 0; t < k->triangles; t++)
        for (int i = 0; i < 3; i++)
            count += k->vertex[3 * t + i] == p && k->vertex[3 * t + (i + 1) % 3] == q;
    return count;
}

/* Of a face's lines: as many as half of its crossings; with joined corners, each line is about an outside corner. */
static int face_lines(const cubes_case *k, int face)
{
    int count = 0;
    for (int p = 0; p < 12; p++)
        for (int q = 0; q < 12; q++)
            if (p != q && (faces_of(p) & faces_of(q) & 1U << face))
                count += runs(k, p, q);
    return count;
}

static int face_crossings(unsigned inside, int face)
{
    int count = 0;
    for (int e = 0; e < 12; e++)
        count += (faces_of(e) >> face & 1) && crossed(e, inside);
    return count;
}

static bool case_is_good(const cubes_case *k, unsigned inside)
{
    for (int face = 0; face < 6; face++)
        if (2 * face_lines(k, face) != face_crossings(inside, face))
            return false;
    for (int p = 0; p <= CUBES_CENTRE; p++)
        for (int q = 0; q < p; q++) {
            int there = runs(k, p, q), back = runs(k, q, p);
            bool on_face = p < CUBES_CENTRE && (faces_of(p) & faces_of(q));
            if (on_face ? there + back > 1 : there != back || there > 1)
                return false;
        }
    for (int i = 0; i < 3 * k->triangles; i++)
        if (k->vertex[i] > CUBES_CENTRE || (k->vertex[i] < CUBES_CENTRE && !crossed(k->vertex[i], inside)))
            return false;
    return k->triangles <= CUBES_TRIANGLES;
}

/* A line on a face says by itself which of the ambiguous cases it is: it cuts off
 * the corner that both its edges touch. */
static bool ambiguity_is_right(const cubes *t, unsigned inside, unsigned joined)
{
    const cubes_case *k = cubes_of(t, inside, joined);
    int bit = 0;
    for (int face = 0; face < 6; face++) {
        if (!(t->ambiguous[inside] >> face & 1))
            continue;
        bool join = joined >> bit++ & 1;
        int corner[4];
        cubes_face(face, corner);
        for (int i = 0; i < 4; i++) {
            int before = corner[(i + 3) % 4], after = corner[(i + 1) % 4], here = corner[i], found = 0;
            for (int p = 0; p < 12; p++)
                for (int q = 0; q < 12; q++) {
                    int lp = (p % 4 % 2) << ((p / 4 + 1) % 3) | (p % 4 / 2) << ((p / 4 + 2) % 3), hp = lp | 1 << p / 4;
                    int lq = (q % 4 % 2) << ((q / 4 + 1) % 3) | (q % 4 / 2) << ((q / 4 + 2) % 3), hq = lq | 1 << q / 4;
                    bool first = (lp == before && hp == here) || (lp == here && hp == before);
                    bool second = (lq == after && hq == here) || (lq == here && hq == after);
                    if (first && second)
                        found += runs(k, p, q) + runs(k, q, p);
                }
            if (found != ((inside >> here & 1) != (unsigned)join))
                return false;
        }
    }
    return true;
}

int main(void)
{
    err e = {0};
    cubes *t = cubes_create(&e);
    int good = 0, right = 0, cases = 0, rims = 0;
    ok(t != NULL, "the table is made");
    for (unsigned inside = 0; t && inside < 256; inside++) {
        unsigned ways = 1U << __builtin_popcount(t->ambiguous[inside]);
        for (unsigned joined = 0; joined < ways; joined++, cases++) {
            good += case_is_good(cubes_of(t, inside, joined), inside);
            right += ambiguity_is_right(t, inside, joined);
            rims += cubes_of(t, inside, joined)->rim > 0;
        }
    }
    ok(cases == CUBES_CASES, "%d cases, of %d", cases, CUBES_CASES);
    ok(good == cases, "faces and lines are right in %d of %d", good, cases);
    ok(right == cases, "ambiguous faces are joined or not as asked in %d of %d", right, cases);
    ok(rims == 116, "%d cases have no triangulation without a line on a face, and get a vertex amid the cube", rims);
    free(t);
    return done_testing();
}
