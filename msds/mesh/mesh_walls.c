#include "msds/mesh/mesh_walls.h"

#include "base/mem.h"
#include "msds/mesh/mesh_shape.h"
#include "msds/mesh/mesh_way.h"

#include <stdlib.h>

enum {
    ROUNDS = 8,  /* of choosing nodes of the border and moving them */
    SWEEPS = 24, /* of a round, over all nodes that move */
    LAYERS = 3,  /* of nodes that give way, around those of the border */
    STEPS = 4,   /* of a search along a normal */
    FAR = 255
};

enum { SKIN = 8 }; /* of locks, beside a bit for each axis of the box along which a node stays */

static const double reach = 1.7;  /* of the shortest edge at a node: how far it goes to the border at most */
static const double inside = 6;   /* nodes in a named volume are so much dearer: they rather stay in it */
static const double dearer = 3;   /* and so is a node that has not got to the border */
static const double calm = 1.05;  /* strain of a tetrahedron that needs no ease */
static const double on = 1e-3;    /* of an edge from the border is on it */
static const double on_skin = .1; /* and so much for the skin's own nodes */
static const double nearby = .05; /* and so near, one aim is enough */
static const double arrived = 1e-6;
static const double hopeless = 1e3;
static const double gentle = .8; /* so much quality is kept at first, later less: neighbours give way before */

static const double tries[] = {1, .75, .5, .25, .125}; /* shares of the way to the border that a node tries to go */
static const double paces[] = {.2, .05, .0125};        /* of an edge: against the slope of the strain */

typedef struct ranked {
    double cost;
    int32_t node;
} ranked;

typedef struct walls {
    mesh_warp w;
    const mesh_regions *r;
    mesh_field field; /* of r */
    double *start;    /* nodes x 3: where they were */
    double *best;     /* nodes x 3: of the best round so far */
    double *cost;     /* nodes: the way to the border, in edges, times what makes it dearer; infinite: never of it */
    ranked *ranked;   /* nodes */
    uint8_t *locks;   /* nodes */
    uint8_t *region;  /* nodes: where they were */
    uint8_t *layer;   /* nodes: 0 of the border, so many edges from it, or FAR */
    uint8_t *best_layer;
} walls;

/* ---- ways a node may go */

static void unlock(const walls *k, int64_t n, double v[3])
{
    double to[3] = {0};
    for (int a = 0; a < 3; a++) {
        const double along = k->locks[n] >> a & 1 ? 0 : shape_dot(v, k->w.unit[a]);
        for (int i = 0; i < 3; i++)
            to[i] += along * k->w.unit[a][i];
    }
    for (int i = 0; i < 3; i++)
        v[i] = to[i];
}

/* From a place along the normal that the border has near another, either way, to the border. False: it is not near. */
static bool aim_along(const walls *k, int64_t n, const double from[3], const double near[3], double to[3])
{
    const double most = reach * k->w.edge[n];
    double along[3], back[3];
    mesh_regions_normal(k->r, near, along);
    unlock(k, n, along);
    shape_unit(along);
    if (!(shape_dot(along, along) > 0))
        return false;
    for (int i = 0; i < 3; i++)
        back[i] = -along[i];
    const double up = mesh_way(&k->field, from, along, most, STEPS);
    const double down = mesh_way(&k->field, from, back, most, STEPS), way = up <= down ? up : -down;
    for (int i = 0; i < 3; i++)
        to[i] = from[i] + way * along[i];
    return isfinite(way);
}

static double distance(const double a[3], const double b[3])
{
    double off[3];
    shape_less(a, b, off);
    return shape_length(off);
}

/* The place on the border that is nearest to where a node is. False: there is none near by. */
static bool aim(const walls *k, int64_t n, double to[3])
{
    const double *from = &k->w.g->position[3 * n];
    const bool stays[3] = {k->locks[n] & 1, k->locks[n] & 2, k->locks[n] & 4};
    double nearer[3];
    if (!aim_along(k, n, from, from, to) &&
        !mesh_way_foot(&k->field, k->w.unit, stays, from, reach * k->w.edge[n] / 1.5, to))
        return false;
    for (int i = 0; i < 2 && distance(to, from) > nearby * k->w.edge[n]; i++)
        if (aim_along(k, n, from, to, nearer) && distance(nearer, from) < distance(to, from))
            memcpy(to, nearer, sizeof nearer);
    return true;
}

/* ---- which nodes are of the border */

/* Whether an edge of a node goes to another region; all: also one to a node of the border. */
static bool crosses(const walls *k, int64_t n, bool all)
{
    const mesh_around *a = &k->w.around;
    for (int64_t i = a->start[n]; i < a->start[n + 1]; i++)
        for (int c = 0; c < 4; c++) {
            const int64_t m = k->w.g->node[4 * (int64_t)a->element[i] + c];
            if (k->region[m] != k->region[n] && (all || k->layer[m]))
                return true;
        }
    return false;
}

/* Of the skin, which does not move: a node at the border is of it, before all others; and none else, if others do. */
static double cost_of(const walls *k, int64_t n)
{
    const bool skin = k->locks[n] & SKIN;
    double to[3];
    if (!crosses(k, n, true))
        return (double)INFINITY;
    const double off = aim(k, n, to) ? distance(to, &k->w.g->position[3 * n]) / k->w.edge[n] : hopeless;
    if (skin)
        return off < on_skin ? 0 : hopeless;
    return off * (k->region[n] ? inside : 1);
}

static int by_cost(const void *a, const void *b)
{
    const ranked *p = a, *q = b;
    if (p->cost < q->cost || p->cost > q->cost)
        return p->cost < q->cost ? -1 : 1;
    return (p->node > q->node) - (p->node < q->node);
}

/* Tetrahedra with all nodes on the border become flat: one that has no edge to another region but to the border need
 * not be of it. */
static void thin_out(const walls *k)
{
    for (int64_t t = 0; t < k->w.g->tets; t++) {
        const int32_t *node = &k->w.g->node[4 * t];
        int64_t dearest = -1;
        if (k->layer[node[0]] || k->layer[node[1]] || k->layer[node[2]] || k->layer[node[3]])
            continue;
        for (int c = 0; c < 4; c++)
            if (!crosses(k, node[c], false) && (dearest < 0 || k->cost[node[c]] > k->cost[dearest]))
                dearest = node[c];
        if (dearest >= 0)
            k->layer[dearest] = FAR;
    }
}

static void find_layers(const walls *k)
{
    const mesh_graded *g = k->w.g;
    for (int l = 1; l <= LAYERS; l++)
        for (int64_t i = 0; i < 16 * g->tets; i++) {
            const int64_t from = g->node[i / 4], to = g->node[i / 16 * 4 + i % 4];
            if (k->layer[from] == l - 1 && k->layer[to] == FAR)
                k->layer[to] = (uint8_t)l;
        }
}

/* The cheapest nodes first, until no edge between regions is without one. */
static void choose(const walls *k)
{
    int64_t count = 0;
    memset(k->layer, FAR, (size_t)k->w.g->nodes);
    for (int64_t n = 0; n < k->w.g->nodes; n++)
        if (isfinite(k->cost[n]))
            k->ranked[count++] = (ranked){k->cost[n], (int32_t)n};
    qsort(k->ranked, (size_t)count, sizeof *k->ranked, by_cost);
    for (int64_t i = 0; i < count; i++)
        if (crosses(k, k->ranked[i].node, false))
            k->layer[k->ranked[i].node] = 0;
    thin_out(k);
    find_layers(k);
}

/* ---- moves */

/* What is minimised: the sum of kept quality to the power of -3 of a node's tetrahedra. Infinite where one is not
 * good. */
static double strain(const walls *k, int64_t n)
{
    const mesh_around *a = &k->w.around;
    double sum = 0;
    for (int64_t i = a->start[n]; i < a->start[n + 1]; i++) {
        const double kept = mesh_warp_kept(&k->w, a->element[i]);
        if (!(kept >= MESH_QUALITY_KEPT))
            return (double)INFINITY;
        sum += 1 / (kept * kept * kept);
    }
    return sum;
}

/* Adds how a tetrahedron's strain rises with the place of one of its nodes, 1/m: quality is six / square^1.5, and its
 * gradient over itself grad(six) / six - 1.5 grad(square) / square. */
static void add_slope(const walls *k, int64_t t, int64_t n, double slope[3])
{
    static const int8_t of[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}; /* faces, seen from inside */
    const int32_t *node = &k->w.g->node[4 * t];
    const double *x = k->w.g->position, kept = mesh_warp_kept(&k->w, t), six = mesh_six_volumes(node, x);
    double square = 0, edge[3], sum[3] = {0}, u[3], v[3], area[3];
    int c = 0;
    while (node[c] != n)
        c++;
    for (int i = 0; i < 16; i++) {
        shape_less(&x[3 * (int64_t)node[i / 4]], &x[3 * (int64_t)node[i % 4]], edge);
        square += shape_dot(edge, edge) / 12;
        for (int a = 0; i / 4 == c && a < 3; a++)
            sum[a] += edge[a] / 3;
    }
    shape_less(&x[3 * (int64_t)node[of[c][1]]], &x[3 * (int64_t)node[of[c][0]]], u);
    shape_less(&x[3 * (int64_t)node[of[c][2]]], &x[3 * (int64_t)node[of[c][0]]], v);
    shape_cross(u, v, area);
    for (int a = 0; a < 3; a++)
        slope[a] -= 3 / (kept * kept * kept) * (area[a] / six - 1.5 * sum[a] / square);
}

/* A direction that a node may go, for one of the border along it: of length 1, or 0. */
static void find_direction(const walls *k, int64_t n, double slope[3])
{
    const mesh_around *a = &k->w.around;
    double normal[3];
    for (int i = 0; i < 3; i++)
        slope[i] = 0;
    for (int64_t i = a->start[n]; i < a->start[n + 1]; i++)
        add_slope(k, a->element[i], n, slope);
    unlock(k, n, slope);
    if (!k->layer[n]) {
        mesh_regions_normal(k->r, &k->w.g->position[3 * n], normal);
        unlock(k, n, normal);
        shape_unit(normal);
        const double off = shape_dot(slope, normal);
        for (int i = 0; i < 3; i++)
            slope[i] -= off * normal[i];
    }
    shape_unit(slope);
}

/* Moves a node so that its tetrahedra are less strained; if it is on the border, it stays on it. */
static void ease(const walls *k, int64_t n, bool on_border)
{
    double *position = &k->w.g->position[3 * n], from[3], slope[3], to[3];
    const double before = strain(k, n);
    if (before <= calm * (double)(k->w.around.start[n + 1] - k->w.around.start[n]))
        return;
    find_direction(k, n, slope);
    memcpy(from, position, sizeof from);
    for (size_t s = 0; s < sizeof paces / sizeof *paces && shape_dot(slope, slope) > 0; s++) {
        for (int i = 0; i < 3; i++)
            position[i] = from[i] - paces[s] * k->w.edge[n] * slope[i];
        const bool there = !on_border || aim_along(k, n, position, position, to);
        if (there && on_border)
            memcpy(position, to, sizeof to);
        if (there && strain(k, n) < before)
            return;
    }
    memcpy(position, from, sizeof from);
}

/* To the border, as far as tetrahedra keep so much of their quality. Whether it is there. */
static bool approach(const walls *k, int64_t n, double least)
{
    double *position = &k->w.g->position[3 * n], from[3], to[3];
    if (!aim(k, n, to))
        return false;
    if (distance(to, position) < arrived * k->w.edge[n])
        return true;
    memcpy(from, position, sizeof from);
    for (size_t i = 0; i < sizeof tries / sizeof *tries; i++) {
        for (int a = 0; a < 3; a++)
            position[a] = from[a] + tries[i] * (to[a] - from[a]);
        if (mesh_warp_all_good(&k->w, n, least))
            return i == 0;
    }
    memcpy(position, from, sizeof from);
    return false;
}

static void move_all(const walls *k)
{
    memcpy(k->w.g->position, k->start, (size_t)k->w.g->nodes * 3 * sizeof *k->start);
    for (int s = 0; s < SWEEPS; s++) {
        const double least = fmax(MESH_QUALITY_KEPT, gentle - 2 * (gentle - MESH_QUALITY_KEPT) * s / SWEEPS);
        for (int64_t n = 0; n < k->w.g->nodes; n++) {
            if (k->layer[n] == FAR || k->locks[n] & SKIN)
                continue;
            const bool there = k->layer[n] == 0 && approach(k, n, least);
            ease(k, n, there);
        }
    }
}

/* ---- regions of tetrahedra */

static void middle_of(const walls *k, int64_t t, double to[3])
{
    to[0] = to[1] = to[2] = 0;
    for (int i = 0; i < 12; i++)
        to[i % 3] += k->w.g->position[3 * (int64_t)k->w.g->node[4 * t + i / 3] + i % 3] / 4;
}

/* That of its nodes that are not of the border, which are all in one; else that of its middle. */
static int region_of(const walls *k, int64_t t, const double middle[3])
{
    const int32_t *node = &k->w.g->node[4 * t];
    for (int c = 0; c < 4; c++)
        if (k->layer[node[c]])
            return k->region[node[c]];
    return mesh_regions_at(k->r, middle);
}

/* Counts nodes of the border, and makes those dearer that are not on it. */
static void look(const walls *k, mesh_smoothed *to)
{
    *to = (mesh_smoothed){.kept = (double)INFINITY};
    for (int64_t n = 0; n < k->w.g->nodes; n++) {
        const double *position = &k->w.g->position[3 * n];
        double at[3];
        if (k->layer[n])
            continue;
        const double off = aim(k, n, at) ? distance(at, position) : k->w.edge[n];
        const bool is_off = off > (k->locks[n] & SKIN ? on_skin : on) * k->w.edge[n];
        to->nodes++;
        to->off += is_off;
        to->farthest = fmax(to->farthest, off);
        to->largest = fmax(to->largest, distance(position, &k->start[3 * n]));
        k->cost[n] *= is_off ? dearer : 1;
    }
    for (int64_t t = 0; t < k->w.g->tets; t++)
        to->kept = fmin(to->kept, mesh_warp_kept(&k->w, t));
}

/* ---- all */

static void find_locks(const walls *k)
{
    const mesh_graded *g = k->w.g;
    int32_t face[3];
    for (int64_t n = 0; n < g->nodes; n++)
        for (int a = 0; a < 3; a++)
            k->locks[n] |= (uint8_t)(mesh_warp_on_side(&k->w, n, a) << a);
    for (int64_t t = 0; t < g->tets; t++)
        for (int c = 0; c < 4; c++) {
            mesh_around_face(g, t, c, face);
            if (mesh_warp_face_on_side(&k->w, face) || mesh_around_beyond(g, &k->w.around, t, c) >= 0)
                continue;
            for (int i = 0; i < 3; i++)
                k->locks[face[i]] |= SKIN;
        }
}

static int make(walls *k, err *e)
{
    const int64_t nodes = k->w.g->nodes;
    k->start = mem_array(nodes, 3 * sizeof *k->start, "nodes", e);
    k->best = k->start ? mem_array(nodes, 3 * sizeof *k->best, "nodes", e) : NULL;
    k->cost = k->best ? mem_array(nodes, sizeof *k->cost, "nodes", e) : NULL;
    k->ranked = k->cost ? mem_array(nodes, sizeof *k->ranked, "nodes", e) : NULL;
    k->locks = k->ranked ? mem_array(nodes, 1, "nodes", e) : NULL;
    k->region = k->locks ? mem_array(nodes, 1, "nodes", e) : NULL;
    k->layer = k->region ? mem_array(nodes, 1, "nodes", e) : NULL;
    k->best_layer = k->layer ? mem_array(nodes, 1, "nodes", e) : NULL;
    return k->best_layer ? 0 : -1;
}

static void finish(walls *k)
{
    mesh_warp_free(&k->w);
    free(k->start);
    free(k->best);
    free(k->cost);
    free(k->ranked);
    free(k->locks);
    free(k->region);
    free(k->layer);
    free(k->best_layer);
}

static void begin(const walls *k)
{
    const mesh_graded *g = k->w.g;
    memcpy(k->start, g->position, (size_t)g->nodes * 3 * sizeof *k->start);
    find_locks(k);
    for (int64_t n = 0; n < g->nodes; n++)
        k->region[n] = (uint8_t)mesh_regions_at(k->r, &g->position[3 * n]);
    for (int64_t n = 0; n < g->nodes; n++)
        k->cost[n] = cost_of(k, n);
}

/* Rounds, until all nodes of the border are on it; of these the one that has the fewest beside it. */
static void run(const walls *k, mesh_smoothed *to)
{
    const mesh_graded *g = k->w.g;
    for (int i = 0; i < ROUNDS && (!i || to->off); i++) {
        mesh_smoothed now;
        choose(k);
        move_all(k);
        look(k, &now);
        if (i && now.off >= to->off)
            continue;
        *to = now;
        memcpy(k->best, g->position, (size_t)g->nodes * 3 * sizeof *k->best);
        memcpy(k->best_layer, k->layer, (size_t)g->nodes);
    }
    memcpy(g->position, k->best, (size_t)g->nodes * 3 * sizeof *k->best);
    memcpy(k->layer, k->best_layer, (size_t)g->nodes);
}

int mesh_walls_smooth(mesh_graded *g, const mesh_box *b, const mesh_cells *c, const mesh_regions *r,
                      const volume *labels, int64_t *label, mesh_smoothed *to, err *e)
{
    walls k = {.r = r, .field = {mesh_regions_at, r}};
    const int status = mesh_warp_make(&k.w, b, c, NULL, g, e) || make(&k, e) ? -1 : 0;
    if (!status) {
        begin(&k);
        run(&k, to);
        for (int64_t t = 0; t < g->tets; t++) {
            double middle[3];
            middle_of(&k, t, middle);
            label[t] = mesh_regions_label(r, labels, middle, region_of(&k, t, middle));
        }
    }
    finish(&k);
    return status;
}
