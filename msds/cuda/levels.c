#include "msds/cuda/levels.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

enum {
    ROW_MOST = 1000, /* neighbours of a node on a coarser lattice; one that fits has 26 */
    TABLE = 2048,    /* a power of two, above it */
    ROWS_CHUNK = 256,
    WIDEST = 1000000, /* cells */
    POWERS = 12       /* steps to the largest eigenvalue */
};

/* The largest eigenvalue is found so far from below. */
static const double short_of = 1.1;

/* What moves counts as so much stiffer where a matrix is inverted: a lattice's node at
 * the rim of the mesh may have hardly any. */
static const double shift = 1e-5;

/* Cells are of another size if their longest edges are less than this of others': they are halved, or as large. */
static const double smaller = .75;

/* ---- places */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Whether corner c of element t has three edges at right angles, as the corners of a lattice's cells: fills them. */
static bool square_corner(const msds_problem *p, int64_t t, int c, double edge[3][3])
{
    const int32_t *n = p->element_node + 4 * t;
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++)
            edge[i][a] = p->position[3 * (int64_t)n[(c + 1 + i) % 4] + a] - p->position[3 * (int64_t)n[c] + a];
    for (int i = 0; i < 3; i++) {
        const double *one = edge[i], *other = edge[(i + 1) % 3];
        if (fabs(dot(one, other)) > 1e-6 * sqrt(dot(one, one) * dot(other, other)))
            return false;
    }
    return true;
}

static double longest_of(double edge[3][3])
{
    return sqrt(fmax(dot(edge[0], edge[0]), fmax(dot(edge[1], edge[1]), dot(edge[2], edge[2]))));
}

/* The edges of a smallest cell, where cells are graded: those of the first of the smallest square corners, or a cube of
 * the mean size. A lattice of larger cells would leave to smoothing what smaller ones need. */
static void find_cell(const msds_problem *p, double edge[3][3])
{
    double least = (double)INFINITY, here[3][3];
    for (int i = 0; i < 9; i++)
        edge[i / 3][i % 3] = i % 4 ? 0 : p->side;
    for (int64_t t = 0; t < p->elements; t++)
        for (int c = 0; c < 4; c++) {
            if (!square_corner(p, t, c, here) || !(longest_of(here) < smaller * least))
                continue;
            least = longest_of(here);
            memcpy(edge, here, sizeof here);
        }
}

/* Level 0: places in cells of the mesh, from 0 up. */
static int place_mesh(level *l, const msds_problem *p, err *e)
{
    double edge[3][3], low[3] = {INFINITY, INFINITY, INFINITY};
    l->place = mem_array(l->graph.nodes, 3 * sizeof *l->place, "coarser lattices", e);
    l->moves = mem_array(l->graph.nodes, sizeof *l->moves, "coarser lattices", e);
    if (!l->place || !l->moves)
        return -1;
    find_cell(p, edge);
    for (int64_t n = 0; n < p->nodes; n++) {
        int64_t own = l->graph.own_node[n];
        l->moves[own] = !p->fixed[n];
        for (int a = 0; a < 3; a++) {
            double at = dot(p->position + 3 * n, edge[a]) / dot(edge[a], edge[a]);
            l->place[3 * own + a] = at;
            low[a] = fmin(low[a], at);
        }
    }
    for (int64_t own = 0; own < l->graph.nodes; own++)
        for (int a = 0; a < 3; a++) {
            double at = l->graph.model_node[own] < 0 ? 0 : l->place[3 * own + a] - low[a];
            l->place[3 * own + a] = fabs(at - round(at)) < 1e-3 ? round(at) : at;
        }
    return 0;
}

/* ---- weights */

typedef struct lattice { /* of the next level */
    int64_t size[3];
    int32_t *node; /* size: its nodes, numbered along x first, or -1 */
    int64_t nodes;
} lattice;

typedef struct share {
    int64_t at[8]; /* places of the lattice */
    float weight[8];
    int count;
} share;

/* How a place of the finer lattice lies among the nodes of the coarser. */
static share share_of(const lattice *x, const double place[3])
{
    share s = {.count = 0};
    int64_t low[3];
    double part[3];
    for (int a = 0; a < 3; a++) {
        low[a] = (int64_t)floor(place[a] / 2);
        part[a] = place[a] / 2 - (double)low[a];
    }
    for (int c = 0; c < 8; c++) {
        double weight = 1;
        for (int a = 0; a < 3; a++)
            weight *= c >> a & 1 ? part[a] : 1 - part[a];
        if (weight <= 0)
            continue;
        s.at[s.count] = (low[0] + (c & 1)) + x->size[0] * ((low[1] + (c >> 1 & 1)) + x->size[1] * (low[2] + (c >> 2)));
        s.weight[s.count++] = (float)weight;
    }
    return s;
}

static int make_lattice(lattice *x, const level *fine, err *e)
{
    double high[3] = {0, 0, 0};
    for (int64_t n = 0; n < fine->graph.nodes; n++)
        for (int a = 0; a < 3; a++)
            high[a] = fmax(high[a], fine->place[3 * n + a]);
    for (int a = 0; a < 3; a++) {
        if (!(high[a] < WIDEST))
            return err_set(e, NULL, 0, "the mesh is %.3g cells wide; expected at most %d", high[a], WIDEST);
        x->size[a] = (int64_t)(high[a] / 2) + 2;
    }
    const int64_t places = x->size[0] * x->size[1] * x->size[2];
    x->node = mem_array(places, sizeof *x->node, "coarser lattices", e);
    if (!x->node)
        return -1;
    for (int64_t n = 0; n < fine->graph.nodes; n++) {
        const share s = share_of(x, fine->place + 3 * n);
        for (int i = 0; i < s.count && fine->moves[n]; i++)
            x->node[s.at[i]] = 1;
    }
    for (int64_t i = 0; i < places; i++)
        x->node[i] = x->node[i] ? (int32_t)x->nodes++ : -1;
    return x->nodes > 0 ? 0 : err_set(e, NULL, 0, "no node is free to move; expected one at least");
}

/* The slots of a slice of rows, which have so many entries each. */
static int32_t slots_of(const int32_t *entries, int64_t rows, int64_t slice)
{
    int32_t most = 0;
    for (int64_t row = slice * LANES; row < rows && row < (slice + 1) * LANES; row++)
        most = entries[row] > most ? entries[row] : most;
    return most;
}

/* Room for rows of so many entries each. */
static int weights_room(levels_weights *w, const int32_t *entries, int64_t rows, err *e)
{
    w->count = (rows + LANES - 1) / LANES;
    w->start = mem_array(w->count + 1, sizeof *w->start, "coarser lattices", e);
    if (!w->start)
        return -1;
    for (int64_t i = 0; i < w->count; i++)
        w->start[i + 1] = w->start[i] + slots_of(entries, rows, i);
    w->slots = w->start[w->count];
    w->column = mem_array(w->slots * LANES, sizeof *w->column, "coarser lattices", e);
    w->weight = mem_array(w->slots * LANES, sizeof *w->weight, "coarser lattices", e);
    return w->column && w->weight ? 0 : -1;
}

static void weights_put(levels_weights *w, int64_t row, int32_t entry, int32_t column, float weight)
{
    int64_t at = ((int64_t)w->start[row / LANES] + entry) * LANES + row % LANES;
    w->column[at] = column;
    w->weight[at] = weight;
}

/* Fills up and down, entries by entries: the finer nodes of a coarse one ascend. */
static int make_weights(level *fine, const lattice *x, err *e)
{
    const int64_t nodes = fine->graph.nodes;
    int32_t *up = mem_array(nodes, sizeof *up, "coarser lattices", e);
    int32_t *down = mem_array(x->nodes, sizeof *down, "coarser lattices", e);
    int result = -1;
    if (!up || !down)
        goto out;
    for (int pass = 0; pass < 2; pass++) {
        for (int64_t n = 0; n < nodes; n++) {
            const share s = share_of(x, fine->place + 3 * n);
            for (int i = 0; i < s.count && fine->moves[n]; i++) {
                int32_t coarse = x->node[s.at[i]];
                if (pass) {
                    weights_put(&fine->up, n, i, coarse, s.weight[i]);
                    weights_put(&fine->down, coarse, down[coarse], (int32_t)n, s.weight[i]);
                }
                up[n] = i + 1;
                down[coarse]++;
            }
        }
        if (!pass && (weights_room(&fine->up, up, nodes, e) || weights_room(&fine->down, down, x->nodes, e)))
            goto out;
        memset(down, 0, (size_t)x->nodes * sizeof *down);
    }
    result = 0;
out:
    free(up);
    free(down);
    return result;
}

/* ---- the matrix */

typedef struct row { /* of the coarse matrix, while it is summed */
    int32_t column[ROW_MOST];
    double block[ROW_MOST][9];
    int32_t order[ROW_MOST]; /* by columns */
    int16_t table[TABLE];    /* where a column is, and one; 0: nowhere */
    int count;
    bool full;
} row;

typedef struct product {
    const level *fine;
    level *coarse;
    int32_t *entries; /* nodes of coarse: blocks of each row, without the diagonal */
    int pass;         /* 0: counts; 1: fills */
    bool *failed;     /* chunks */
} product;

static double *row_at(row *r, int32_t column)
{
    uint32_t at = (uint32_t)column * 2654435761u % TABLE;
    while (r->table[at] && r->column[r->table[at] - 1] != column)
        at = (at + 1) % TABLE;
    if (!r->table[at]) {
        if (r->count == ROW_MOST) {
            r->full = true;
            return r->block[0];
        }
        r->column[r->count] = column;
        memset(r->block[r->count], 0, sizeof r->block[0]);
        r->table[at] = (int16_t)++r->count;
    }
    return r->block[r->table[at] - 1];
}

/* Adds weight times a block of the fine matrix, that of column node n, to what that node has in the coarse columns. */
static void add_column(const level *fine, row *r, float weight, const float *block, int32_t n)
{
    const levels_weights *up = &fine->up;
    const int64_t slice = n / LANES, lane = n % LANES;
    for (int64_t slot = up->start[slice]; slot < up->start[slice + 1]; slot++) {
        const double by = (double)weight * (double)up->weight[slot * LANES + lane];
        if (by == 0)
            continue;
        double *to = row_at(r, up->column[slot * LANES + lane]);
        for (int i = 0; i < 9; i++)
            to[i] += by * (double)block[i * LANES];
    }
}

static void sum_row(const level *fine, row *r, int64_t coarse)
{
    const levels_weights *down = &fine->down;
    const sell *g = &fine->graph;
    memset(r->table, 0, sizeof r->table);
    r->count = 0;
    for (int64_t i = down->start[coarse / LANES]; i < down->start[coarse / LANES + 1]; i++) {
        const float weight = down->weight[i * LANES + coarse % LANES];
        const int32_t n = down->column[i * LANES + coarse % LANES];
        if (weight == 0)
            continue;
        const int64_t slice = n / LANES, lane = n % LANES;
        add_column(fine, r, weight, fine->matrix.diagonal + slice * 9 * LANES + lane, n);
        for (int64_t slot = g->start[slice]; slot < g->start[slice + 1]; slot++)
            if (g->neighbour[slot * LANES + lane] != n)
                add_column(fine, r, weight, fine->matrix.block + slot * 9 * LANES + lane,
                           g->neighbour[slot * LANES + lane]);
    }
}

static void sort_row(row *r)
{
    for (int i = 0; i < r->count; i++) {
        int at = i;
        for (; at > 0 && r->column[r->order[at - 1]] > r->column[i]; at--)
            r->order[at] = r->order[at - 1];
        r->order[at] = i;
    }
}

static void fill_row(level *l, row *r, int64_t n)
{
    int64_t slot = l->graph.start[n / LANES];
    sort_row(r);
    for (int i = 0; i < r->count; i++) {
        const int32_t column = r->column[r->order[i]];
        float *to = column == n ? l->matrix.diagonal + n / LANES * 9 * LANES : l->matrix.block + slot * 9 * LANES;
        for (int k = 0; k < 9; k++)
            to[k * LANES + n % LANES] = (float)r->block[r->order[i]][k];
        if (column != n)
            l->graph.neighbour[slot++ * LANES + n % LANES] = column;
    }
}

static void product_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    product *p = context;
    err e = {0};
    row *r = mem_array(1, sizeof *r, "coarser lattices", &e);
    p->failed[chunk] = !r;
    for (int64_t n = from; n < to && r; n++) {
        sum_row(p->fine, r, n);
        p->failed[chunk] = p->failed[chunk] || r->full;
        p->entries[n] = r->count - 1;
        if (p->pass)
            fill_row(p->coarse, r, n);
    }
    free(r);
}

static int graph_room(level *l, const int32_t *entries, int64_t nodes, err *e)
{
    sell *s = &l->graph;
    s->count = (nodes + LANES - 1) / LANES;
    s->nodes = s->count * LANES;
    s->start = mem_array(s->count + 1, sizeof *s->start, "coarser lattices", e);
    if (!s->start)
        return -1;
    for (int64_t i = 0; i < s->count; i++)
        s->start[i + 1] = s->start[i] + slots_of(entries, nodes, i);
    s->slots = s->start[s->count];
    s->first = mem_array(s->slots, sizeof *s->first, "coarser lattices", e);
    s->neighbour = mem_array(s->slots * LANES, sizeof *s->neighbour, "coarser lattices", e);
    l->matrix.diagonal = mem_array(s->count, 9 * LANES * sizeof(float), "coarser lattices", e);
    l->matrix.block = mem_array(s->slots, 9 * LANES * sizeof(float), "coarser lattices", e);
    if (!s->first || !s->neighbour || !l->matrix.diagonal || !l->matrix.block)
        return -1;
    for (int64_t slice = 0; slice < s->count; slice++)
        for (int64_t at = s->start[slice] * LANES; at < s->start[slice + 1] * LANES; at++) {
            s->first[at / LANES] = SELL_SCATTERED;
            s->neighbour[at] = (int32_t)(slice * LANES + at % LANES);
        }
    return 0;
}

static int make_product(level *fine, level *coarse, int64_t nodes, pool *threads, err *e)
{
    const int64_t chunks = pool_chunks(nodes, ROWS_CHUNK);
    product p = {.fine = fine, .coarse = coarse};
    int result = -1;
    p.entries = mem_array(nodes, sizeof *p.entries, "coarser lattices", e);
    p.failed = mem_array(chunks, sizeof *p.failed, "coarser lattices", e);
    for (p.pass = 0; p.pass < 2 && p.entries && p.failed; p.pass++) {
        pool_run(threads, nodes, ROWS_CHUNK, product_work, &p);
        for (int64_t i = 0; i < chunks; i++)
            if (p.failed[i]) {
                err_set(e, NULL, 0, "the mesh is too uneven for a coarser lattice, or memory is short");
                goto out;
            }
        if (!p.pass && graph_room(coarse, p.entries, nodes, e))
            goto out;
        result = p.pass - 1;
    }
out:
    free(p.entries);
    free(p.failed);
    return result;
}

static int place_lattice(level *l, const lattice *x, err *e)
{
    l->place = mem_array(l->graph.nodes, 3 * sizeof *l->place, "coarser lattices", e);
    l->moves = mem_array(l->graph.nodes, sizeof *l->moves, "coarser lattices", e);
    if (!l->place || !l->moves)
        return -1;
    for (int64_t i = 0; i < x->size[0] * x->size[1] * x->size[2]; i++)
        if (x->node[i] >= 0) {
            const int64_t at[3] = {i % x->size[0], i / x->size[0] % x->size[1], i / x->size[0] / x->size[1]};
            for (int a = 0; a < 3; a++)
                l->place[3 * (int64_t)x->node[i] + a] = (double)at[a];
            l->moves[x->node[i]] = true;
        }
    return 0;
}

/* ---- what smooths, and the coarsest */

static void invert(const float *block, float *to)
{
    double k[9], most = 0, inverse[9];
    for (int i = 0; i < 9; i++)
        k[i] = (double)block[i * LANES];
    for (int i = 0; i < 3; i++)
        most = fmax(most, k[4 * i]);
    for (int i = 0; i < 3; i++)
        k[4 * i] += shift * most;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int r = (j + 1) % 3, q = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            inverse[3 * i + j] = k[3 * r + c] * k[3 * q + d] - k[3 * r + d] * k[3 * q + c];
        }
    double all = k[0] * inverse[0] + k[1] * inverse[3] + k[2] * inverse[6];
    for (int i = 0; i < 9 && all > 0; i++)
        to[i * LANES] = (float)(inverse[i] / all);
}

typedef struct power {
    const level *l;
    const lanes *loops;
    lanes_field *x, *y;
} power;

static void power_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    power *w = context;
    (void)chunk;
    w->loops->multiply(&w->l->matrix, w->x, w->y, from, to);
    for (int64_t n = from * LANES; n < to * LANES; n++) {
        const float *k = w->l->inverse + n / LANES * 9 * LANES + n % LANES;
        const float y[3] = {w->y->x[0][n], w->y->x[1][n], w->y->x[2][n]};
        for (int a = 0; a < 3; a++)
            w->y->x[a][n] = k[3 * a * LANES] * y[0] + k[(3 * a + 1) * LANES] * y[1] + k[(3 * a + 2) * LANES] * y[2];
    }
}

static double norm_of(const lanes_field *f, int64_t nodes)
{
    double sum = 0;
    for (int a = 0; a < 3; a++)
        for (int64_t n = 0; n < nodes; n++)
            sum += (double)f->x[a][n] * (double)f->x[a][n];
    return sqrt(sum);
}

static int find_largest(level *l, pool *threads, err *e)
{
    lanes_field x = {0}, y = {0};
    power w = {l, lanes_choose(e), &x, &y};
    uint32_t seed = 1;
    int result = -1;
    if (!w.loops || lanes_field_make(&x, l->graph.nodes, e) || lanes_field_make(&y, l->graph.nodes, e))
        goto out;
    for (int64_t i = 0; i < 3 * l->graph.nodes; i++) {
        seed = seed * 1664525u + 1013904223u;
        x.x[i % 3][i / 3] = l->moves[i / 3] ? (float)(seed >> 8) / 16777216.f - .5f : 0;
    }
    for (int i = 0; i < POWERS; i++) {
        const double before = norm_of(&x, l->graph.nodes);
        pool_run(threads, l->graph.count, SELL_CHUNK, power_work, &w);
        const double after = norm_of(&y, l->graph.nodes);
        l->largest = before > 0 ? after / before : 1;
        for (int64_t k = 0; k < 3 * l->graph.nodes && after > 0; k++)
            x.x[k % 3][k / 3] = (float)((double)y.x[k % 3][k / 3] / after);
    }
    l->largest *= short_of;
    result = 0;
out:
    lanes_field_free(&x);
    lanes_field_free(&y);
    return result;
}

static int make_smoother(level *l, pool *threads, err *e)
{
    l->inverse = mem_array(l->graph.count, 9 * LANES * sizeof *l->inverse, "coarser lattices", e);
    if (!l->inverse)
        return -1;
    for (int64_t n = 0; n < l->graph.nodes; n++)
        if (l->moves[n])
            invert(l->matrix.diagonal + n / LANES * 9 * LANES + n % LANES,
                   l->inverse + n / LANES * 9 * LANES + n % LANES);
    return find_largest(l, threads, e);
}

/* The whole matrix of a level, row by row. */
static void spread_matrix(const level *l, double *a, int64_t order)
{
    const sell *g = &l->graph;
    for (int64_t n = 0; n < order / 3; n++)
        for (int64_t slot = g->start[n / LANES] - 1; slot < g->start[n / LANES + 1]; slot++) {
            const bool own = slot < g->start[n / LANES];
            const int64_t other = own ? n : g->neighbour[slot * LANES + n % LANES];
            const float *k = own ? l->matrix.diagonal + n / LANES * 9 * LANES : l->matrix.block + slot * 9 * LANES;
            for (int i = 0; i < 9; i++)
                a[(3 * n + i / 3) * order + 3 * other + i % 3] += (double)k[i * LANES + n % LANES];
        }
    for (int64_t i = 0; i < order; i++)
        a[i * order + i] = a[i * order + i] > 0 ? a[i * order + i] * (1 + shift) : 1;
}

/* In place, by Gauss and Jordan: symmetric and positive definite, so every pivot is above 0. */
static void invert_all(double *a, int64_t order)
{
    for (int64_t k = 0; k < order; k++) {
        double *pivot = a + k * order, by = 1 / pivot[k];
        pivot[k] = 1;
        for (int64_t j = 0; j < order; j++)
            pivot[j] *= by;
        for (int64_t i = 0; i < order; i++) {
            double *line = a + i * order, factor = line[k];
            if (i == k || factor == 0)
                continue;
            line[k] = 0;
            for (int64_t j = 0; j < order; j++)
                line[j] -= factor * pivot[j];
        }
    }
}

static int make_coarsest(levels *l, err *e)
{
    const level *last = &l->at[l->count - 1];
    l->order = 3 * last->graph.nodes;
    double *a = mem_array(l->order * l->order, sizeof *a, "coarser lattices", e);
    l->coarsest = mem_array(l->order * l->order, sizeof *l->coarsest, "coarser lattices", e);
    if (a && l->coarsest) {
        spread_matrix(last, a, l->order);
        invert_all(a, l->order);
        for (int64_t i = 0; i < l->order; i++) /* to the bit symmetric */
            for (int64_t j = 0; j < l->order; j++)
                l->coarsest[i * l->order + j] = (float)(.5 * (a[i * l->order + j] + a[j * l->order + i]));
    }
    free(a);
    return a && l->coarsest ? 0 : -1;
}

static int make_next(level *fine, level *coarse, pool *threads, err *e)
{
    lattice x = {0};
    int result = -1;
    if (!make_lattice(&x, fine, e) && !make_weights(fine, &x, e) && !make_product(fine, coarse, x.nodes, threads, e) &&
        !place_lattice(coarse, &x, e)) {
        coarse->matrix.s = &coarse->graph;
        result = make_smoother(coarse, threads, e);
    }
    free(x.node);
    return result;
}

int levels_make(levels *l, const msds_problem *p, const sell *s, const lanes_matrix *m, pool *threads, err *e)
{
    l->at[0].graph = *s;
    l->at[0].matrix = *m;
    l->count = 1;
    if (place_mesh(&l->at[0], p, e) || make_smoother(&l->at[0], threads, e))
        return -1;
    while (l->count == 1 || l->at[l->count - 1].graph.nodes > LEVELS_COARSEST) {
        if (l->count == LEVELS_MOST)
            return err_set(e, NULL, 0, "the mesh is too wide for %d coarser lattices", LEVELS_MOST);
        l->count++;
        if (make_next(&l->at[l->count - 2], &l->at[l->count - 1], threads, e))
            return -1;
    }
    return make_coarsest(l, e);
}

static void weights_free(levels_weights *w)
{
    free(w->start);
    free(w->column);
    free(w->weight);
}

void levels_free(levels *l)
{
    for (int i = 0; i < l->count; i++) {
        level *at = &l->at[i];
        if (i > 0) {
            sell_free(&at->graph);
            free(at->matrix.diagonal);
            free(at->matrix.block);
        }
        free(at->inverse);
        free(at->place);
        free(at->moves);
        weights_free(&at->up);
        weights_free(&at->down);
    }
    free(l->coarsest);
    *l = (levels){0};
}
