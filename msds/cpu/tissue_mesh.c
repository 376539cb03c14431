#include "msds/cpu/tissue_mesh.h"

#include "base/mem.h"
#include "msds/cpu/tissue_walls.h"
#include "msds/problem/stable_double.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    ROW_LEAST = 5 /* lanes that a group in a row has at least: the others stay empty */
};

/* Elements keep so much of the law's kappa, in mu of linear elasticity: what they have at Poisson's ratio .3. What is
 * above that acts on the mean of J about points. */
static const double kept = 7. / 3;

/* Points have a bulk modulus of at most so many mu of linear elasticity at once; the rest of a higher one comes by the
 * pressure that is held. */
static const double at_once = 20;

/* An element on its way to a group. */
typedef struct placed {
    int32_t node[4]; /* in the solver's order; the first is the least */
    int32_t corner[4];
    int32_t element, cavity; /* -1: tissue */
} placed;

typedef struct maker {
    tissue_mesh *m;
    const msds_problem *p;
    const sell *s;
    placed *list;     /* elements */
    int32_t *at;      /* groups x LANES: which of the list, or -1 */
    int32_t *point;   /* elements x 4 */
    int64_t points;   /* that have elements */
    double *own_bulk; /* points: kappa times volume */
    double *own_mu;   /* points: mu of linear elasticity times volume */
    double *room;     /* points: m3 */
    cavity_wall *wall;
    int64_t walls;     /* triangles */
    double *mu, *hard; /* cavities: of their elements (tissue_walls.h) */
    err *e;
} maker;

static int by_shape(const void *a, const void *b)
{
    const placed *x = a, *y = b;
    if ((x->cavity < 0) != (y->cavity < 0))
        return x->cavity < 0 ? -1 : 1;
    for (int c = 1; c < 4; c++) {
        const int32_t p = x->node[c] - x->node[0], q = y->node[c] - y->node[0];
        if (p != q)
            return p < q ? -1 : 1;
    }
    if (x->node[0] != y->node[0])
        return x->node[0] < y->node[0] ? -1 : 1;
    return (x->element > y->element) - (x->element < y->element);
}

/* Elements of cavities come last. Corners ascend, so that elements of one shape look alike. */
static void place(const maker *k, int64_t t, placed *to)
{
    to->element = (int32_t)t;
    to->cavity = cavity_of(k->p->cavity, k->p->cavities, k->p->volume[t]);
    for (int c = 0; c < 4; c++) {
        const int32_t own = k->s->own_node[k->p->element_node[4 * t + c]];
        int at = c;
        for (; at > 0 && to->node[at - 1] > own; at--) {
            to->node[at] = to->node[at - 1];
            to->corner[at] = to->corner[at - 1];
        }
        to->node[at] = own;
        to->corner[at] = c;
    }
}

/* Whether element `next` of the list stands one node further than the one before. */
static bool follows(const maker *k, int64_t next)
{
    const placed *x = &k->list[next - 1], *y = &k->list[next];
    for (int c = 0; c < 4; c++)
        if (y->node[c] != x->node[c] + 1)
            return false;
    return true;
}

static int64_t run_from(const maker *k, int64_t at, int64_t end)
{
    int64_t count = 1;
    while (count < LANES && at + count < end && follows(k, at + count))
        count++;
    return count;
}

/* Lanes that groups of elements have at most: each in a row is filled by ROW_LEAST at least, and all others but one of
 * tissue and one of cavities are full. */
static int64_t lanes_most(const maker *k)
{
    return 2 * k->p->elements + 2 * LANES;
}

static int64_t groups_of(int64_t lanes)
{
    return (lanes + LANES - 1) / LANES;
}

/* Elements of the list, from `group` on: groups in a row first, in the order of the list, then what is left over.
 * Returns the group after them. */
static int64_t group_range(maker *k, int64_t group, int64_t from, int64_t to)
{
    int64_t rows = group, filled = 0;
    for (int64_t i = from, count; i < to; i += count) {
        count = run_from(k, i, to);
        for (int64_t l = 0; l < count && count >= ROW_LEAST; l++)
            k->at[rows * LANES + l] = (int32_t)(i + l);
        rows += count >= ROW_LEAST;
    }
    for (int64_t i = from, count; i < to; i += count) {
        count = run_from(k, i, to);
        for (int64_t l = 0; l < count && count < ROW_LEAST; l++)
            k->at[rows * LANES + filled++] = (int32_t)(i + l);
    }
    const int64_t end = rows + groups_of(filled);
    for (int64_t g = 4 * group; g < 4 * end; g++)
        k->m->first[g] = g / 4 < rows ? k->list[k->at[g / 4 * LANES]].node[g % 4] : SELL_SCATTERED;
    return end;
}

/* Of tissue, of cavities, and of walls (tissue_mesh.h). */
static void group(maker *k)
{
    int64_t tissue = 0;
    while (tissue < k->p->elements && k->list[tissue].cavity < 0)
        tissue++;
    for (int64_t i = 0; i < (groups_of(lanes_most(k)) + groups_of(k->walls)) * LANES; i++)
        k->at[i] = -1;
    k->m->lumens = group_range(k, 0, 0, tissue);
    k->m->walls = group_range(k, k->m->lumens, tissue, k->p->elements);
    k->m->groups = k->m->walls + groups_of(k->walls);
}

static int make_walls(maker *k)
{
    const msds_problem *p = k->p;
    if (!p->cavities)
        return 0;
    k->walls = cavity_walls(p->cavity, p->cavities, p->element_node, p->volume, p->elements, &k->wall, k->e);
    k->mu = mem_array(p->cavities, sizeof *k->mu, "the solver", k->e);
    k->hard = mem_array(p->cavities, sizeof *k->hard, "the solver", k->e);
    return k->walls < 0 || !k->mu || !k->hard || tissue_walls_moduli(p, k->wall, k->walls, k->mu, k->hard, k->e) ? -1
                                                                                                                 : 0;
}

static int make_groups(maker *k)
{
    const int64_t elements = k->p->elements, most = groups_of(lanes_most(k)) + groups_of(k->walls);
    k->list = mem_array(elements, sizeof *k->list, "the solver", k->e);
    k->at = mem_array(most * LANES, sizeof *k->at, "the solver", k->e);
    k->m->first = mem_array(4 * most, sizeof *k->m->first, "the solver", k->e);
    if (!k->list || !k->at || !k->m->first)
        return -1;
    for (int64_t t = 0; t < elements; t++)
        place(k, t, &k->list[t]);
    qsort(k->list, (size_t)elements, sizeof *k->list, by_shape);
    group(k);
    return 0;
}

/* ---- points of pressure */

typedef struct corner {
    int32_t node, volume, at; /* node: in the solver's order; at: element * 4 + corner */
} corner;

static int by_point(const void *a, const void *b)
{
    const corner *x = a, *y = b;
    if (x->node != y->node)
        return x->node < y->node ? -1 : 1;
    if (x->volume != y->volume)
        return x->volume < y->volume ? -1 : 1;
    return (x->at > y->at) - (x->at < y->at);
}

static double kappa_of(const simplex *s)
{
    return STABLE_KAPPA(s->lambda, s->mu);
}

static double kept_of(const simplex *s)
{
    return fmin(kappa_of(s), kept * s->mu);
}

static void add_to_point(maker *k, int32_t point, int64_t t)
{
    const simplex *s = &k->p->element[t];
    k->own_bulk[point] += s->volume / 4 * (kappa_of(s) - kept_of(s));
    k->own_mu[point] += s->volume / 4 * s->mu;
    k->room[point] += s->volume / 4;
}

/* Of tissue; cavities have theirs after these. */
static int number_points(maker *k, corner *list)
{
    int64_t corners = 0;
    for (int64_t i = 0; i < 4 * k->p->elements; i++)
        if (cavity_of(k->p->cavity, k->p->cavities, k->p->volume[i / 4]) < 0)
            list[corners++] = (corner){k->s->own_node[k->p->element_node[i]], k->p->volume[i / 4], (int32_t)i};
    qsort(list, (size_t)corners, sizeof *list, by_point);
    k->points = 0;
    for (int64_t i = 0; i < corners; i++) {
        k->points += !i || list[i].node != list[i - 1].node || list[i].volume != list[i - 1].volume;
        k->point[list[i].at] = (int32_t)(k->points - 1);
    }
    k->own_bulk = mem_array(k->points + 1, sizeof *k->own_bulk, "the solver", k->e);
    k->own_mu = k->own_bulk ? mem_array(k->points + 1, sizeof *k->own_mu, "the solver", k->e) : NULL;
    k->room = k->own_mu ? mem_array(k->points + 1, sizeof *k->room, "the solver", k->e) : NULL;
    for (int64_t i = 0; k->room && i < corners; i++)
        add_to_point(k, k->point[list[i].at], list[i].at / 4);
    return k->room ? 0 : -1;
}

static bool needs_points(const msds_problem *p)
{
    for (int64_t t = 0; t < p->elements; t++)
        if (kappa_of(&p->element[t]) > kept_of(&p->element[t]))
            return true;
    return p->cavities > 0;
}

static int make_points(maker *k)
{
    tissue_mesh *m = k->m;
    if (!needs_points(k->p))
        return 0;
    corner *list = mem_array(4 * k->p->elements, sizeof *list, "the solver", k->e);
    k->point = list ? mem_array(4 * k->p->elements, sizeof *k->point, "the solver", k->e) : NULL;
    const int failed = !k->point || number_points(k, list);
    free(list);
    if (failed)
        return -1;
    m->cavity_point = (int32_t)k->points;
    m->points = groups_of(k->points + k->p->cavities) * LANES;
    m->bulk = mem_array(m->points, sizeof *m->bulk, "the solver", k->e);
    m->pressure = mem_array(m->points, sizeof *m->pressure, "the solver", k->e);
    m->pressed = mem_array(m->points, sizeof *m->pressed, "the solver", k->e);
    m->keep = mem_array(m->points, sizeof *m->keep, "the solver", k->e);
    m->held = mem_array(m->points, sizeof *m->held, "the solver", k->e);
    if (!m->bulk || !m->pressure || !m->pressed || !m->keep || !m->held)
        return -1;
    for (int64_t i = 0; i < k->points; i++) {
        const double now = fmin(k->own_bulk[i], at_once * k->own_mu[i]);
        m->bulk[i] = (float)(now / (k->room[i] * k->room[i]));
        m->keep[i] = k->own_bulk[i] > 0 ? (float)(1 - now / k->own_bulk[i]) : 0;
    }
    return 0;
}

/* ---- groups' numbers */

static void fill_lane(const maker *k, int64_t g, int lane, const placed *from)
{
    tissue_mesh *m = k->m;
    const simplex *s = &k->p->element[from->element];
    for (int c = 0; c < 4; c++) {
        m->node[(4 * g + c) * LANES + lane] = from->node[c];
        if (m->points && from->cavity < 0)
            m->point[(4 * g + c) * LANES + lane] = k->point[4 * (int64_t)from->element + from->corner[c]];
    }
    m->volume[g * LANES + lane] = (float)s->volume;
    m->mu[g * LANES + lane] = (float)STABLE_MU(from->cavity < 0 ? s->mu : k->mu[from->cavity]);
    m->kappa[g * LANES + lane] = (float)(from->cavity < 0 ? kept_of(s) : k->hard[from->cavity]);
}

/* The gradients of corners 1 to 3 of a group's elements: 0 where a lane is empty. */
static void gradients_of(const maker *k, int64_t group, double to[9 * LANES])
{
    memset(to, 0, 9 * LANES * sizeof *to);
    for (int l = 0; l < LANES; l++) {
        const placed *from = k->at[group * LANES + l] >= 0 ? &k->list[k->at[group * LANES + l]] : NULL;
        for (int c = 0; from && c < 3; c++)
            for (int b = 0; b < 3; b++)
                to[(3 * c + b) * LANES + l] = k->p->element[from->element].gradient[from->corner[c + 1]][b];
    }
}

/* Tells whether the elements of a group are of one shape, to rounding. Empty lanes have no volume, so any shape will
 * do. */
static bool is_one_shape(const maker *k, int64_t group, const double q[9 * LANES])
{
    double size = 0, off = 0;
    for (int i = 0; i < 9 * LANES; i++) {
        size = fmax(size, fabs(q[i]));
        if (k->at[group * LANES + i % LANES] >= 0)
            off = fmax(off, fabs(q[i] - q[i / LANES * LANES]));
    }
    return k->at[group * LANES] >= 0 && off <= 1e-9 * size;
}

static int fill_gradients(const maker *k)
{
    tissue_mesh *m = k->m;
    int64_t room = 0;
    m->shape = mem_array(m->groups + 1, sizeof *m->shape, "the solver", k->e);
    for (int64_t g = 0; m->shape && g < m->groups; g++) {
        double q[9 * LANES];
        gradients_of(k, g, q);
        const int each = g < m->walls && is_one_shape(k, g, q) ? 1 : LANES;
        m->shape[g + 1] = m->shape[g] + 9 * each;
        if (MEM_ROOM(&m->gradient, &room, m->shape[g + 1], "the solver", k->e))
            return -1;
        for (int i = 0; i < 9 * each; i++)
            m->gradient[m->shape[g] + i] = (float)q[each == 1 ? i * LANES : i];
    }
    return m->shape ? 0 : -1;
}

/* Whether the points of a corner of a group follow each other; those of empty lanes are any that there are. */
static bool are_points_in_row(const maker *k, int64_t which)
{
    const int32_t *point = k->m->point + which * LANES, first = point[0];
    bool is = first + LANES <= k->m->points;
    for (int l = 0; l < LANES; l++)
        is &= k->at[which / 4 * LANES + l] < 0 || point[l] == first + l;
    return is;
}

/* A group whose points do not all follow each other is scattered. */
static void link_points(const maker *k, int64_t group)
{
    tissue_mesh *m = k->m;
    if (group >= m->lumens)
        return;
    bool rows = m->first[4 * group] != SELL_SCATTERED;
    for (int64_t c = 4 * group; c < 4 * group + 4; c++) {
        m->first_point[c] = m->points ? m->point[c * LANES] : 0;
        rows = rows && (!m->points || are_points_in_row(k, c));
    }
    for (int64_t c = 4 * group; c < 4 * group + 4; c++)
        m->first[c] = rows ? m->first[c] : SELL_SCATTERED;
}

static int fill_groups(const maker *k)
{
    tissue_mesh *m = k->m;
    const int64_t lanes = m->groups * LANES;
    m->stride = lanes + LANES;
    const char what[] = "the solver";
    if (!(m->node = mem_array(4 * lanes, sizeof *m->node, what, k->e)) ||
        !(m->point = mem_array(4 * lanes, sizeof *m->point, what, k->e)) ||
        !(m->volume = mem_array(lanes, sizeof *m->volume, what, k->e)) ||
        !(m->mu = mem_array(lanes, sizeof *m->mu, what, k->e)) ||
        !(m->kappa = mem_array(lanes, sizeof *m->kappa, what, k->e)) ||
        !(m->counted = mem_array(lanes, sizeof *m->counted, what, k->e)) ||
        !(m->g = mem_array(9 * lanes, sizeof *m->g, what, k->e)) ||
        !(m->law = mem_array(STABLE_NUMBERS * lanes, sizeof *m->law, what, k->e)) ||
        !(m->first_point = mem_array(4 * m->groups, sizeof *m->first_point, what, k->e)) ||
        !(m->force = mem_array(12 * m->stride, sizeof *m->force, what, k->e)) ||
        !(m->swollen = mem_array(m->stride, sizeof *m->swollen, what, k->e)))
        return -1;
    for (int64_t i = 0; i < lanes; i++)
        if (k->at[i] >= 0)
            fill_lane(k, i / LANES, (int)(i % LANES), &k->list[k->at[i]]);
    for (int64_t i = 0; i < m->groups; i++)
        link_points(k, i);
    return 0;
}

/* Of an element of tissue or of a cavity: what stands for lambda + 2 mu and more in the trace of its block, Pa. */
static double trace_of(const maker *k, int64_t t)
{
    const simplex *s = &k->p->element[t];
    const double own = fmin(s->lambda, (kept - 5. / 6) * s->mu);
    const int cavity = cavity_of(k->p->cavity, k->p->cavities, k->p->volume[t]);
    return cavity < 0 ? own + (s->lambda - own) / 4 + 4 * s->mu : 4 * k->mu[cavity];
}

/* A membrane in its plane: 4/3 and 1/3 of its stiffness along and across a corner's height over the edge before it. */
static void add_walls(const maker *k, double *sum)
{
    for (int64_t i = 0; i < k->walls; i++)
        for (int c = 0; c < 3; c++) {
            double edge[2][3], normal[3], across = 0, area = 0;
            for (int a = 0; a < 3; a++) {
                const double *x = k->p->position + a;
                edge[0][a] = x[3 * (int64_t)k->wall[i].node[1]] - x[3 * (int64_t)k->wall[i].node[0]];
                edge[1][a] = x[3 * (int64_t)k->wall[i].node[2]] - x[3 * (int64_t)k->wall[i].node[0]];
                const double opposite =
                    x[3 * (int64_t)k->wall[i].node[(c + 2) % 3]] - x[3 * (int64_t)k->wall[i].node[(c + 1) % 3]];
                across += opposite * opposite;
            }
            simplex_cross(edge[0], edge[1], normal);
            for (int a = 0; a < 3; a++)
                area += normal[a] * normal[a];
            sum[k->s->own_node[k->wall[i].node[c]]] +=
                k->p->cavity[k->wall[i].cavity].wall * 5 / 9 * across / (2 * sqrt(area));
        }
}

/* 1 over a third of the trace of each node's block at rest, about. */
static int make_inverse(const maker *k)
{
    const msds_problem *p = k->p;
    double *sum = mem_array(k->s->nodes, sizeof *sum, "the solver", k->e);
    k->m->inverse = sum ? mem_array(k->s->nodes, sizeof *k->m->inverse, "the solver", k->e) : NULL;
    for (int64_t i = 0; k->m->inverse && i < 4 * p->elements; i++) {
        const simplex *s = &p->element[i / 4];
        const double *q = s->gradient[i % 4];
        sum[k->s->own_node[p->element_node[i]]] +=
            s->volume * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]) * trace_of(k, i / 4) / 3;
    }
    if (k->m->inverse)
        add_walls(k, sum);
    for (int64_t n = 0; k->m->inverse && n < p->nodes; n++) {
        const int32_t own = k->s->own_node[n];
        k->m->inverse[own] = p->fixed[n] ? 0 : (float)(1 / sum[own]);
    }
    free(sum);
    return k->m->inverse ? 0 : -1;
}

/* ---- sums */

/* Who takes what, as tissue_items has them. */
typedef struct takers {
    int32_t *taker, *where;
    int64_t count;
} takers;

static void take(takers *to, int64_t taker, int64_t where)
{
    to->taker[to->count] = (int32_t)taker;
    to->where[to->count++] = (int32_t)where;
}

/* Forces of corners, by nodes: those of walls have three. */
static void take_corners(const maker *k, takers *to)
{
    const tissue_mesh *m = k->m;
    for (int64_t i = 0; i < m->groups * LANES; i++) {
        const bool is_wall = i >= m->walls * LANES, any = is_wall ? m->volume[i] > 0 : k->at[i] >= 0;
        for (int c = 0; any && c < (is_wall ? 3 : 4); c++)
            take(to, m->node[(4 * (i / LANES) + c) * LANES + i % LANES], 3 * c * m->stride + i);
    }
}

/* The cavity of a lane that has an element or a triangle of one. */
static int32_t cavity_at(const maker *k, int64_t i)
{
    const tissue_mesh *m = k->m;
    if (i >= m->walls * LANES)
        return m->point[4 * (i / LANES) * LANES + i % LANES] - m->cavity_point;
    return k->at[i] >= 0 ? k->list[k->at[i]].cavity : 0;
}

/* Changes of volume, by points: each of an element of tissue; those of cavities and walls only where they matter. */
static void take_swells(const maker *k, takers *to)
{
    const tissue_mesh *m = k->m;
    for (int64_t i = 0; i < m->lumens * LANES; i++)
        for (int c = 0; c < 4 && k->at[i] >= 0; c++)
            take(to, m->point[(4 * (i / LANES) + c) * LANES + i % LANES], i);
    for (int64_t i = m->lumens * LANES; i < m->groups * LANES; i++) {
        const int32_t of = cavity_at(k, i);
        if (m->volume[i] > 0 && k->p->cavity[of].outflow > 0)
            take(to, m->cavity_point + of, i);
    }
}

static int make_sums(const maker *k, tissue_sums *s, int64_t count, void (*list)(const maker *k, takers *to))
{
    const int64_t most = 4 * k->m->groups * LANES;
    takers t = {.taker = mem_array(most, sizeof *t.taker, "the solver", k->e)};
    t.where = t.taker ? mem_array(most, sizeof *t.where, "the solver", k->e) : NULL;
    if (t.where)
        list(k, &t);
    const tissue_items items = {t.count, t.taker, t.where, (int32_t)(k->m->groups * LANES)};
    const int failed = !t.where || tissue_sums_make(s, count, &items, k->e);
    free(t.taker);
    free(t.where);
    return failed ? -1 : 0;
}

static int make_all_sums(const maker *k)
{
    tissue_mesh *m = k->m;
    return make_sums(k, &m->corners, k->s->nodes, take_corners) ||
                   (m->points && make_sums(k, &m->swells, m->points, take_swells))
               ? -1
               : 0;
}

int tissue_mesh_make(tissue_mesh *m, const msds_problem *p, const sell *s, err *e)
{
    maker k = {.m = m, .p = p, .s = s, .e = e};
    int failed = -1;
    if (p->elements > INT32_MAX / 20)
        err_set(e, NULL, 0, "%lld tetrahedra; expected at most %d for the method tissue", (long long)p->elements,
                INT32_MAX / 20);
    else
        failed = make_walls(&k) || make_groups(&k) || make_points(&k) || fill_groups(&k) || fill_gradients(&k) ||
                 make_inverse(&k);
    if (!failed && p->cavities) {
        m->at_rest = mem_array(s->nodes, sizeof *m->at_rest, "the solver", e);
        m->within = mem_array(4 * (m->walls - m->lumens) * LANES, sizeof *m->within, "the solver", e);
        failed = !m->at_rest || !m->within;
        if (!failed)
            memcpy(m->at_rest, m->inverse, (size_t)s->nodes * sizeof *m->at_rest);
    }
    if (!failed && k.walls)
        failed = tissue_walls_fill(m, p, s, k.wall, k.walls, e);
    failed = failed || make_all_sums(&k);
    free(k.list);
    free(k.at);
    free(k.point);
    free(k.own_bulk);
    free(k.own_mu);
    free(k.room);
    free(k.wall);
    free(k.mu);
    free(k.hard);
    return failed ? -1 : 0;
}

void tissue_mesh_free(tissue_mesh *m)
{
    free(m->first);
    free(m->node);
    free(m->point);
    free(m->gradient);
    free(m->volume);
    free(m->mu);
    free(m->kappa);
    free(m->prestress);
    free(m->bulk);
    free(m->keep);
    free(m->held);
    free(m->inverse);
    free(m->at_rest);
    free(m->within);
    tissue_sums_free(&m->corners);
    tissue_sums_free(&m->swells);
    free(m->law);
    free(m->first_point);
    free(m->g);
    free(m->shape);
    free(m->counted);
    free(m->force);
    free(m->swollen);
    free(m->pressure);
    free(m->pressed);
    *m = (tissue_mesh){0};
}

int64_t tissue_mesh_bytes(const tissue_mesh *m)
{
    const int64_t lanes = m->groups * LANES;
    return lanes * 4 * (4 + 4 + 3 + 9 + 12 + 2 + STABLE_NUMBERS) + m->shape[m->groups] * 4 + m->groups * 40 +
           m->points * 20 + (m->corners.slots + m->swells.slots) * (LANES * 4 + 5) +
           m->corners.slices * (LANES * 4 + 8) + m->swells.slices * 8;
}
