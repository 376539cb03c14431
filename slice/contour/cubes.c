#include "slice/contour/cubes.h"

#include "base/mem.h"

#include <string.h>

/* The crossings of a face, in the order of its sides, and of each whether one leaves the inside there. */
typedef struct sides {
    int count, edge[4];
    bool leaves[4];
} sides;

static int corner_place(int corner, int axis)
{
    return corner >> axis & 1;
}

static int edge_between(int p, int q)
{
    int axis = (p ^ q) >> 1; /* one bit differs: 1, 2 or 4 */
    return 4 * axis + corner_place(p, (axis + 1) % 3) + 2 * corner_place(p, (axis + 2) % 3);
}

/* A bit a face that the edge lies on. */
static unsigned edge_faces(int edge)
{
    int axis = edge / 4, b = edge % 2, c = edge % 4 / 2;
    return 1U << (2 * ((axis + 1) % 3) + b) | 1U << (2 * ((axis + 2) % 3) + c);
}

void cubes_face(int face, int corner[4])
{
    static const int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    int axis = face / 2, side = face % 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i < 4; i++) {
        const int *at = around[side ? i : (4 - i) % 4];
        corner[i] = side << axis | at[0] << u | at[1] << v;
    }
}

static sides cross(int face, unsigned inside)
{
    sides s = {0};
    int corner[4];
    cubes_face(face, corner);
    for (int i = 0; i < 4; i++) {
        int p = corner[i], q = corner[(i + 1) % 4];
        if ((inside >> p & 1) == (inside >> q & 1))
            continue;
        s.edge[s.count] = edge_between(p, q);
        s.leaves[s.count++] = inside >> p & 1;
    }
    return s;
}

/* On each face, lines from where its sides enter the inside to where they leave it, the inside to
 * their right as seen from outside. Each edge that is crossed is entered on one of its two faces and
 * left on the other, so the lines are loops. */
static void link(unsigned inside, unsigned joined, int next[12])
{
    int ambiguous = 0;
    for (int e = 0; e < 12; e++)
        next[e] = -1;
    for (int face = 0; face < 6; face++) {
        sides s = cross(face, inside);
        bool join = s.count == 4 && joined >> ambiguous++ & 1;
        for (int i = 0; i < s.count; i++) {
            int entered = (i + (join ? 1 : s.count - 1)) % s.count;
            if (s.leaves[i])
                next[s.edge[entered]] = s.edge[i];
        }
    }
}

/* Whether a triangle may have this side: a side of the loop, or a line that is not on a face of the cube, where the
 * next cube could have the same. */
static bool may_cut(const int *loop, int count, int i, int j)
{
    int apart = j - i;
    return apart == 1 || apart == count - 1 || !(edge_faces(loop[i]) & edge_faces(loop[j]));
}

/* Four times the square of the distance between the middles of two edges. */
static int distance(int e, int f)
{
    int sum = 0;
    for (int axis = 0; axis < 3; axis++) {
        int place[2];
        for (int k = 0; k < 2; k++) {
            int edge = k ? f : e, turn = (axis - edge / 4 + 3) % 3;
            const int of_turn[3] = {1, 2 * (edge % 2), 2 * (edge % 4 / 2)};
            place[k] = of_turn[turn];
        }
        sum += (place[0] - place[1]) * (place[0] - place[1]);
    }
    return sum;
}

enum { NEVER = 1 << 20 };

/* The triangulation of a loop whose cuts are allowed and shortest together: apex[i][j] is the third corner of the
 * triangle on i, j. Returns the cost, NEVER where there is none. */
static int plan(const int *loop, int count, int apex[12][12])
{
    int cost[12][12] = {{0}};
    for (int apart = 2; apart < count; apart++)
        for (int i = 0; i + apart < count; i++) {
            int j = i + apart;
            cost[i][j] = NEVER;
            apex[i][j] = i + 1;
            for (int k = i + 1; k < j; k++)
                if (cost[i][k] + cost[k][j] < cost[i][j]) {
                    cost[i][j] = cost[i][k] + cost[k][j];
                    apex[i][j] = k;
                }
            if (!may_cut(loop, count, i, j))
                cost[i][j] = NEVER;
            else if (cost[i][j] < NEVER)
                cost[i][j] += distance(loop[i], loop[j]);
        }
    return cost[0][count - 1];
}

static void add(cubes_case *c, int p, int q, int r)
{
    uint8_t *to = c->vertex + 3 * c->triangles++;
    to[0] = (uint8_t)p;
    to[1] = (uint8_t)q;
    to[2] = (uint8_t)r;
}

static void cut(cubes_case *c, const int *loop, int count)
{
    int apex[12][12] = {{0}}, stack[24], held = 0;
    if (plan(loop, count, apex) >= NEVER) {
        c->rim = (uint8_t)count;
        for (int i = 0; i < count; i++)
            add(c, loop[i], loop[(i + 1) % count], CUBES_CENTRE);
        return;
    }
    stack[held++] = 0;
    stack[held++] = count - 1;
    while (held) {
        int j = stack[--held], i = stack[--held], k = apex[i][j];
        if (j - i < 2)
            continue;
        add(c, loop[i], loop[k], loop[j]);
        stack[held++] = i;
        stack[held++] = k;
        stack[held++] = k;
        stack[held++] = j;
    }
}

static void make_case(cubes_case *c, unsigned inside, unsigned joined)
{
    int next[12], loop[12];
    link(inside, joined, next);
    for (int first = 0; first < 12; first++) {
        int count = 0;
        for (int e = first, then; next[e] >= 0; e = then) {
            then = next[e];
            next[e] = -1;
            loop[count++] = e;
        }
        if (count)
            cut(c, loop, count);
    }
}

cubes *cubes_create(err *e)
{
    cubes *t = mem_array(1, sizeof *t, "the cases of cubes", e);
    unsigned cases = 0;
    for (unsigned inside = 0; t && inside < 256; inside++) {
        unsigned ways = 1;
        t->first[inside] = (uint16_t)cases;
        for (int face = 0; face < 6; face++)
            if (cross(face, inside).count == 4) {
                t->ambiguous[inside] |= (uint8_t)(1U << face);
                ways *= 2;
            }
        for (unsigned joined = 0; joined < ways; joined++)
            make_case(&t->one[cases++], inside, joined);
    }
    return t;
}
