#include "msds/cpu/tissue_walls.h"

#include "base/mem.h"
#include "msds/problem/stable_double.h"

#include <math.h>
#include <stdlib.h>

/* Elements of a cavity have this share of the shear modulus about it: enough for their nodes to go along with walls. */
static const double slack = 1e-6;

/* At no volume they resist with so many shear moduli. */
static const double meeting = 20;

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

void tissue_walls_fill(tissue_mesh *m, const msds_problem *p, const sell *s, const cavity_wall *walls, int64_t count)
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
}

/* The squares of cof F times the gradients of corners, of an element in a lane; corner 0 has the others' sum. */
static void steepness(const tissue_mesh *m, int64_t group, int64_t lane, double to[4])
{
    const bool one = m->shape[group + 1] - m->shape[group] == 9;
    double f[9], cofactors[9], all[3] = {0};
    for (int k = 0; k < 9; k++)
        f[k] = (double)m->g[(9 * group + k) * LANES + lane] + (k % 4 == 0);
    stable_cofactors(f, cofactors);
    for (int c = 1; c < 4; c++) {
        to[c] = 0;
        for (int a = 0; a < 3; a++) {
            double sum = 0;
            for (int b = 0; b < 3; b++) {
                const int64_t at = m->shape[group] + (one ? 3 * c - 3 + b : (3 * c - 3 + b) * LANES + lane);
                sum += cofactors[3 * a + b] * (double)m->gradient[at];
            }
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

/* Of the tissue about each cavity, the harmonic mean of the shear modulus: what is soft about it yields. */
int tissue_walls_moduli(const msds_problem *p, const cavity_wall *walls, int64_t count, double *mu, double *hard,
                        err *e)
{
    int32_t *about = mem_array(p->nodes, sizeof *about, "the solver", e); /* a node's cavity, from 1 */
    double *room = mem_array(p->cavities + 1, sizeof *room, "the solver", e);
    for (int64_t i = 0; about && room && i < count; i++)
        for (int c = 0; c < 3; c++)
            about[walls[i].node[c]] = walls[i].cavity + 1;
    for (int64_t i = 0; about && room && i < 4 * p->elements; i++) {
        const simplex *s = &p->element[i / 4];
        const int32_t of = about[p->element_node[i]] - 1;
        if (of >= 0 && cavity_of(p->cavity, p->cavities, p->volume[i / 4]) < 0) {
            room[of] += s->volume;
            mu[of] += s->volume / s->mu;
        }
    }
    for (int c = 0; about && room && c < p->cavities; c++) {
        const double own = room[c] > 0 ? room[c] / mu[c] : 1;
        mu[c] = slack * own;
        hard[c] = meeting * own / (TISSUE_WALLS_THIN * TISSUE_WALLS_THIN);
    }
    const int failed = !about || !room;
    free(about);
    free(room);
    return failed ? -1 : 0;
}
