#include "msds/cpu/cg.h"

#include "base/mem.h"
#include "msds/cpu/sums.h"

#include <stdlib.h>
#include <string.h>

static void put_block(float *to, int lane, const double *block, bool transposed)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            to[(3 * i + j) * LANES + lane] = (float)(transposed ? block[3 * j + i] : block[3 * i + j]);
}

typedef struct filling {
    lanes_matrix *m;
    const msds_problem *p;
    const stiffness *k;
} filling;

static void fill_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    filling *g = context;
    const sell *s = g->m->s;
    (void)chunk;
    for (int64_t own = from * LANES; own < to * LANES; own++) {
        const int64_t slice = own / LANES, node = s->model_node[own];
        const int lane = (int)(own % LANES);
        if (node < 0 || g->p->fixed[node])
            continue;
        put_block(g->m->diagonal + slice * 9 * LANES, lane, g->k->diagonal + 9 * node, false);
        for (int64_t slot = s->start[slice]; slot < s->start[slice + 1]; slot++) {
            int64_t spring = s->spring[slot * LANES + lane];
            if (spring >= 0)
                put_block(g->m->block + slot * 9 * LANES, lane, g->k->block + 9 * spring,
                          g->p->spring[spring].node[0] != node);
        }
    }
}

void cg_fill(lanes_matrix *m, const msds_problem *p, const stiffness *k, pool *threads)
{
    filling f = {m, p, k};
    pool_run(threads, m->s->count, SELL_CHUNK, fill_work, &f);
}

static void run(cg *g, pool_work *work)
{
    pool_run(g->threads, g->s->count, SELL_CHUNK, work, g);
}

static double sum_of(const cg *g)
{
    return sums_of(g->sum, pool_chunks(g->s->count, SELL_CHUNK));
}

int cg_make(cg *g, const msds_problem *p, const sell *s, stiffness *k, contacts *c, const lanes *loops, pool *threads,
            lanes_field *u, lanes_field *weight, err *e)
{
    *g = (cg){
        .p = p, .s = s, .k = k, .pressed = {p, s, c}, .loops = loops, .threads = threads, .u = u, .weight = weight};
    g->matrix.s = s;
    g->matrix.diagonal = mem_array(s->count, 9 * LANES * sizeof(float), "the solver", e);
    g->matrix.block = mem_array(s->slots, 9 * LANES * sizeof(float), "the solver", e);
    g->sum = mem_array(pool_chunks(s->count, SELL_CHUNK), sizeof *g->sum, "the solver", e);
    g->place = mem_array(p->nodes, 3 * sizeof *g->place, "the solver", e);
    g->force = mem_array(p->nodes, 3 * sizeof *g->force, "the solver", e);
    if (!g->matrix.diagonal || !g->matrix.block || !g->sum || !g->place || !g->force ||
        lanes_field_make(&g->left, s->nodes, e) || lanes_field_make(&g->way, s->nodes, e) ||
        lanes_field_make(&g->pulled, s->nodes, e))
        return -1;
    cg_fill(&g->matrix, g->p, g->k, g->threads);
    return 0;
}

void cg_free(cg *g)
{
    free(g->matrix.diagonal);
    free(g->matrix.block);
    free(g->sum);
    free(g->place);
    free(g->force);
    lanes_field_free(&g->left);
    lanes_field_free(&g->way);
    lanes_field_free(&g->pulled);
    *g = (cg){0};
}

static void pull_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    cg *g = context;
    (void)chunk;
    g->loops->multiply(&g->matrix, g->u, &g->pulled, from, to);
}

/* g->pulled: what the elements pull with at u, from the matrix or, where rotations are taken out, from the elements. */
static void find_pulled(cg *g, bool again)
{
    const sell *s = g->s;
    if (!g->k->turn) {
        run(g, pull_work);
        return;
    }
    for (int64_t n = 0; n < g->p->nodes; n++)
        for (int a = 0; a < 3; a++)
            g->place[3 * n + a] = (double)g->u->x[a][s->own_node[n]];
    if (again) {
        stiffness_warp(g->k, g->place, true);
        cg_fill(&g->matrix, g->p, g->k, g->threads);
    }
    stiffness_force(g->k, g->place, g->force);
    for (int64_t n = 0; n < g->p->nodes; n++)
        for (int a = 0; a < 3; a++)
            g->pulled.x[a][s->own_node[n]] = g->p->fixed[n] ? 0 : (float)g->force[3 * n + a];
}

/* left = gravity - pulled; fixed nodes: 0. Returns the square of its norm. */
static double find_left(cg *g, double *load)
{
    double square = 0;
    *load = 0;
    g->pull = 0;
    for (int a = 0; a < 3; a++)
        for (int64_t own = 0; own < g->s->nodes; own++) {
            float weight = g->weight->x[a][own], left = weight - g->pulled.x[a][own];
            g->pull += (double)g->pulled.x[a][own] * (double)g->pulled.x[a][own];
            g->left.x[a][own] = left;
            square += (double)left * (double)left;
            *load += (double)weight * (double)weight;
        }
    return square;
}

static void multiply_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    cg *g = context;
    g->sum[chunk] = g->loops->multiply(&g->matrix, &g->way, &g->pulled, from, to);
}

static void advance_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    cg *g = context;
    g->sum[chunk] = g->loops->advance(g->u, &g->left, &g->way, &g->pulled, g->alpha, from, to);
}

static void turn_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    cg *g = context;
    (void)chunk;
    g->loops->turn(&g->way, &g->left, g->beta, from, to);
}

/* The forces of contact, and what is left then, over the load. */
static void conclude(cg *g)
{
    double load, square;
    find_pulled(g, false);
    square = find_left(g, &load);
    for (int64_t i = 0; i < g->pressed.c->count; i++) {
        contact *c = &g->pressed.c->list[i];
        c->force = g->p->options.penalty ? g->p->repulsion[c->node] * pressed_depth(&g->pressed, c, g->u)
                                         : -pressed_along(&g->left, g->s->own_node[c->node], c);
        pressed_drag(&g->pressed, c, g->u);
        pressed_count(&g->pressed, c, &g->left, g->weight, &square, &load);
    }
    load = fmax(fmax(load, g->pull), g->p->slight);
    g->residual = load > 0 ? sqrt(fmax(0, square) / load) : 0;
}

void cg_solve(cg *g, int64_t iterations)
{
    double load, squared, next;
    pressed_move(&g->pressed, g->u);
    find_pulled(g, true);
    find_left(g, &load);
    pressed_push(&g->pressed, g->u, &g->left);
    pressed_keep_out(&g->pressed, &g->left);
    memset(g->way.memory, 0, 3 * (size_t)(g->s->nodes + 2 * LANES) * sizeof *g->way.memory);
    g->alpha = g->beta = 0;
    memset(g->pulled.memory, 0, 3 * (size_t)(g->s->nodes + 2 * LANES) * sizeof *g->pulled.memory);
    run(g, advance_work); /* the norm alone */
    squared = sum_of(g);
    for (int64_t i = 0; i < iterations && squared > 0; i++) {
        run(g, turn_work);
        run(g, multiply_work);
        double curvature = sum_of(g) + pressed_stiffen(&g->pressed, &g->way, &g->pulled);
        if (!(curvature > 0))
            break;
        pressed_keep_out(&g->pressed, &g->pulled);
        g->alpha = (float)(squared / curvature);
        run(g, advance_work);
        next = sum_of(g);
        g->beta = (float)(next / squared);
        squared = next;
    }
    conclude(g);
}
