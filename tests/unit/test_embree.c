/* Spheres along packets of rays: each ray meets the nearest there is, from outside and within, within its bounds, as a
 * search of all says; and a ray that is not asked for stays as it was. */
#include "surface/embree.h"

#include "tap.h"

#include <math.h>
#include <stdlib.h>

enum { SPHERES = 300, PACKETS = 200 };

static float uniform(double low, double high)
{
    return (float)(low + (high - low) * rand() / (double)RAND_MAX);
}

/* The nearest of all spheres along a ray in doubles, INFINITY: none; near: some other choice is within rounding. */
static double search(const float (*sphere)[4], const embree_packet *p, int ray, uint32_t *item, bool *near)
{
    double least = INFINITY, from = (double)p->start[ray], to = (double)p->end[ray];
    *near = false;
    for (uint32_t s = 0; s < SPHERES; s++) {
        double aa = 0, ac = 0, cc = 0;
        for (int k = 0; k < 3; k++) {
            double a = (double)p->along[k][ray], c = (double)sphere[s][k] - (double)p->from[k][ray];
            aa += a * a, ac += a * c, cc += c * c;
        }
        double r = (double)sphere[s][3], half = ac * ac - aa * (cc - r * r);
        *near |= fabs(half) < 1e-4 * aa;
        for (int end = -1; end <= 1 && half >= 0; end += 2) {
            double t = (ac + end * sqrt(half)) / aa;
            *near |= fabs(t - from) < 1e-4 || fabs(t - to) < 1e-4 || fabs(t - least) < 1e-4;
            if (t < from || t > to || t >= least)
                continue;
            least = t;
            *item = s;
        }
    }
    return least;
}

static void fill(embree_packet *p, unsigned packet)
{
    embree_packet_clear(p);
    for (int i = 0; i < EMBREE_RAYS; i++) {
        for (int k = 0; k < 3; k++) {
            p->from[k][i] = uniform(-1, 1);
            p->along[k][i] = uniform(-1, 1) + (packet % 2 && !k ? 4 : 0);
        }
        p->start[i] = packet % 3 ? 0 : uniform(0, .5);
        p->end[i] = packet % 5 ? INFINITY : uniform(.5, 1);
    }
}

typedef struct wrong {
    int end, item, normal, blocked, unasked, met, missed;
} wrong;

static void check_ray(const float (*sphere)[4], const embree_packet *before, const embree_packet *after,
                      const embree_packet *blocked, int i, wrong *w)
{
    uint32_t item = EMBREE_NONE;
    bool near;
    double at = search(sphere, before, i, &item, &near), dot = 0, square = 0;
    if (near)
        return;
    w->blocked += (blocked->end[i] == -INFINITY) != (item != EMBREE_NONE);
    w->item += (after->geometry[i] == EMBREE_NONE ? EMBREE_NONE : after->item[i]) != item;
    if (item == EMBREE_NONE) {
        w->missed++;
        return;
    }
    w->met++;
    w->end += !(fabs((double)after->end[i] - at) < 1e-5 * (1 + at));
    for (int k = 0; k < 3; k++) {
        double out = (double)before->from[k][i] + at * (double)before->along[k][i] - (double)sphere[item][k];
        dot += out * (double)after->normal[k][i];
        square += (double)after->normal[k][i] * (double)after->normal[k][i];
    }
    w->normal += !(fabs(dot / ((double)sphere[item][3] * sqrt(square)) - 1) < 1e-3);
}

static void check_packet(const embree *tree, const float (*sphere)[4], unsigned packet, wrong *w)
{
    embree_packet p, nearest, blocked;
    unsigned valid = packet % 4 ? (1u << EMBREE_RAYS) - 1 : (unsigned)rand() & ((1u << EMBREE_RAYS) - 1);
    fill(&p, packet);
    nearest = blocked = p;
    embree_nearest(tree, valid, &nearest, packet % 2);
    embree_blocked(tree, valid, &blocked, packet % 2);
    for (int i = 0; i < EMBREE_RAYS; i++)
        if (valid >> i & 1)
            check_ray(sphere, &p, &nearest, &blocked, i, w);
        else
            w->unasked +=
                nearest.geometry[i] != EMBREE_NONE || nearest.end[i] != p.end[i] || blocked.end[i] != p.end[i];
}

int main(void)
{
    err e = {0};
    float sphere[SPHERES][4];
    srand(7);
    for (int s = 0; s < SPHERES; s++) {
        for (int k = 0; k < 3; k++)
            sphere[s][k] = uniform(-1, 1);
        sphere[s][3] = s ? uniform(.02, .08) : .3f;
    }
    embree *tree = embree_create(1, &e);
    bool made = tree && !embree_add_spheres(tree, SPHERES, sphere[0], &e) && !embree_commit(tree, &e);
    ok(made, "a tree of spheres: %s", e.text);
    wrong w = {0};
    for (unsigned k = 0; k < PACKETS && made; k++)
        check_packet(tree, (const float(*)[4])sphere, k, &w);
    ok(w.met > 500 && w.missed > 500, "rays meet spheres and miss them: %d and %d", w.met, w.missed);
    ok(!w.item, "the nearest sphere is met: %d are wrong", w.item);
    ok(!w.end, "where it is: %d are wrong", w.end);
    ok(!w.normal, "with its normal outward: %d are wrong", w.normal);
    ok(!w.blocked, "and is in the way: %d are wrong", w.blocked);
    ok(!w.unasked, "other rays stay as they were: %d are wrong", w.unasked);
    embree_destroy(tree);
    return done_testing();
}
