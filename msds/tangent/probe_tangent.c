#include "msds/tangent/probe_tangent.h"

#include "base/mem.h"
#include "msds/cpu/sums.h"
#include "msds/tangent/tangent_product.h"
#include "msds/tangent/tangent_touches.h"
#include "solve/flush.h"

#include <stdlib.h>
#include <string.h>

/* What may be left of a column, as an energy over the largest of a translation, or, for turns, over what that is at the
 * contacts' mean arm. */
static const double enough = 1e-5;

/* A column of more than so many times the energy that it may have is of no use: it began far away. */
static const double beyond = 4;

enum { WORKING = 2, FIELDS = 3 * PROBE_TANGENT_COLUMNS + WORKING };

struct probe_tangent {
    const msds_executor *device;
    msds_state *state;
    pool *threads;
    const sell *order;
    tangent_product product;
    tangent_touches touches;
    lanes_field column[PROBE_TANGENT_COLUMNS]; /* for each unit of the probe's motion: m */
    lanes_field pull[PROBE_TANGENT_COLUMNS];   /* what the elements pull with then, N */
    lanes_field ways[PROBE_TANGENT_COLUMNS];   /* the last directions of search */
    lanes_field left, pulled;
    double *sum; /* chunks */
    float alpha, beta;
    const lanes_field *a, *b; /* what loops work on */
    lanes_field *to, *pull_to, *way;
    bool warm;     /* there are columns of the frame before */
    bool careful;  /* what may make the tangent indefinite is left out, until the probe has left */
    bool is_sound; /* the tangent was positive along all directions so far */
    double scale;  /* N/m: the largest energy of a translation, */
    double square; /* m2: and of the contacts' arms the mean square */
};

static void clear(const probe_tangent *t, lanes_field *f)
{
    memset(f->memory, 0, 3 * (size_t)(t->order->nodes + 2 * LANES) * sizeof *f->memory);
}

/* ---- loops over nodes, in chunks; the order of sums does not depend on the threads */

static double run(probe_tangent *t, pool_work *work)
{
    pool_run(t->threads, t->order->count, SELL_CHUNK, work, t);
    return sums_of(t->sum, pool_chunks(t->order->count, SELL_CHUNK));
}

static void dot_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const probe_tangent *t = context;
    double sum = 0;
    for (int a = 0; a < 3; a++)
        for (int64_t i = from * LANES; i < to * LANES; i++)
            sum += (double)t->a->x[a][i] * (double)t->b->x[a][i];
    t->sum[chunk] = sum;
}

/* The sum of a . b over all nodes. */
static double dot_of(probe_tangent *t, const lanes_field *a, const lanes_field *b)
{
    t->a = a;
    t->b = b;
    return run(t, dot_work);
}

static void weigh_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const probe_tangent *t = context;
    double sum = 0;
    for (int a = 0; a < 3; a++)
        for (int64_t i = from * LANES; i < to * LANES; i++)
            sum += (double)(t->left.x[a][i] * t->left.x[a][i] * t->product.inverse[i]);
    t->sum[chunk] = sum;
}

static void advance_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const probe_tangent *t = context;
    const unsigned before = flush_small();
    (void)chunk;
    for (int a = 0; a < 3; a++)
        for (int64_t i = from * LANES; i < to * LANES; i++) {
            t->to->x[a][i] += t->alpha * t->way->x[a][i];
            t->pull_to->x[a][i] += t->alpha * t->pulled.x[a][i];
            t->left.x[a][i] -= t->alpha * t->pulled.x[a][i];
        }
    flush_as(before);
}

static void turn_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const probe_tangent *t = context;
    const unsigned before = flush_small();
    (void)chunk;
    for (int a = 0; a < 3; a++)
        for (int64_t i = from * LANES; i < to * LANES; i++)
            t->way->x[a][i] = t->product.inverse[i] * t->left.x[a][i] + t->beta * t->way->x[a][i];
    flush_as(before);
}

static void negate_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const probe_tangent *t = context;
    (void)chunk;
    for (int a = 0; a < 3; a++)
        for (int64_t i = from * LANES; i < to * LANES; i++)
            t->left.x[a][i] = -t->pull_to->x[a][i];
}

/* Of the next direction with the last, where this one's pull is `pulled`: left inverse . pulled. */
static void couple_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const probe_tangent *t = context;
    double sum = 0;
    for (int a = 0; a < 3; a++)
        for (int64_t i = from * LANES; i < to * LANES; i++)
            sum += (double)(t->left.x[a][i] * t->product.inverse[i] * t->pulled.x[a][i]);
    t->sum[chunk] = sum;
}

/* ---- contacts */

static void take(const lanes_field *f, int32_t own, double to[3])
{
    for (int a = 0; a < 3; a++)
        to[a] = (double)f->x[a][own];
}

static double along(const tangent_touch *c, const double v[3])
{
    return c->way[0] * v[0] + c->way[1] * v[1] + c->way[2] * v[2];
}

static void add(lanes_field *f, int32_t own, const double by[3], double scale)
{
    for (int a = 0; a < 3; a++)
        f->x[a][own] += (float)(scale * by[a]);
}

/* Takes out of f, of forces or of a direction, what it has along the ways of nodes that are held. */
static void keep_out(const probe_tangent *t, lanes_field *f)
{
    double v[3];
    for (int64_t i = 0; i < t->touches.count && t->touches.held; i++) {
        const tangent_touch *c = &t->touches.list[i];
        take(f, c->own, v);
        add(f, c->own, c->way, -along(c, v));
    }
}

/* How column j moves a contact's node, less how the probe moves there. */
static void apart(const probe_tangent *t, const tangent_touch *c, int j, double w[3])
{
    double d[3];
    take(&t->column[j], c->own, w);
    tangent_touches_rigid(c, j, d);
    for (int a = 0; a < 3; a++)
        w[a] -= d[a];
}

static void stiffen(const tangent_touch *c, const double v[3], double to[3])
{
    for (int a = 0; a < 3; a++)
        to[a] = c->stiff[a][0] * v[0] + c->stiff[a][1] * v[1] + c->stiff[a][2] * v[2];
}

/* Whether column j may have so much energy: a translation no more than if all nodes but the contacts' stayed, about. */
static bool is_usual(const probe_tangent *t, int j, double energy)
{
    double sum = 0;
    for (int64_t i = 0; i < t->touches.count; i++) {
        const tangent_touch *c = &t->touches.list[i];
        sum += t->touches.held ? 1 / (double)t->product.inverse[c->own] : 0;
        for (int a = 0; a < 3; a++)
            sum += fabs(c->stiff[a][a]);
    }
    return j < 3 ? energy <= beyond * sum : isfinite(energy);
}

/* ---- a column */

/* Where nodes are held, the column goes along their ways as the probe does; left: of its balance then. */
static void begin_column(probe_tangent *t, int j)
{
    double w[3], force[3], turned[3];
    for (int64_t i = 0; i < t->touches.count && t->touches.held; i++) {
        const tangent_touch *c = &t->touches.list[i];
        apart(t, c, j, w);
        add(&t->column[j], c->own, c->way, -along(c, w));
    }
    tangent_product_of(&t->product, &t->column[j], &t->pull[j]);
    run(t, negate_work);
    for (int64_t i = 0; i < t->touches.count; i++) {
        const tangent_touch *c = &t->touches.list[i];
        apart(t, c, j, w);
        stiffen(c, w, force);
        tangent_touches_turned(c, j, turned);
        add(&t->left, c->own, force, -1);
        add(&t->left, c->own, turned, 1);
    }
    keep_out(t, &t->left);
}

/* way . (K + S) way, with K way in pulled. */
static double curvature_of(probe_tangent *t)
{
    double sum = tangent_product_of(&t->product, t->way, &t->pulled), v[3], force[3];
    for (int64_t i = 0; i < t->touches.count; i++) {
        const tangent_touch *c = &t->touches.list[i];
        take(t->way, c->own, v);
        stiffen(c, v, force);
        sum += v[0] * force[0] + v[1] * force[1] + v[2] * force[2];
    }
    return sum;
}

static void go(probe_tangent *t, double alpha)
{
    double v[3], force[3];
    t->alpha = (float)alpha;
    run(t, advance_work);
    for (int64_t i = 0; i < t->touches.count; i++) {
        const tangent_touch *c = &t->touches.list[i];
        take(t->way, c->own, v);
        stiffen(c, v, force);
        add(&t->left, c->own, force, -alpha);
    }
    keep_out(t, &t->left);
}

/* Goes on from the last direction of the frame before, as if its search had not ended: to where the energy along it is
 * least, and then so that the next direction is conjugate to it. Counts products. */
static void go_on(probe_tangent *t, int64_t *products)
{
    double v[3], force[3];
    keep_out(t, t->way);
    const double curvature = curvature_of(t);
    *products += 1;
    t->beta = 0;
    if (!(curvature > 0)) {
        t->is_sound = false;
        return;
    }
    go(t, dot_of(t, &t->left, t->way) / curvature);
    double sum = run(t, couple_work);
    for (int64_t i = 0; i < t->touches.count; i++) {
        const tangent_touch *c = &t->touches.list[i];
        take(t->way, c->own, v);
        stiffen(c, v, force);
        take(&t->left, c->own, v);
        sum += (double)t->product.inverse[c->own] * (v[0] * force[0] + v[1] * force[1] + v[2] * force[2]);
    }
    t->beta = (float)(-sum / curvature);
}

/* What the energy of a column's error is small against. */
static double scale_of(probe_tangent *t, int j)
{
    return fmax(dot_of(t, &t->column[j], &t->pull[j]), j < 3 ? t->scale : t->scale * t->square);
}

/* Returns what is left, over that; counts products. Where the tangent is not positive along a way, as of a state far
 * from equilibrium, it stops. */
static double find_column(probe_tangent *t, int j, int64_t most, int64_t *products)
{
    t->to = &t->column[j];
    t->pull_to = &t->pull[j];
    t->way = &t->ways[j];
    t->beta = 0;
    begin_column(t, j);
    *products += 1;
    if (t->warm && !is_usual(t, j, dot_of(t, t->to, t->pull_to))) {
        clear(t, t->to);
        clear(t, t->way);
        begin_column(t, j);
        *products += 1;
    }
    double square = run(t, weigh_work), scale = scale_of(t, j);
    if (t->warm && square > enough * scale) {
        go_on(t, products);
        square = run(t, weigh_work);
    }
    for (int64_t i = 0; i < most && square > enough * scale; i++) {
        run(t, turn_work);
        const double curvature = curvature_of(t);
        *products += 1;
        if (!(curvature > 0)) {
            t->is_sound = false;
            break;
        }
        go(t, dot_of(t, &t->left, t->way) / curvature);
        const double next = run(t, weigh_work);
        t->beta = (float)(next / square);
        square = next;
        scale = scale_of(t, j);
    }
    return scale > 0 ? square / scale : 0;
}

static void find_columns(probe_tangent *t, int64_t most, probe_tangent_reading *to)
{
    double largest = 0;
    t->square = to->left = 0;
    t->is_sound = true;
    for (int64_t i = 0; i < t->touches.count; i++)
        for (int a = 0; a < 3; a++)
            t->square += t->touches.list[i].arm[a] * t->touches.list[i].arm[a] / (double)t->touches.count;
    for (int j = 0; j < PROBE_TANGENT_COLUMNS; j++) {
        to->left = fmax(to->left, find_column(t, j, most, &to->products));
        const double own = dot_of(t, &t->column[j], &t->pull[j]);
        t->is_sound = t->is_sound && is_usual(t, j, own);
        if (j < 3)
            largest = fmax(largest, own);
        t->scale = j < 2 ? fmax(t->scale, largest) : largest;
    }
}

/* The elements and contacts of now. -1 with e filled. */
static int begin(probe_tangent *t, const msds_parts *parts, err *e)
{
    return tangent_touches_find(&t->touches, parts, t->careful, e) ||
                   (t->touches.count && tangent_product_begin(&t->product, parts, t->careful, e))
               ? -1
               : 0;
}

/* ---- the stiffness */

/* u_i K u_j, and what contacts add. Symmetric, but for the torque's turn: a probe that is turned by theta and then by
 * phi is not turned by their sum, but by half of phi x theta more. */
static void sum_up(probe_tangent *t, probe_tangent_reading *to)
{
    double wi[3], wj[3], torque[3];
    for (int i = 0; i < PROBE_TANGENT_COLUMNS; i++)
        for (int j = 0; j <= i; j++) {
            double sum = (dot_of(t, &t->column[i], &t->pull[j]) + dot_of(t, &t->column[j], &t->pull[i])) / 2;
            for (int64_t n = 0; n < t->touches.count; n++) {
                const tangent_touch *c = &t->touches.list[n];
                apart(t, c, i, wi);
                apart(t, c, j, wj);
                sum += tangent_touches_energy(c, i, wi, j, wj);
            }
            to->stiffness[i][j] = to->stiffness[j][i] = sum;
        }
    tangent_touches_torque(&t->touches, torque);
    for (int a = 0; a < 3; a++) {
        const int i = 3 + (a + 1) % 3, j = 3 + (a + 2) % 3;
        to->stiffness[i][j] -= torque[a] / 2;
        to->stiffness[j][i] += torque[a] / 2;
    }
}

int probe_tangent_find(probe_tangent *t, int64_t most, int64_t first, probe_tangent_reading *to, err *e)
{
    msds_parts parts;
    *to = (probe_tangent_reading){.left = 0};
    if (t->device->parts(t->state, &parts, e) || begin(t, &parts, e))
        return -1;
    if (!t->touches.count) {
        probe_tangent_forget(t);
        return 0;
    }
    find_columns(t, t->warm ? most : first, to);
    t->warm = true;
    if (!t->is_sound && !t->careful) {
        probe_tangent_forget(t);
        t->careful = true;
        if (begin(t, &parts, e))
            return -1;
        find_columns(t, first, to);
        t->warm = true;
    }
    sum_up(t, to);
    return 0;
}

/* ---- life */

static lanes_field *field_of(probe_tangent *t, int i)
{
    lanes_field *const of[] = {t->column, t->pull, t->ways}, *const working[WORKING] = {&t->left, &t->pulled};
    const int kind = i / PROBE_TANGENT_COLUMNS;
    return kind < 3 ? &of[kind][i % PROBE_TANGENT_COLUMNS] : working[i - 3 * PROBE_TANGENT_COLUMNS];
}

void probe_tangent_forget(probe_tangent *t)
{
    for (int i = 0; i < FIELDS && t->warm; i++)
        clear(t, field_of(t, i));
    t->warm = t->careful = false;
    t->scale = 0;
}

probe_tangent *probe_tangent_create(const msds_executor *device, msds_state *state, err *e)
{
    msds_parts parts;
    probe_tangent *t = mem_array(1, sizeof *t, "the contact stiffness", e);
    if (!t || device->parts(state, &parts, e)) {
        free(t);
        return NULL;
    }
    *t = (probe_tangent){.device = device, .state = state, .threads = parts.threads, .order = parts.order};
    t->sum = mem_array(pool_chunks(t->order->count, SELL_CHUNK), sizeof *t->sum, "the contact stiffness", e);
    int failed = !t->sum || tangent_product_make(&t->product, t->order, e) ? -1 : 0;
    for (int i = 0; i < FIELDS && !failed; i++)
        failed = lanes_field_make(field_of(t, i), t->order->nodes, e);
    if (!failed)
        return t;
    probe_tangent_destroy(t);
    return NULL;
}

void probe_tangent_destroy(probe_tangent *t)
{
    if (!t)
        return;
    for (int i = 0; i < FIELDS; i++)
        lanes_field_free(field_of(t, i));
    tangent_product_free(&t->product);
    tangent_touches_free(&t->touches);
    free(t->sum);
    free(t);
}
