#include "tled/problem/followers.h"

#include "base/mem.h"
#include "mesh/bound.h"
#include "surface/triangle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 512 };

void followers_free(followers *f)
{
    if (!f)
        return;
    free(f->rest);
    free(f->vertex_curve);
    free(f->share_start);
    free(f->share_node);
    free(f->share);
    free(f->corner);
    free(f->part);
    free(f->around_start);
    free(f->around);
    free(f->node);
    free(f->is_pushed);
    free(f->pull_start);
    free(f->pull_vertex);
    free(f->pull_share);
    free(f->pull_bound);
    free(f->most);
    free(f);
}

/* ---- the vertices, triangles and nodes of all curves */

static bool is_pressure(const script_curve *c)
{
    return c->verb == SCRIPT_PRESSURE;
}

/* Places of a curve's vertices among all: in the order in which its triangles have them first. */
typedef struct numbering {
    int32_t *place; /* vertices of the largest surface: or -1 */
    int64_t room;
} numbering;

/* Of the vertex added last: of its element's nodes, of the model's number yet. */
static void add_shares(followers *f, const bound *b, int32_t vertex)
{
    const int32_t *node = b->node + 8 * (int64_t)b->element[vertex];
    double share[8];
    bound_shares(b, vertex, share);
    for (int k = 0; k < 8; k++)
        if (share[k] != 0) {
            f->share_node[f->shares] = node[k];
            f->share[f->shares++] = share[k];
        }
}

static int32_t place_of(followers *f, numbering *n, const bound *b, int32_t vertex, int32_t curve)
{
    int32_t *place = &n->place[vertex];
    if (*place >= 0)
        return *place;
    *place = (int32_t)f->vertices++;
    memcpy(f->rest + 3 * (int64_t)*place, b->shape.position + 3 * (int64_t)vertex, 3 * sizeof *f->rest);
    f->vertex_curve[*place] = curve;
    add_shares(f, b, vertex);
    f->share_start[*place + 1] = (int32_t)f->shares;
    return *place;
}

static int add_curve(followers *f, const script *s, int32_t curve, const model *m, err *e)
{
    const script_curve *c = &s->curve[curve];
    bound b;
    if (bound_of(&b, m, c->surface, e) < 0)
        return -1;
    numbering n = {mem_array(b.shape.vertices, sizeof *n.place, "the pressure", e), b.shape.vertices};
    if (!n.place)
        return -1;
    memset(n.place, -1, (size_t)n.room * sizeof *n.place);
    for (int64_t i = 0; i < 3 * (int64_t)c->triangle_count; i++)
        f->corner[3 * f->triangles + i] = place_of(f, &n, &b, s->corner[3 * (int64_t)c->triangle_first + i], curve);
    memcpy(f->part + f->triangles, s->part + c->triangle_first, (size_t)c->triangle_count * sizeof *f->part);
    f->triangles += c->triangle_count;
    free(n.place);
    return 0;
}

/* Room for each corner of a triangle to be a vertex. */
static int allocate(followers *f, int64_t triangles, const tled_problem *p, err *e)
{
    static const char what[] = "the pressure";
    const int64_t most = 3 * triangles, nodes = p->nodes;
    f->rest = mem_array(most, 3 * sizeof *f->rest, what, e);
    f->vertex_curve = mem_array(most, sizeof *f->vertex_curve, what, e);
    f->share_start = mem_array(most + 1, sizeof *f->share_start, what, e);
    f->share_node = mem_array(8 * most, sizeof *f->share_node, what, e);
    f->share = mem_array(8 * most, sizeof *f->share, what, e);
    f->part = mem_array(triangles, sizeof *f->part, what, e);
    f->corner = mem_array(most, sizeof *f->corner, what, e);
    f->around_start = mem_array(most + 2, sizeof *f->around_start, what, e);
    f->around = mem_array(most, sizeof *f->around, what, e);
    f->node = mem_array(nodes, sizeof *f->node, what, e);
    f->is_pushed = mem_array(nodes, sizeof *f->is_pushed, what, e);
    f->most = mem_array(p->script->curves, 3 * sizeof *f->most, what, e);
    return f->rest && f->vertex_curve && f->share_start && f->share_node && f->share && f->corner && f->part &&
                   f->around_start && f->around && f->node && f->is_pushed && f->most
               ? 0
               : -1;
}

static int allocate_pulls(followers *f, err *e)
{
    static const char what[] = "the pressure";
    f->pull_start = mem_array(f->nodes + 2, sizeof *f->pull_start, what, e);
    f->pull_vertex = mem_array(f->shares, sizeof *f->pull_vertex, what, e);
    f->pull_share = mem_array(f->shares, sizeof *f->pull_share, what, e);
    f->pull_bound = mem_array(f->shares, sizeof *f->pull_bound, what, e);
    return f->pull_start && f->pull_vertex && f->pull_share && f->pull_bound ? 0 : -1;
}

/* Lists by what item[i] is, ascending, the i with it. start: things + 2, zeroed; its first things + 1 count. */
static void list_by(const int32_t *item, int64_t items, int64_t things, int32_t *start, int32_t *list)
{
    for (int64_t i = 0; i < items; i++)
        start[item[i] + 2]++;
    for (int64_t n = 0; n < things; n++)
        start[n + 2] += start[n + 1];
    for (int64_t i = 0; i < items; i++)
        list[start[item[i] + 1]++] = (int32_t)i;
}

static void find_most(followers *f, const script *s)
{
    for (int64_t i = 0; i < s->curves; i++)
        for (int32_t k = 0; is_pressure(&s->curve[i]) && k < s->curve[i].key_count; k++)
            f->most[3 * i] = fmax(f->most[3 * i], fabs(s->value[3 * ((int64_t)s->curve[i].key_first + k)]));
}

/* From nodes of the model to places among those with a share. */
static int number_nodes(followers *f, const tled_problem *p, err *e)
{
    int32_t *place = mem_array(p->nodes, sizeof *place, "the pressure", e);
    if (!place)
        return -1;
    for (int64_t i = 0; i < f->shares; i++)
        place[f->share_node[i]] = 1;
    for (int64_t n = 0; n < p->nodes; n++)
        if (place[n]) {
            place[n] = (int32_t)f->nodes;
            f->node[f->nodes++] = (int32_t)n;
        }
    for (int64_t i = 0; i < f->shares; i++)
        f->share_node[i] = place[f->share_node[i]];
    free(place);
    return 0;
}

static void mark_pushed(followers *f, const script *s)
{
    for (int64_t v = 0; v < f->vertices; v++)
        for (int32_t i = f->share_start[v]; i < f->share_start[v + 1]; i++)
            f->is_pushed[f->share_node[i]] |= s->curve[f->vertex_curve[v]].is_region;
}

bool followers_push(const followers *f, int64_t node)
{
    int64_t low = 0, high = f ? f->nodes : 0;
    while (low < high) {
        const int64_t middle = low + (high - low) / 2;
        if (f->node[middle] == node)
            return f->is_pushed[middle];
        if (f->node[middle] < node)
            low = middle + 1;
        else
            high = middle;
    }
    return false;
}

/* ---- bounds of the load stiffness */

/* The shares that nodes have in a triangle's vertices: a node once. */
typedef struct sharing {
    int count;
    int32_t node[24];
    int64_t first[24];   /* of its shares, the first */
    double share[24][3]; /* in each vertex */
} sharing;

static void add_sharing(sharing *s, const followers *f, int64_t at, int corner)
{
    int k = 0;
    while (k < s->count && s->node[k] != f->share_node[at])
        k++;
    if (k == s->count) {
        s->node[k] = f->share_node[at];
        s->first[k] = at;
        s->count++;
    }
    s->share[k][corner] += f->share[at];
}

static sharing sharing_of(const followers *f, const int32_t *corner)
{
    sharing s = {0};
    for (int c = 0; c < 3; c++)
        for (int32_t i = f->share_start[corner[c]]; i < f->share_start[corner[c] + 1]; i++)
            add_sharing(&s, f, i, c);
    return s;
}

/* Adds a triangle's part to its nodes' rows and columns, halved. limit: shares. */
static void add_bound(const followers *f, const tled_problem *p, int64_t triangle, double *limit)
{
    const int32_t *corner = f->corner + 3 * triangle;
    const sharing s = sharing_of(f, corner);
    const double *a = f->rest + 3 * (int64_t)corner[0];
    const double ab = triangle_distance(a, f->rest + 3 * (int64_t)corner[1]);
    const double ac = triangle_distance(a, f->rest + 3 * (int64_t)corner[2]);
    double change[24], changes = 0, shares = 0;
    for (int k = 0; k < s.count; k++) {
        const double *w = s.share[k];
        change[k] = ac * fabs(w[1] - w[0]) + ab * fabs(w[2] - w[0]);
        changes += change[k];
        shares += fabs(w[0]) + fabs(w[1]) + fabs(w[2]);
    }
    for (int k = 0; k < s.count; k++) {
        const double *w = s.share[k];
        const double row = (fabs(w[0]) + fabs(w[1]) + fabs(w[2])) * changes, column = shares * change[k];
        limit[s.first[k]] += f->part[triangle] * (row + column) / 12 / p->mass[f->node[s.node[k]]];
    }
}

/* The largest sum of a node's bounds at what presses each vertex, by its curve or (by_vertex) by itself. pressure: x 3,
 * Pa, of which the first counts. */
static double largest_bound(const followers *f, const double *pressure, bool by_vertex)
{
    double largest = 0;
    for (int64_t n = 0; n < f->nodes; n++) {
        double sum = 0;
        for (int32_t i = f->pull_start[n]; i < f->pull_start[n + 1]; i++) {
            const int64_t v = f->pull_vertex[i];
            sum += f->pull_bound[i] * pressure[3 * (by_vertex ? v : (int64_t)f->vertex_curve[v])];
        }
        largest = fmax(largest, sum);
    }
    return largest;
}

/* How many times as long as at rest an edge of a triangle is. */
static double stretch_of(const followers_work *w, const int32_t *corner)
{
    double stretch = 0;
    for (int i = 0; i < 3; i++) {
        const int64_t from = 3 * (int64_t)corner[i], to = 3 * (int64_t)corner[(i + 1) % 3];
        const double rest = triangle_distance(w->f->rest + from, w->f->rest + to);
        if (rest > 0)
            stretch = fmax(stretch, triangle_distance(w->at + from, w->at + to) / rest);
    }
    return stretch;
}

/* In place of forces, the pressure at a vertex times the largest stretch about it: a share's part of a bound is of
 * triangles there. */
static void grow_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const followers_work *w = context;
    const followers *f = w->f;
    (void)chunk;
    for (int64_t v = from; v < to; v++) {
        double stretch = 0;
        for (int32_t i = f->around_start[v]; i < f->around_start[v + 1]; i++)
            stretch = fmax(stretch, stretch_of(w, f->corner + 3 * (int64_t)f->around[i]));
        w->force[3 * v] = stretch * fabs(w->value[3 * (int64_t)f->vertex_curve[v]]);
    }
}

double followers_square_at_rest(const tled_problem *p)
{
    return p->followers ? largest_bound(p->followers, p->followers->most, false) : 0;
}

double followers_step(double square, double step)
{
    return square > 0 ? 2 / sqrt(4 / (step * step) + square) : step;
}

/* ---- making */

static void fill_pulls(followers *f, const int32_t *pull, const double *limit)
{
    for (int64_t i = 0; i < f->shares; i++) {
        f->pull_share[i] = f->share[pull[i]];
        f->pull_bound[i] = limit[pull[i]];
    }
}

static void find_vertices(followers *f, const int32_t *pull, int32_t *vertex)
{
    for (int64_t v = 0; v < f->vertices; v++)
        for (int32_t i = f->share_start[v]; i < f->share_start[v + 1]; i++)
            vertex[i] = (int32_t)v;
    for (int64_t i = 0; i < f->shares; i++)
        f->pull_vertex[i] = vertex[pull[i]];
}

/* The shares once more, by node. */
static int make_pulls(followers *f, const tled_problem *p, err *e)
{
    int32_t *pull = mem_array(f->shares, sizeof *pull, "the pressure", e);
    int32_t *vertex = mem_array(f->shares, sizeof *vertex, "the pressure", e);
    double *limit = mem_array(f->shares, sizeof *limit, "the pressure", e);
    const int status = pull && vertex && limit && !allocate_pulls(f, e) ? 0 : -1;
    if (!status) {
        list_by(f->share_node, f->shares, f->nodes, f->pull_start, pull);
        for (int64_t t = 0; t < f->triangles; t++)
            add_bound(f, p, t, limit);
        find_vertices(f, pull, vertex);
        fill_pulls(f, pull, limit);
    }
    free(pull);
    free(vertex);
    free(limit);
    return status;
}

static int make(followers *f, const tled_problem *p, const model *m, err *e)
{
    const script *s = p->script;
    for (int64_t i = 0; i < s->curves; i++)
        if (is_pressure(&s->curve[i]) && add_curve(f, s, (int32_t)i, m, e))
            return -1;
    if (number_nodes(f, p, e))
        return -1;
    mark_pushed(f, s);
    find_most(f, s);
    list_by(f->corner, 3 * f->triangles, f->vertices, f->around_start, f->around);
    for (int64_t i = 0; i < 3 * f->triangles; i++)
        f->around[i] /= 3;
    return make_pulls(f, p, e);
}

int followers_make(tled_problem *p, const model *m, err *e)
{
    int64_t triangles = 0;
    for (int64_t i = 0; i < p->script->curves; i++)
        triangles += is_pressure(&p->script->curve[i]) ? p->script->curve[i].triangle_count : 0;
    if (!triangles)
        return 0;
    if (triangles > INT32_MAX / 24)
        return err_set(e, NULL, 0, "pressure on %lld triangles; expected at most %d", (long long)triangles,
                       INT32_MAX / 24);
    p->followers = mem_array(1, sizeof *p->followers, "the pressure", e);
    return p->followers && !allocate(p->followers, triangles, p, e) ? make(p->followers, p, m, e) : -1;
}

/* ---- forces */

int followers_room(followers_work *w, const followers *f, err *e)
{
    *w = (followers_work){.f = f};
    if (!f)
        return 0;
    w->moved = mem_array(f->nodes, 3 * sizeof *w->moved, "the pressure", e);
    w->at = mem_array(f->vertices, 3 * sizeof *w->at, "the pressure", e);
    w->force = mem_array(f->vertices, 3 * sizeof *w->force, "the pressure", e);
    w->normal = mem_array(f->triangles, 3 * sizeof *w->normal, "the pressure", e);
    return w->moved && w->at && w->force && w->normal ? 0 : -1;
}

void followers_room_free(followers_work *w)
{
    free(w->moved);
    free(w->at);
    free(w->force);
    free(w->normal);
    *w = (followers_work){.f = NULL};
}

int64_t followers_bytes(const followers *f)
{
    return f ? (int64_t)sizeof(double) * (3 * f->nodes + 6 * f->vertices + 3 * f->triangles) : 0;
}

void followers_move(followers_work *w, const double *displacement)
{
    for (int64_t n = 0; n < w->f->nodes; n++)
        memcpy(w->moved + 3 * n, displacement + 3 * (int64_t)w->f->node[n], 3 * sizeof *w->moved);
}

static void place_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const followers_work *w = context;
    const followers *f = w->f;
    (void)chunk;
    for (int64_t v = from; v < to; v++) {
        double moved[3] = {0};
        for (int32_t i = f->share_start[v]; i < f->share_start[v + 1]; i++)
            for (int a = 0; a < 3; a++)
                moved[a] += f->share[i] * w->moved[3 * (int64_t)f->share_node[i] + a];
        for (int a = 0; a < 3; a++)
            w->at[3 * v + a] = f->rest[3 * v + a] + moved[a];
    }
}

static void normal_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const followers_work *w = context;
    (void)chunk;
    for (int64_t t = from; t < to; t++) {
        const int32_t *corner = w->f->corner + 3 * t;
        double *normal = w->normal + 3 * t;
        triangle_normal(w->at + 3 * (int64_t)corner[0], w->at + 3 * (int64_t)corner[1], w->at + 3 * (int64_t)corner[2],
                        normal);
        for (int a = 0; a < 3; a++)
            normal[a] *= w->f->part[t];
    }
}

static void force_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const followers_work *w = context;
    const followers *f = w->f;
    (void)chunk;
    for (int64_t v = from; v < to; v++) {
        double sum[3] = {0};
        for (int32_t i = f->around_start[v]; i < f->around_start[v + 1]; i++)
            for (int a = 0; a < 3; a++)
                sum[a] += w->normal[3 * (int64_t)f->around[i] + a];
        for (int a = 0; a < 3; a++)
            w->force[3 * v + a] = -w->value[3 * (int64_t)f->vertex_curve[v]] / 6 * sum[a];
    }
}

void followers_press(followers_work *w, pool *threads, const double *value)
{
    w->value = value;
    pool_run(threads, w->f->vertices, CHUNK, place_work, w);
    pool_run(threads, w->f->triangles, CHUNK, normal_work, w);
    pool_run(threads, w->f->vertices, CHUNK, force_work, w);
}

void followers_pull(const followers_work *w, int64_t i, double force[3])
{
    const followers *f = w->f;
    double sum[3] = {0};
    for (int32_t k = f->pull_start[i]; k < f->pull_start[i + 1]; k++)
        for (int a = 0; a < 3; a++)
            sum[a] += f->pull_share[k] * w->force[3 * (int64_t)f->pull_vertex[k] + a];
    memcpy(force, sum, sizeof sum);
}

double followers_square(followers_work *w, pool *threads, const double *value)
{
    if (!w->f)
        return 0;
    w->value = value;
    pool_run(threads, w->f->vertices, CHUNK, place_work, w);
    pool_run(threads, w->f->vertices, CHUNK, grow_work, w);
    return largest_bound(w->f, w->force, true);
}
