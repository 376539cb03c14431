/* A problem cut into tiles: every node owned once, every element owned once, and a pass over the tiles, each seeing no
 * more than its own lists, gives the internal forces of a pass over elements, to the last bit; and so when nodes stand
 * in another order, and where there are slits, of which bricks that none comes to are told nothing. And in rows: the
 * same.
 */
// needs: tled/tiles/tiles.c tled/tiles/bricks.c tled/tiles/tile_split.c tled/tiles/tile_parts.c
// needs: tled/tiles/lattice_sheet.c tled/tiles/places.c  tled/*/*.c
#include "mesh/lattice.h"
#include "physics/element_cut.h"
#include "tled/cpu/cpu.h"
#include "tled/cpu/rows.h"
#include "tled/tiles/tile_parts.h"
#include "tled/tiles/tiles.h"

#include "tap.h"
#include "tled_block.h"

#include <math.h>
#include <string.h>

static const block lump = {{17, 9, 6}, {.01, .02, .03}, 3000, .45, 1000, 30000, 0, 1, 0, {0, 1, 0}, 0, false};

static double moved(int64_t node, int a)
{
    return 1e-3 * sin((double)(3 * node + a));
}

static void force_of(const tled_problem *p, int64_t element, double u[8][3], double f[8][3])
{
    element_field at, g;
    const tled_volume *v = &p->volume[p->element_volume[element]];
    const tled_volume *w = tled_mix(p, element) < 0 ? v : &p->volume[p->mix[element]];
    const double share = tled_fraction(p, element), s = tled_mixture(p, element);
    const double own = share * (1 - s), other = share * s;
    const tled_law of = tled_law_of(p, element);
    element_law law = {.c = {share * of.c[0], share * of.c[1]}};
    for (int i = 0; i < HOURGLASS_NUMBERS; i++)
        law.hourglass[i] = share * of.hourglass[i];
    const float *d = p->fibre + 3 * element, *c2 = p->mixfibre ? p->mixfibre + 3 * element : d;
    element_fibre fibre = {{d[0], d[1], d[2]}, own * (.3 * v->peak), {0, 0, 0, 0}, {0, 0}},
                  second = {{c2[0], c2[1], c2[2]}, other * (.3 * w->peak), {0, 0, 0, 0}, {0, 0}};
    for (int c = 0; c < 8; c++)
        at.x.at[c] = u[c][0], at.y.at[c] = u[c][1], at.z.at[c] = u[c][2];
    const element_shape box = element_box(p->side[0], p->side[1], p->side[2]);
    const float *moments = tled_cut(p, element);
    g = moments ? element_force_cut(p->form, p->control.kind, at, box, law, fibre, 1, second, w != v, NULL, 0,
                                    element_cut_of(moments))
                : element_force_of_two(p->form, p->control.kind, at, box, law, fibre, 1, second, w != v);
    for (int c = 0; c < 8; c++)
        f[c][0] = g.x.at[c], f[c][1] = g.y.at[c], f[c][2] = g.z.at[c];
}

/* By elements: nodes x 3. */
static void by_elements(const tled_problem *p, double *sum)
{
    double u[8][3], f[8][3], *force = calloc((size_t)p->elements, sizeof f);
    for (int64_t i = 0; i < p->elements; i++) {
        for (int c = 0; c < 8; c++)
            for (int a = 0; a < 3; a++)
                u[c][a] = moved(p->element_node[8 * i + c], a);
        force_of(p, i, u, f);
        memcpy(force + 24 * i, f, sizeof f);
    }
    for (int64_t n = 0; n < p->nodes; n++)
        for (int a = 0; a < 3; a++) {
            sum[3 * n + a] = 0;
            for (int i = 0; i < 8 && p->corner[8 * n + i] < 8 * p->elements; i++)
                sum[3 * n + a] += force[3 * (int64_t)p->corner[8 * n + i] + a];
        }
    free(force);
}

typedef struct room { /* what a tile's threads share */
    double u[TILE_PLACES][3], f[TILE_PLACES][8][3];
    bool known[TILE_PLACES];
} room;

static int corner_step(const tiles *t, int c)
{
    return lattice_vtk[c][0] + t->grid[0] * (lattice_vtk[c][1] + t->grid[1] * lattice_vtk[c][2]);
}

/* Where a tile's k-th node stands. */
static int32_t stands(const tiles *t, const tile *own, int32_t k)
{
    return t->order ? t->order[own->node + k] : own->node + k;
}

static void load(const tiles *t, const tile *own, room *r)
{
    memset(r, 0, sizeof *r);
    for (int32_t k = 0; k < own->nodes + own->halos; k++) {
        bool inside = k < own->nodes;
        int32_t n = inside ? stands(t, own, k) : t->halo_node[own->halo + k - own->nodes];
        int place = inside ? (int)(t->node_info[n] & TILE_PLACE) : t->halo_place[own->halo + k - own->nodes];
        r->known[place] = true;
        for (int a = 0; a < 3; a++)
            r->u[place][a] = moved(t->node[n], a);
    }
}

/* Where corner c of a tile's k-th cell is. */
static int place_of(const tiles *t, const tile *own, int32_t k, int c)
{
    return (int)(t->cell[own->cell + k] & TILE_PLACE) + corner_step(t, c);
}

/* Adds what a tile's cells pull its k-th node with. */
static void pull(const tiles *t, const tile *own, int32_t k, const room *r, double *sum)
{
    static const int order[8] = {6, 7, 5, 4, 2, 3, 1, 0};
    const uint32_t info = t->node_info[stands(t, own, k)];
    const int32_t list = t->list ? t->list[own - t->tile] : -1;
    for (int i = 0; i < 8; i++) {
        int corner = order[i], place = (int)(info & TILE_PLACE) - corner_step(t, corner);
        bool is = info >> (TILE_CORNERS + corner) & 1;
        if (list >= 0) {
            const uint16_t entry = t->pull[8 * (int64_t)(list + k) + i];
            is = entry != TILE_NO_PULL;
            corner = entry >> TILE_PULL, place = entry & TILE_PLACE;
        }
        for (int a = 0; is && a < 3; a++)
            sum[a] += r->f[place][corner][a];
    }
}

/* That a tile has no more than kernels have room for. */
static bool fits(const tiles *t, const tile *own)
{
    const int *b = t->brick, *g = t->grid, nodes = b[0] * b[1] * b[2];
    int own_cells = 0;
    for (int32_t k = 0; k < own->cells; k++)
        own_cells += (int)(t->cell[own->cell + k] >> TILE_OWN & 1);
    return own->nodes <= nodes && own->halos <= g[0] * g[1] * g[2] - nodes &&
           own->cells <= (b[0] + 1) * (b[1] + 1) * (b[2] + 1) && own_cells <= nodes;
}

/* By tiles. Returns whether every corner of a cell was known, and volumes and fibres are the elements'. */
static bool by_tiles(const tled_problem *p, const tiles *t, double *sum, int *owned)
{
    bool good = true;
    room *r = malloc(sizeof *r);
    for (const tile *own = t->tile; own < t->tile + t->count; own++) {
        load(t, own, r);
        good &= fits(t, own);
        for (int32_t k = 0; k < own->cells; k++) {
            double u[8][3];
            uint32_t cell = t->cell[own->cell + k];
            int32_t element = t->cell_element[own->cell + k];
            int place = (int)(cell & TILE_PLACE);
            for (int c = 0; c < 8; c++) {
                good &= r->known[place_of(t, own, k, c)];
                memcpy(u[c], r->u[place_of(t, own, k, c)], sizeof u[c]);
            }
            force_of(p, element, u, r->f[place]);
            owned[element] += (int)(cell >> TILE_OWN & 1);
            good &= (int32_t)(cell >> TILE_VOLUME) == p->element_volume[element];
            good &= t->share ? t->share[own->cell + k] == p->fraction[element] : !p->fraction;
            good &= t->cut ? t->cut[own->cell + k] == cut_moments_row(&p->cut, element) : !p->cut.count;
            good &= t->mixed ? t->mixed[own->cell + k] == p->mixed[element] : !p->mix;
            good &= k >= own->fibred || !t->mixfibre ||
                    !memcmp(t->mixfibre + 3 * (own->direction + k), p->mixfibre + 3 * element, 12);
            good &= k >= own->fibred || !memcmp(t->fibre + 3 * (own->direction + k), p->fibre + 3 * element, 12);
        }
        for (int32_t k = 0; k < own->nodes; k++)
            pull(t, own, k, r, sum + 3 * (int64_t)t->node[stands(t, own, k)]);
    }
    free(r);
    return good;
}

/* Whether what the script does to nodes is listed as they stand. */
static bool are_extras(const tled_problem *p, const tiles *t)
{
    int64_t next = 0;
    for (int32_t at = 0; at < t->nodes; at++) {
        const int32_t n = t->node[at];
        if (!(t->node_info[at] >> TILE_EXTRA & 1))
            continue;
        if (next == t->extras || t->extra[next].node != at ||
            memcmp(t->extra[next].hold, p->hold + 3 * (int64_t)n, sizeof t->extra->hold) ||
            t->extra[next].forces != p->force_start[n + 1] - p->force_start[n])
            return false;
        next++;
    }
    return next && next == t->extras;
}

/* An order with no two neighbours as they were. */
static int reorder(tiles *t, err *e)
{
    int32_t *order = calloc((size_t)t->nodes, sizeof *order);
    if (!order)
        exit(1);
    for (int64_t n = 0, half = (t->nodes + 1) / 2; n < t->nodes; n++)
        order[n] = (int32_t)(n < half ? 2 * n : 2 * (n - half) + 1);
    const int failed = tiles_reorder(t, order, NULL, e);
    free(order);
    return failed;
}

static void test_pass(const tled_problem *p, const int brick[3], bool other)
{
    tiles t;
    err e = {0};
    double *want = calloc((size_t)p->nodes * 3, sizeof *want), *got = calloc((size_t)p->nodes * 3, sizeof *got);
    int *owned = calloc((size_t)p->elements, sizeof *owned), once = 0;
    if (!want || !got || !owned)
        exit(1);
    int failed = tiles_make(&t, p, brick, &e) || (other && reorder(&t, &e));
    ok(!failed && t.count > 1, "bricks of %d x %d x %d%s: %lld tiles, %.3g cells an element %s", brick[0], brick[1],
       brick[2], other ? ", another order" : "", (long long)t.count, (double)t.cells / (double)p->elements, e.text);
    by_elements(p, want);
    ok(!failed && are_extras(p, &t), "%lld nodes have extras", (long long)t.extras);
    ok(!failed && by_tiles(p, &t, got, owned), "each knows what it needs");
    for (int64_t i = 0; i < p->elements; i++)
        once += owned[i] == 1;
    ok(once == p->elements, "every element is owned once");
    ok(!memcmp(want, got, (size_t)p->nodes * 3 * sizeof *want), "and the forces at all nodes are the same bytes");
    tiles_free(&t);
    free(want);
    free(got);
    free(owned);
}

/* Of what a group computes side by side: which lanes its stretches fill, and that its elements are of one kind. */
static bool group_is_good(const tled_problem *p, const rows *r, const rows_group *g)
{
    const rows_stretch *s = r->stretch + g->stretch;
    bool good = g->count <= r->lanes && g->stretches > 0;
    int lane = 0;
    for (int k = 0; k < g->stretches; k++) {
        good &= s[k].lane == lane && s[k].count > 0 && (s[k].regular || s[k].count == 1);
        for (int i = 0; i < s[k].count; i++)
            for (int c = 0; c < 8; c++)
                good &= r->place[p->element_node[8 * r->cell_element[g->cell + lane + i] + c]] == s[k].node[c] + i;
        lane += s[k].count;
    }
    for (int i = 0; i < g->count; i++) {
        const int64_t element = r->cell_element[g->cell + i];
        good &= p->element_volume[element] == g->volume && tled_mix(p, element) == g->mix &&
                (tled_cut(p, element) != NULL) == (g->cut >= 0) &&
                (tled_border(p, element) != NULL) == (g->border >= 0);
    }
    return good && lane == g->count;
}

/* Counts what terms take: each force that belongs to a node of a block's sums, once. seat: the element in each lane of
 * each seat. */
static bool block_is_added(const tled_problem *p, const rows *r, const rows_block *l, const int32_t *seat, int *covered)
{
    bool good = true;
    for (const rows_sum *s = r->sum + l->sum; s < r->sum + l->sum + l->sums; s++)
        for (const rows_term *t = r->term + s->term; t < r->term + s->term + s->terms; t++)
            for (int i = 0; i < r->lanes; i++) {
                if (!(t->bits >> i & 1))
                    continue;
                const int64_t at = t->at + i, lane = at % r->lanes, corner = at / r->lanes % 24;
                const int64_t element = seat[at / r->lanes / 24 * r->lanes + lane];
                good &= corner < 8 && element >= 0 && r->place[p->element_node[8 * element + corner]] == s->node + i;
                if (good)
                    covered[8 * element + corner]++;
            }
    return good;
}

/* Each corner of each element is added once, by the slab that owns its node, and before the node has its sum; nodes are
 * each in one block. */
static void test_rows(const tled_problem *p, int lanes, int slabs)
{
    rows r;
    err e = {0};
    int failed = rows_make(&r, p, lanes, slabs, &e);
    int *covered = calloc((size_t)p->elements * 8, sizeof *covered), good = 1;
    uint8_t *seen = calloc((size_t)r.nodes + 1, 1);
    int32_t *seat = calloc((size_t)r.seats * lanes + 1, sizeof *seat);
    if (!covered || !seen || !seat)
        exit(1);
    for (const rows_block *l = r.block; l < r.block + r.blocks; l++) {
        for (const rows_group *g = r.group + l->group; g < r.group + l->group + l->groups; g++) {
            good &= group_is_good(p, &r, g);
            for (int i = 0; i < lanes; i++)
                seat[g->seat * lanes + i] = i < g->count ? r.cell_element[g->cell + i] : -1;
        }
        good &= block_is_added(p, &r, l, seat, covered);
        for (const rows_sum *s = r.sum + l->sum; s < r.sum + l->sum + l->sums; s++)
            for (const rows_term *t = r.term + s->term; t < r.term + s->term + s->terms; t++)
                for (int i = 0; i < lanes; i++)
                    good &= !(t->bits >> i & 1) || !seen[s->node + i];
        for (int32_t n = 0; n < l->nodes; n++)
            good &= !seen[l->node + n]++;
    }
    for (int64_t i = 0; i < 8 * p->elements; i++)
        good &= covered[i] == 1;
    for (int64_t n = 0; n < p->nodes; n++)
        good &= seen[r.place[n]];
    ok(!failed && good && r.slabs <= slabs, "rows of %d lanes, %d slabs: %d groups, %.3g cells an element %s", lanes,
       r.slabs, r.groups, (double)r.cells / (double)p->elements, e.text);
    rows_free(&r);
    free(covered);
    free(seen);
    free(seat);
}

/* What the CPU's executor finds, by rows, against the pass over elements. The displacement at the start is moved(). */
static void test_cpu(const tled_problem *p, int threads, const char *name)
{
    err e = {0};
    pool *threads_of = pool_create(threads, &e);
    double *want = calloc((size_t)p->nodes * 3, sizeof *want), *got = calloc((size_t)p->nodes * 3, sizeof *got);
    tled_state *state = threads_of ? tled_cpu_double.create(p, threads_of, &e) : NULL;
    if (!want || !got || !state) {
        printf("Bail out! %s\n", e.text);
        exit(1);
    }
    by_elements(p, want);
    tled_cpu_double.get(state, TLED_INTERNAL, got, &e);
    ok(!memcmp(want, got, (size_t)p->nodes * 3 * sizeof *want), "%s, %d threads: the same forces", name, threads);
    tled_cpu_double.destroy(state);
    pool_destroy(threads_of);
    free(want);
    free(got);
}

static void make(model *m, script *s, tled_problem *p)
{
    err e = {0};
    if (tled_problem_make(p, m, s, PHYSICAL, &e)) {
        printf("Bail out! %s\n", e.text);
        exit(1);
    }
}

static void add_pulls(script *s, const model *m)
{
    static const char text[] = "0 force .08,.09,.09 .05 1,2,3\n0 displace .1,.1,.1,.2,.15,.2 -,0,0\n";
    err e = {0};
    in *source = in_memory(text, sizeof text - 1, "script", &e);
    ok(source && !script_read(s, source, m, &e), "and nodes are pulled %s", e.text);
    in_close(source);
}

static void test_block(const block *what, const char *name)
{
    static const int bricks[][3] = {{4, 4, 4}, {8, 8, 4}, {8, 8, 8}, {2, 3, 4}};
    model m = {0};
    script s = {0};
    tled_problem p = {0};
    err e = {0};
    block_make(what, &m);
    ok(!script_add_contract(&s, &m, what->mixed ? "m=.3,n=.3" : "m=.3", 0, &e), "a muscle contracts %s", e.text);
    add_pulls(&s, &m);
    make(&m, &s, &p);
    for (int i = 0; i < 4; i++)
        test_pass(&p, bricks[i], false), test_pass(&p, bricks[i], true);
    for (int i = 1; i < 9; i++)
        test_rows(&p, i < 5 ? 4 : 16, i * i);
    for (int64_t i = 0; i < 3 * p.nodes; i++)
        p.at_start.of[TLED_DISPLACEMENT][i] = moved(i / 3, (int)(i % 3));
    for (int threads = 1; threads < 4; threads++)
        test_cpu(&p, threads, name);
    tled_problem_free(&p);
    script_free(&s);
    model_free(&m);
}

typedef struct blocks { /* a problem with arrays of its own */
    tled_problem p;
    double *position;
    float *fibre;
    int32_t *node, *volume;
} blocks;

/* Two blocks, one on the other, whose nodes between them stand twice: two parts; or, where `joined`, one, as they have
 * the first of these nodes in common (the other copy of it is in no element). */
static void make_blocks(blocks *b, const tled_problem *p, const block *what, bool joined)
{
    const int64_t nodes = p->nodes, elements = p->elements, corners = 8 * elements;
    tled_problem *both = &b->p;
    *both = *p;
    both->nodes *= 2;
    both->elements *= 2;
    both->position = b->position = malloc(6 * (size_t)nodes * sizeof *b->position);
    both->element_node = b->node = malloc(2 * (size_t)corners * sizeof *b->node);
    both->element_volume = b->volume = calloc(2 * (size_t)elements, sizeof *b->volume);
    both->corner = malloc(16 * (size_t)nodes * sizeof *both->corner);
    both->hold = calloc((size_t)both->nodes * 3, sizeof *both->hold);
    both->force_start = calloc((size_t)both->nodes + 2, sizeof *both->force_start);
    if (!b->position || !b->node || !b->volume || !both->corner || !both->hold || !both->force_start)
        exit(1);
    for (int64_t i = 0; i < 6 * nodes; i++)
        b->position[i] = p->position[i % (3 * nodes)] + (i >= 3 * nodes && i % 3 == 2 ? 3 * what->side[2] : 0);
    for (int64_t i = 0; i < 2 * corners; i++)
        b->node[i] = p->element_node[i % corners] + (i >= corners ? (int32_t)nodes : 0);
    for (int64_t i = 0; i < 16 * nodes; i++) {
        int32_t c = p->corner[i % (8 * nodes)];
        both->corner[i] = c == corners ? (int32_t)(2 * corners) : c + (i >= 8 * nodes ? (int32_t)corners : 0);
    }
    if (joined) { /* corner 0 of the first element above is the node below, whose second element it is */
        const int64_t below = block_node(what, 0, 0, 3);
        b->node[corners] = (int32_t)below;
        both->corner[8 * below + 1] = (int32_t)corners;
        both->corner[8 * nodes] = (int32_t)(2 * corners);
    }
}

/* Every node is free, and moved. */
static void move_blocks(blocks *b)
{
    tled_problem *p = &b->p;
    p->mass = calloc((size_t)p->nodes, sizeof *p->mass);
    p->fields = tled_fields(p->nodes, p->elements);
    p->fibre = b->fibre = calloc((size_t)p->elements * 3, sizeof *b->fibre);
    if (!p->mass || !b->fibre || fields_allocate(&p->fields, FIELDS_ALL, &p->at_start, "a test", &(err){0}))
        exit(1);
    for (int64_t i = 0; i < 3 * p->nodes; i++) {
        p->hold[i] = HOLD_FREE;
        p->mass[i / 3] = 1;
        p->at_start.of[TLED_DISPLACEMENT][i] = moved(i / 3, (int)(i % 3));
    }
}

static void test_slit(bool joined)
{
    static const int brick[3] = {4, 4, 4};
    const block what = {{5, 4, 3}, {.01, .01, .01}, 3000, .45, 1000, 30000, 0, 0, 0, {0, 0, 0}, 0, false};
    model m = {0};
    script s = {0};
    tled_problem p = {0};
    blocks both;
    tiles t;
    err e = {0};
    block_make(&what, &m);
    make(&m, &s, &p);
    make_blocks(&both, &p, &what, joined);
    move_blocks(&both);
    int failed = tiles_make(&t, &both.p, brick, &e);
    if (joined)
        ok(!failed && t.nodes == 2 * p.nodes && t.list, "a slit: %lld of %lld nodes are listed %s", (long long)t.listed,
           (long long)t.nodes, e.text);
    else
        ok(!failed && t.nodes == 2 * p.nodes && !t.list, "two parts that touch are none %s", e.text);
    for (int threads = 1; threads < 4; threads++)
        test_cpu(&both.p, threads, joined ? "a slit in rows" : "two parts in rows");
    tiles_free(&t);
    free(both.position);
    free(both.node);
    free(both.volume);
    free(both.fibre);
    free(both.p.corner);
    free(both.p.hold);
    free(both.p.force_start);
    free(both.p.mass);
    fields_free(&both.p.at_start);
    tled_problem_free(&p);
    script_free(&s);
    model_free(&m);
}

static void test_slits(void)
{
    for (int i = 0; i < SLITS; i++) {
        block what = lump;
        what.fraction = i % 3 ? -1 : 0;
        what.mixed = i % 3 == 2;
        what.cells[1] = slits[i].thin ? 1 : what.cells[1];
        what.side[1] = slits[i].thin ? .1 : what.side[1];
        in_slit = &slits[i];
        printf("# %s\n", slits[i].name);
        test_block(&what, slits[i].name);
    }
    in_slit = NULL;
}

int main(void)
{
    block cut = lump;
    cut.fraction = -1;
    block mixed = cut;
    mixed.mixed = true;
    test_block(&lump, "whole elements");
    test_block(&cut, "cut elements");
    test_block(&mixed, "elements mixed of two muscles");
    in_cuts = true;
    test_block(&mixed, "elements of parts, mixed of two muscles");
    in_cuts = false;
    test_slit(false);
    test_slit(true);
    test_slits();
    return done_testing();
}
