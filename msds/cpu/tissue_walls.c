#include "msds/cpu/tissue_walls.h"

#include "base/mem.h"
#include "msds/cpu/lanes.h"
#include "msds/problem/stable_double.h"

#include <math.h>
#include <stdlib.h>

/* Elements of a cavity have this share of the shear modulus about it: enough for their nodes to go along with walls. */
static const double slack = 1e-2;

/* Where walls meet: so many shear moduli resist (stable_meeting in stable.h). */
static const double meeting = .4;

/* What a step leaves of an element's volume at least, and how much of it is taken in any case. */
static const double left_most = .4, share_least = .02;

enum { TURNS = 6 }; /* over the elements: what one leaves its nodes changes its neighbours */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* t1, t2, a, b, h of a triangle, and its area. */
static double measure(const msds_problem *p, const int32_t node[3], double to[9])
{
    double edge[2][3];
    for (int k = 0; k < 2; k++)
        for (int a = 0; a < 3; a++)
            edge[k][a] = p->position[3 * (int64_t)node[k + 1] + a] - p->position[3 * (int64_t)node[0] + a];
    to[6] = sqrt(dot(edge[0], edge[0]));
    for (int a = 0; a < 3; a++)
        to[a] = edge[0][a] / to[6];
    to[7] = dot(edge[1], to);
    for (int a = 0; a < 3; a++)
        to[3 + a] = edge[1][a] - to[7] * to[a];
    to[8] = sqrt(dot(to + 3, to + 3));
    for (int a = 0; a < 3; a++)
        to[3 + a] /= to[8];
    return to[6] * to[8] / 2;
}

static int find_within(tissue_mesh *m, const sell *s, const cavity_wall *walls, int64_t count, err *e)
{
    uint8_t *on = mem_array(s->nodes, 1, "the solver", e);
    for (int64_t i = 0; on && i < count; i++)
        for (int c = 0; c < 3; c++)
            on[s->own_node[walls[i].node[c]]] = 1;
    for (int64_t i = 0; on && i < 4 * (m->walls - m->lumens) * LANES; i++)
        m->within[i] = on[m->node[4 * m->lumens * LANES + i]] ? 0 : 1;
    const int failed = !on;
    free(on);
    return failed ? -1 : 0;
}

int tissue_walls_fill(tissue_mesh *m, const msds_problem *p, const sell *s, const cavity_wall *walls, int64_t count,
                      err *e)
{
    for (int64_t i = 0; i < (m->groups - m->walls) * LANES; i++) {
        const int64_t group = m->walls + i / LANES, lane = i % LANES;
        const cavity_wall *w = &walls[i < count ? i : count - 1]; /* lanes that are empty have no area */
        double numbers[9];
        const double area = measure(p, w->node, numbers);
        for (int c = 0; c < 4; c++) {
            m->node[(4 * group + c) * LANES + lane] = s->own_node[w->node[c % 3]];
            m->point[(4 * group + c) * LANES + lane] = m->cavity_point + w->cavity;
            m->first[4 * group + c] = SELL_SCATTERED;
        }
        for (int k = 0; k < 9; k++)
            m->gradient[m->shape[group] + k * LANES + lane] = (float)numbers[k];
        if (i < count) {
            m->volume[group * LANES + lane] = (float)area;
            m->mu[group * LANES + lane] = (float)p->cavity[w->cavity].wall;
        }
    }
    return find_within(m, s, walls, count, e);
}

static double gradient_at(const tissue_mesh *m, int64_t group, int64_t lane, int k)
{
    const bool one = m->shape[group + 1] - m->shape[group] == 9;
    return (double)m->gradient[m->shape[group] + (one ? k : k * LANES + lane)];
}

static double swollen(const double g[9])
{
    double cofactors[9];
    stable_cofactors(g, cofactors);
    return stable_swelling(g, cofactors);
}

/* How much an element of a cavity may take of a step that its nodes take shares of: 1, or less where it would lose too
 * much of its volume. */
static double share_of(const tissue_mesh *m, int64_t group, int64_t lane, const lanes_field *step, const float *share)
{
    const int32_t *node = m->node + 4 * group * LANES + lane;
    double g[9], to[9];
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            double sum = 0;
            const double first = (double)step->x[a][node[0]] * (double)share[node[0]];
            for (int c = 0; c < 3; c++) {
                const int32_t n = node[(c + 1) * LANES];
                sum += ((double)step->x[a][n] * (double)share[n] - first) * gradient_at(m, group, lane, 3 * c + b);
            }
            g[3 * a + b] = (double)m->g[(9 * group + 3 * a + b) * LANES + lane];
            to[3 * a + b] = g[3 * a + b] + sum;
        }
    const double from = 1 + swollen(g), end = 1 + swollen(to);
    if (!(from > 0) || end >= left_most * from)
        return 1;
    return fmax((1 - left_most) * from / (from - end), share_least);
}

/* Lessens shares where elements lose too much; tells whether there was any. */
static bool lessen(const tissue_mesh *m, const lanes_field *step, float *share)
{
    bool any = false;
    for (int64_t i = m->lumens * LANES; i < m->walls * LANES; i++) {
        const int64_t group = i / LANES, lane = i % LANES;
        const double own = m->volume[i] > 0 ? share_of(m, group, lane, step, share) : 1;
        for (int c = 0; c < 4 && own < 1; c++)
            share[m->node[(4 * group + c) * LANES + lane]] *= (float)own;
        any = any || own < 1;
    }
    return any;
}

double tissue_walls_spare(const tissue_mesh *m, lanes_field *step, float *share)
{
    double least = 1;
    for (int64_t i = 4 * m->lumens * LANES; i < 4 * m->walls * LANES; i++)
        share[m->node[i]] = 1;
    for (int turn = 0; turn < TURNS && lessen(m, step, share);)
        turn++;
    for (int64_t i = 4 * m->lumens * LANES; i < 4 * m->walls * LANES; i++) {
        const int32_t node = m->node[i];
        least = fmin(least, (double)share[node]);
        for (int a = 0; a < 3; a++)
            step->x[a][node] *= share[node];
        share[node] = 1;
    }
    return least;
}

/* The squares of cof F times the gradients of corners, of an element in a lane; corner 0 has the others' sum. */
static void steepness(const tissue_mesh *m, int64_t group, int64_t lane, double to[4])
{
    double f[9], cofactors[9], all[3] = {0};
    for (int k = 0; k < 9; k++)
        f[k] = (double)m->g[(9 * group + k) * LANES + lane] + (k % 4 == 0);
    stable_cofactors(f, cofactors);
    for (int c = 1; c < 4; c++) {
        to[c] = 0;
        for (int a = 0; a < 3; a++) {
            double sum = 0;
            for (int b = 0; b < 3; b++)
                sum += cofactors[3 * a + b] * gradient_at(m, group, lane, 3 * c - 3 + b);
            all[a] += sum;
            to[c] += sum * sum;
        }
    }
    to[0] = dot(all, all);
}

void tissue_walls_brace(tissue_mesh *m)
{
    for (int64_t i = 4 * m->lumens * LANES; i < 4 * m->walls * LANES; i++)
        m->inverse[m->node[i]] = m->at_rest[m->node[i]];
    for (int64_t i = m->lumens * LANES; i < m->walls * LANES; i++) {
        const int64_t group = i / LANES, lane = i % LANES;
        const double stiff = (double)m->volume[i] * (double)m->law[(STABLE_NUMBERS * group + 3) * LANES + lane];
        double steep[4];
        if (!(stiff > 0))
            continue;
        steepness(m, group, lane, steep);
        for (int c = 0; c < 4; c++) {
            float *inverse = &m->inverse[m->node[(4 * group + c) * LANES + lane]];
            if (*inverse > 0)
                *inverse = (float)(1 / (1 / (double)*inverse + stiff * steep[c]));
        }
    }
}

/* Of the tissue about each cavity, the harmonic mean of the shear modulus: what is soft about it yields. Of all tissue
 * where nodes of its walls are those of another, too. */
int tissue_walls_moduli(const msds_problem *p, const cavity_wall *walls, int64_t count, double *mu, double *hard,
                        err *e)
{
    int32_t *about = mem_array(p->nodes, sizeof *about, "the solver", e); /* a node's cavity, from 1 */
    double *room = mem_array(p->cavities + 1, sizeof *room, "the solver", e), all = 0, softness = 0;
    for (int64_t i = 0; about && room && i < count; i++)
        for (int c = 0; c < 3; c++)
            about[walls[i].node[c]] = walls[i].cavity + 1;
    for (int64_t i = 0; about && room && i < 4 * p->elements; i++) {
        const simplex *s = &p->element[i / 4];
        const int32_t of = about[p->element_node[i]] - 1;
        if (cavity_of(p->cavity, p->cavities, p->volume[i / 4]) >= 0)
            continue;
        all += s->volume;
        softness += s->volume / s->mu;
        if (of >= 0) {
            room[of] += s->volume;
            mu[of] += s->volume / s->mu;
        }
    }
    for (int c = 0; about && room && c < p->cavities; c++) {
        const double own = room[c] > 0 ? room[c] / mu[c] : all / softness;
        mu[c] = slack * own;
        hard[c] = meeting * own;
    }
    const int failed = !about || !room;
    free(about);
    free(room);
    return failed ? -1 : 0;
}
