// needs: voxelise/sight.c voxelise/cuts.c voxelise/inside.c voxelise/surfaces/crossing.c
// needs: voxelise/surfaces/expansion.c voxelise/surfaces/grid.c
/* Lines between samples, and cuts between neighbours, about two blocks that touch and a slit of any width: against
 * what is plain to see.
 */
#include "tap.h"

#include "base/pool.h"
#include "voxelise/cuts.h"
#include "voxelise/sight.h"

#include <string.h>

enum { SIDE = 8 }; /* samples */

typedef struct scene {
    double position[32][3];
    int32_t vertex[48][3], volume[48];
    int64_t vertices, triangles;
} scene;

/* A box, whose sides are cut one way or the other. */
static void add_box(scene *s, const double *low, const double *high, int32_t volume, bool other)
{
    static const int8_t side[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    const int32_t first = (int32_t)s->vertices;
    for (int c = 0; c < 8; c++, s->vertices++)
        for (int a = 0; a < 3; a++)
            s->position[s->vertices][a] = c >> a & 1 ? high[a] : low[a];
    for (int f = 0; f < 6; f++)
        for (int t = 0; t < 2; t++, s->triangles++) {
            s->volume[s->triangles] = volume;
            for (int i = 0; i < 3; i++)
                s->vertex[s->triangles][i] = first + side[f][(2 * t + i + other) % 4];
        }
}

static inside_triangles triangles_of(const scene *s)
{
    return (inside_triangles){s->position[0], s->vertices, s->vertex[0], s->volume, s->triangles};
}

static grid samples(void)
{
    return (grid){.spacing = {1, 1, 1}, .high = {SIDE, SIDE, SIDE}};
}

/* Two boxes that face each other at x = 4, `gap` apart. */
static void two(scene *s, double gap, int32_t volume, bool other)
{
    memset(s, 0, sizeof *s);
    add_box(s, (double[]){0, 0, 0}, (double[]){4 - gap / 2, SIDE, SIDE}, 0, false);
    add_box(s, (double[]){4 + gap / 2, 0, 0}, (double[]){SIDE, SIDE, SIDE}, volume, other);
}

static void count_cuts(void)
{
    static const double gap[] = {0, 1e-12, .2, .9};
    err e = {0};
    pool *p = pool_create(2, &e);
    grid g = samples();
    for (int i = 0; i < 8; i++) {
        scene s;
        cuts c;
        two(&s, gap[i % 4], 0, i > 3);
        inside_triangles t = triangles_of(&s);
        const int status = cuts_find(&c, &t, &g, 1, p, &e);
        bool all = !status && c.count == SIDE * SIDE;
        for (int64_t n = 0; all && n < c.count; n++)
            all = c.cut[n].axis == 0 && c.cut[n].cell[0] == 3;
        ok(all, "a gap of %g: each line across it is cut, and no other %s", gap[i % 4], e.text);
        cuts_free(&c);
        two(&s, gap[i % 4], 1, i > 3);
        t = triangles_of(&s);
        ok(!cuts_find(&c, &t, &g, 1, p, &e) && c.count == (i % 4 < 2 ? 0 : SIDE * SIDE),
           "between two volumes: they touch, or are apart %s", e.text);
        cuts_free(&c);
    }
    pool_destroy(p);
}

static void look(void)
{
    err e = {0};
    grid g = samples();
    static const double gap[] = {0, .2, .9};
    static const int64_t far[][3] = {{4, 3, 3}, {4, 4, 3}, {4, 2, 4}, {5, 3, 3}, {7, 7, 7}, {4, 0, 0}};
    for (int i = 0; i < 6; i++) {
        scene s;
        two(&s, gap[i % 3], 0, i > 2);
        const inside_triangles t = triangles_of(&s);
        sight *v = sight_create(&t, &g, 1, &e);
        bool across = v != NULL, within = v != NULL;
        for (int n = 0; v && n < 6; n++) {
            across = across && sight_blocked(v, (int64_t[]){3, 3, 3}, far[n]) &&
                     sight_blocked(v, far[n], (int64_t[]){3, 3, 3});
            within = within && !sight_blocked(v, (int64_t[]){4, 4, 4}, (int64_t[]){far[n][0], far[n][1], far[n][2]});
        }
        ok(across, "a gap of %g hides what is across it, both ways", gap[i % 3]);
        ok(within, "and nothing on the same side");
        sight_destroy(v);
    }
}

/* A post of bone that stands between two samples does not part them: a way leads round it. */
static void go_round(void)
{
    err e = {0};
    grid g = samples();
    scene s = {.vertices = 0};
    add_box(&s, (double[]){0, 0, 0}, (double[]){SIDE, SIDE, SIDE}, 0, false);
    add_box(&s, (double[]){3.9, 3.9, 1}, (double[]){4.1, 4.1, 7}, 0, false);
    const inside_triangles t = triangles_of(&s);
    sight *v = sight_create(&t, &g, 1, &e);
    ok(v && !sight_blocked(v, (int64_t[]){3, 3, 3}, (int64_t[]){4, 4, 3}), "about a post in the way there is a way");
    sight_destroy(v);
}

int main(void)
{
    count_cuts();
    look();
    go_round();
    return done_testing();
}
