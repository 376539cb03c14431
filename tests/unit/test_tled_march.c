/* A problem cut for a march: every node is moved by one unit, which has all of its elements, with their own corners;
 * what is said of special cells is the problem's, and others are of the plain law. Nodes stand in one order, in which
 * what is owned of a layer is one piece. So with slits, whose tips have units of their own. With each of the six axes;
 * and not where too few threads would have a cell. Which units wait for which, by trying all pairs; and that none waits
 * for one whose turn comes long after its own. And units: some for
 * each block that there is room for at once where their layers are all alike, in the order of these.
 */
// needs: tled/cuda/march.c tled/cuda/march_units.c tled/cuda/march_near.c tled/cuda/march_tips.c
// needs: tled/cuda/march_cells.c tled/tiles/lattice_sheet.c tled/tiles/places.c  tled/*/*.c
#include "mesh/lattice.h"
#include "tled/cuda/march_near.h"
#include "tled/cuda/march_units.h"

#include "tap.h"
#include "tled_block.h"

#include <math.h>
#include <string.h>

typedef struct seen {
    const tled_problem *p;
    const march *m;
    int32_t *node;    /* of the march's order: the problem's */
    int32_t *element; /* nodes: whose low corner it is, or -1 */
    int32_t *elements, *moved;
    int64_t wrong, special;
} seen;

/* The thread of a place, as march.h has them. */
static int thread_of(int i, int j)
{
    const int warp = i < 8 ? j / 4 : 4 + (j / 4 + 2) % 4;
    return 32 * warp + 8 * (j % 4) + i % 8;
}

/* The word of a place in a layer, as march.h orders them. */
static uint32_t word_at(const march *m, int64_t layer, int i, int j)
{
    const uint32_t *word = m->word + layer * MARCH_WORDS;
    if (i == MARCH_SIDE)
        return word[MARCH_THREADS + j];
    if (j == MARCH_SIDE)
        return word[MARCH_THREADS + MARCH_SIDE + 1 + i];
    return word[thread_of(i, j)];
}

static int32_t node_of(const seen *s, uint32_t word)
{
    return s->node[word & MARCH_NODE];
}

/* Whether owned nodes stand as they come in layers, each in a row of its place; and all
 * nodes are owned. Notes which stands where. */
static bool in_order(seen *s)
{
    int32_t next = 0;
    for (int32_t n = 0; n < s->p->nodes; n++)
        if (s->m->order[n] >= 0 && s->m->order[n] < s->p->nodes)
            s->node[s->m->order[n]] = n;
    for (int32_t n = 0; n < s->p->nodes; n++)
        s->wrong += s->m->order[s->node[n]] != n;
    for (int64_t layer = 0; layer < s->m->layers; layer++)
        for (int j = 0; j <= MARCH_SIDE; j++)
            for (int i = 0; i <= MARCH_SIDE; i++) {
                const uint32_t word = word_at(s->m, layer, i, j);
                s->wrong += word & MARCH_OWN && (int32_t)(word & MARCH_NODE) != next;
                next += (word & MARCH_OWN) != 0;
            }
    return !s->wrong && next == s->m->tip_first && next + s->m->tips == s->p->nodes;
}

static int corner_of(const march *m, const int way[3])
{
    int at[3], c = 0;
    for (int a = 0; a < 3; a++)
        at[m->axis[a]] = way[a];
    while (memcmp((int[]){lattice_vtk[c][0], lattice_vtk[c][1], lattice_vtk[c][2]}, at, sizeof at) != 0)
        c++;
    return c;
}

/* Whether a special cell has the muscle of a volume of an element, if that may contract; at: its next. */
static bool has_muscle(const seen *s, const march_cell *cell, int *at, const float *fibre, int32_t volume, double share)
{
    const tled_volume *v = &s->p->volume[volume];
    if (!fibre || v->contract < 0)
        return true;
    const int k = (*at)++;
    const march_muscle *muscle = &cell->muscle[k];
    bool good = (muscle->curve & ~MARCH_SECOND) == (int32_t)v->contract &&
                (k ? cell->second_peak : cell->peak) == share * v->peak;
    for (int a = 0; a < 3; a++)
        good &= muscle->fibre[a] == fibre[s->m->axis[a]];
    return good;
}

/* Whether what a special cell has of moments, the number of which is `number`, is its element's: numbers below those of
 * others are cut cells'. */
static bool has_cut(const seen *s, int32_t number, int32_t element)
{
    static const int product[3][3] = {{0, 3, 5}, {3, 0, 4}, {5, 4, 0}}; /* of two axes: its column */
    const float *moments = tled_cut(s->p, element);
    const int32_t *x = s->m->axis;
    if (!moments || number >= s->m->cuts)
        return !moments && number >= s->m->cuts;
    const march_cut *c = &s->m->cut[number];
    return c->x == moments[x[0]] && c->y == moments[x[1]] && c->z == moments[x[2]] &&
           c->xy == moments[product[x[0]][x[1]]] && c->yz == moments[product[x[1]][x[2]]] &&
           c->zx == moments[product[x[2]][x[0]]];
}

static void see_special(seen *s, int64_t layer, int i, int j, int32_t element)
{
    const tled_problem *p = s->p;
    const int32_t *which = s->m->which + MARCH_THREADS * (int64_t)s->m->detail[layer];
    const march_cell *cell = &s->m->cell[which[thread_of(i, j)] - 1];
    const tled_law law = tled_law_of(p, element);
    const double share = tled_fraction(p, element), other = tled_mixture(p, element);
    const int32_t mix = tled_mix(p, element);
    int muscles = 0;
    s->special++;
    s->wrong += !has_cut(s, (int32_t)(cell - s->m->cell), element);
    s->wrong += cell->mu != share * law.mu || cell->bulk != share * law.bulk ||
                cell->second != (p->control.kind == HOURGLASS_ISOTROPIC ? share * law.hourglass[HOURGLASS_K] : 0);
    s->wrong += !has_muscle(s, cell, &muscles, p->fibre ? p->fibre + 3 * (int64_t)element : NULL,
                            p->element_volume[element], share * (1 - other));
    s->wrong += mix >= 0 && !has_muscle(s, cell, &muscles, p->mixfibre ? p->mixfibre + 3 * (int64_t)element : NULL, mix,
                                        share * other);
    const int32_t first = cell->muscle[0].curve;
    int expected = 0;
    if (first >= 0)
        expected = first & MARCH_SECOND ? 2 : 1;
    s->wrong += muscles != expected || (muscles < 2 && cell->muscle[1].curve >= 0);
}

/* Whether an element is all of the plain law, and nothing of it may contract. */
static bool is_plain(const seen *s, int32_t element)
{
    const tled_problem *p = s->p;
    const tled_law law = tled_law_of(p, element);
    const tled_law *plain = &p->volume[s->m->plain].law;
    const int32_t mix = tled_mix(p, element);
    return tled_fraction(p, element) == 1 && !tled_cut(p, element) && law.mu == plain->mu && law.bulk == plain->bulk &&
           law.hourglass[HOURGLASS_K] == plain->hourglass[HOURGLASS_K] &&
           !(p->fibre && p->volume[p->element_volume[element]].contract >= 0) &&
           !(p->mixfibre && mix >= 0 && p->volume[mix].contract >= 0);
}

/* A cell of a unit: its corners, and which of them the unit moves. */
static void see_cell(seen *s, const march_unit *u, int c, int i, int j)
{
    const uint32_t own = word_at(s->m, u->base + c, i, j);
    const int32_t element = own & MARCH_THERE ? s->element[node_of(s, own)] : -1;
    if (element < 0) {
        s->wrong++;
        return;
    }
    if (own & MARCH_SPECIAL)
        see_special(s, u->base + c, i, j, element);
    else
        s->wrong += !is_plain(s, element);
    for (int k = 0; k < 8; k++) {
        const int way[3] = {k & 1, k >> 1 & 1, k >> 2};
        const int layer = c + way[2];
        const uint32_t word = word_at(s->m, u->base + layer, i + way[0], j + way[1]);
        const int32_t node = node_of(s, word);
        s->wrong += !(word & MARCH_THERE) || node != s->p->element_node[8 * (int64_t)element + corner_of(s->m, way)];
        if (word & MARCH_OWN && layer > 0 && layer < u->cells)
            s->elements[node]++;
    }
}

/* Tips of a unit: each has all of its elements, in the problem's order, with their corners. */
static void see_tips(seen *s, const march_unit *u)
{
    for (int32_t k = u->base; k < u->base + u->tips; k++) {
        const int32_t node = s->node[s->m->tip_first + k];
        s->moved[node]++;
        for (int i = 0; i < 8; i++) {
            const march_tip *tip = &s->m->tip[8 * (int64_t)k + i];
            const int32_t corner = s->p->corner[8 * (int64_t)node + i];
            if (tip->corner < 0)
                continue;
            s->elements[node]++;
            s->wrong += corner >= 8 * s->p->elements || s->node[tip->node[tip->corner]] != node;
            s->wrong += tip->special ? !has_cut(s, tip->special - 1, corner / 8) : !is_plain(s, corner / 8);
            for (int c = 0; c < 8; c++) {
                const int way[3] = {c & 1, c >> 1 & 1, c >> 2};
                s->wrong +=
                    s->node[tip->node[c]] != s->p->element_node[8 * (int64_t)(corner / 8) + corner_of(s->m, way)];
            }
        }
    }
}

static void see_unit(seen *s, const march_unit *u)
{
    if (u->tips) {
        see_tips(s, u);
        return;
    }
    for (int c = 0; c < u->cells; c++)
        for (int j = 0; j < MARCH_SIDE; j++)
            for (int i = 0; i < MARCH_SIDE; i++) {
                const uint32_t word = word_at(s->m, u->base + c, i, j);
                if (word & MARCH_OWN && c > 0)
                    s->moved[node_of(s, word)]++;
                if (word & MARCH_CELL)
                    see_cell(s, u, c, i, j);
            }
}

static bool all_seen(seen *s)
{
    const tled_problem *p = s->p;
    for (int32_t n = 0; n < p->nodes; n++)
        s->element[n] = -1;
    for (int32_t i = 0; i < p->elements; i++)
        s->element[p->element_node[8 * (int64_t)i]] = i;
    for (int64_t i = 0; i < s->m->units; i++)
        see_unit(s, &s->m->unit[i]);
    for (int32_t n = 0; n < p->nodes; n++) {
        int at = 0;
        while (at < 8 && p->corner[8 * (int64_t)n + at] < 8 * p->elements)
            at++;
        s->wrong += s->moved[n] != 1 || s->elements[n] != at;
    }
    return !s->wrong;
}

/* has[unit x nodes + node]: whether one of the unit's words has it; own: whether it moves it. */
static void see_nodes(const march *m, int64_t nodes, uint8_t *has, uint8_t *own)
{
    for (int64_t i = 0; i < m->units; i++) {
        const march_unit *u = &m->unit[i];
        for (int32_t k = u->base; k < u->base + u->tips; k++) {
            own[i * nodes + m->tip_first + k] = 1;
            for (const march_tip *tip = m->tip + 8 * (int64_t)k; tip < m->tip + 8 * (int64_t)(k + 1); tip++)
                for (int c = 0; tip->corner >= 0 && c < 8; c++)
                    has[i * nodes + tip->node[c]] = 1;
        }
        for (int c = 0; !u->tips && c <= u->cells; c++)
            for (int k = 0; k < MARCH_WORDS; k++) {
                const uint32_t word = m->word[(m->unit[i].base + c) * (int64_t)MARCH_WORDS + k];
                const int64_t at = i * nodes + (int64_t)(word & MARCH_NODE);
                if (word & MARCH_THERE)
                    has[at] = 1;
                if (word & MARCH_OWN && c > 0 && c < m->unit[i].cells)
                    own[at] = 1;
            }
    }
}

static bool share_nodes(const uint8_t *has, const uint8_t *own, int64_t nodes)
{
    for (int64_t n = 0; n < nodes; n++)
        if (has[n] && own[n])
            return true;
    return false;
}

/* Whether a row of `near` has a unit so many times, and ends with nothing but -1. */
static bool has_times(const march *m, int64_t row, int32_t unit, int times)
{
    const int32_t *near = m->near + row * m->nears;
    bool over = false;
    for (int64_t k = 0; k < m->nears; k++) {
        if (near[k] < -1 || near[k] >= m->units || (over && near[k] != -1))
            return false;
        over |= near[k] == -1;
        times -= near[k] == unit;
    }
    return times == 0;
}

/* Whether each unit waits for itself, and for those that have nodes which it moves or move
 * what it has, once; *most: for how many. */
static bool near_right(const march *m, int64_t nodes, int64_t *most)
{
    uint8_t *has = calloc((size_t)(m->units * nodes), 2), *own = has + m->units * nodes;
    int64_t wrong = m->nears % 32;
    see_nodes(m, nodes, has, own);
    *most = 0;
    for (int64_t i = 0; i < m->units; i++) {
        int64_t count = 0;
        for (int64_t k = 0; k < m->units; k++) {
            const bool is = i == k || share_nodes(has + i * nodes, own + k * nodes, nodes) ||
                            share_nodes(has + k * nodes, own + i * nodes, nodes);
            wrong += !has_times(m, i, (int32_t)k, is);
            count += is;
        }
        *most = count > *most ? count : *most;
    }
    free(has);
    return !wrong;
}

/* contract: what does, or NULL. */
static void test_cut(const block *what, const int axis[3], const char *contract, int64_t slots, const char *name)
{
    model m = {0};
    script played = {0};
    tled_problem p = {0};
    march cut;
    err e = {0};
    block_make(what, &m);
    if (contract && script_add_contract(&played, &m, contract, .1, &e))
        printf("Bail out! %s\n", e.text);
    if (tled_problem_make(&p, &m, &played, PHYSICAL, &e))
        printf("Bail out! %s\n", e.text);
    int32_t *list = calloc((size_t)p.nodes * 4, sizeof *list);
    const int failed = march_make(&cut, &p, slots, &e);
    seen s = {&p, &cut, list, list + p.nodes, list + 2 * p.nodes, list + 3 * p.nodes, 0, 0};
    ok(!failed && cut.units > 0 && in_order(&s), "%s: nodes stand as they are owned %s", name, e.text);
    ok(cut.units > 0 && !memcmp(cut.axis, axis, sizeof cut.axis) && all_seen(&s),
       "%s: rows along %c, across %c, %lld units, %.3g threads an element: each node moved once, of all its elements",
       name, "xyz"[cut.axis[0]], "xyz"[cut.axis[1]], (long long)cut.units, cut.computed);
    ok((contract || what->mixed || what->fraction < 0 || in_cuts) == (s.special > 0),
       "%s: %lld special cells are the problem's", name, (long long)s.special);
    const slit_piece *piece = in_slit ? &in_slit->piece[0] : NULL;
    const bool ends = piece && piece->high[0] < what->cells[(piece->axis + 1) % 3]; /* within the block */
    ok(ends == (cut.tips > 0), "%s: %lld tips", name, (long long)cut.tips);
    int64_t most = 0;
    const bool is_near = cut.units > 1 && near_right(&cut, p.nodes, &most);
    ok(is_near, "%s: units wait for those near them, at most %lld", name, (long long)most);
    march_free(&cut);
    free(list);
    tled_problem_free(&p);
    script_free(&played);
    model_free(&m);
}

/* A row of elements is too thin. */
static void test_thin(void)
{
    const block thin = {{1, 1, 200}, {.01, .01, .01}, 3000, .45, 1000, 30000, 0, 1, 0, {0, 0, 0}, 0, false};
    model m = {0};
    script played = {0};
    tled_problem p = {0};
    march cut;
    err e = {0};
    block_make(&thin, &m);
    const int failed = tled_problem_make(&p, &m, &played, PHYSICAL, &e) || march_make(&cut, &p, 396, &e);
    ok(!failed && cut.units == 0 && !cut.order, "a row of elements is none for a march: %.3g threads an element %s",
       cut.computed, e.text);
    march_free(&cut);
    tled_problem_free(&p);
    model_free(&m);
}

/* Three units of a node each, in the middle one of three layers; one of them has another's as well, in any of its
 * layers, and that one nothing of it: both wait all the same. */
static void test_one_way(void)
{
    enum { UNITS = 3, LAYERS = 3 * UNITS };
    int64_t most = 0, wrong = 0;
    err e = {0};
    for (int layer = 0; layer < LAYERS; layer++)
        for (uint32_t other = 0; other < UNITS; other++) {
            march_unit unit[UNITS];
            march m = {.layers = LAYERS, .units = UNITS, .unit = unit};
            m.word = calloc(LAYERS * MARCH_WORDS, sizeof *m.word);
            for (int32_t i = 0; i < UNITS; i++) {
                unit[i] = (march_unit){.base = 3 * i, .cells = 2};
                m.word[(3 * i + 1) * MARCH_WORDS + 40] = (uint32_t)i | MARCH_THERE | MARCH_OWN;
            }
            m.word[layer * MARCH_WORDS + MARCH_WORDS - 8] = other | MARCH_THERE;
            wrong += march_near_find(&m, UNITS, &e) || !near_right(&m, UNITS, &most);
            m.unit = NULL;
            march_free(&m);
        }
    ok(!wrong, "a unit that has another's node: %lld wrong of %d", (long long)wrong, LAYERS * UNITS);
}

static void test_units(void)
{
    march_runs runs = {0};
    march_unit *unit = NULL;
    int64_t units = 0, wrong = 0;
    uint8_t warps[100];
    bool special[100] = {0};
    err e = {0};
    memset(warps, 0xff, sizeof warps);
    for (int i = 0; i < 6; i++)
        ok(!march_runs_add(&runs, 102 * i, warps, special, 100, false, &e), "a run is added");
    const int failed = march_runs_cut(&runs, 44, &unit, &units, &e);
    for (int64_t i = 0; i < units; i++)
        wrong += unit[i].base != 102 * (i / 10) + 10 * (i % 10) || unit[i].cells != 11;
    ok(!failed && units == 60 && !wrong, "600 layers for 44 blocks: %lld units of 10 in their order, %lld not so",
       (long long)units, (long long)wrong);
    free(unit);
    march_runs_free(&runs);
}

/* A layer costs 10, with special cells 14. */
static void test_special_units(void)
{
    march_runs runs = {0};
    march_unit *unit = NULL;
    int64_t units = 0, layers = 0;
    double most = 0, least = 1e9;
    uint8_t warps[100];
    bool special[100] = {0};
    err e = {0};
    memset(warps, 0xff, sizeof warps);
    memset(special, true, 50);
    const int failed =
        march_runs_add(&runs, 0, warps, special, 100, false, &e) || march_runs_cut(&runs, 9, &unit, &units, &e);
    for (int64_t i = 0; i < units; i++) {
        double cost = 0;
        for (int32_t k = 0; k < unit[i].cells - 1; k++)
            cost += special[layers++] ? 14 : 10;
        most = fmax(most, cost);
        least = fmin(least, cost);
    }
    ok(!failed && units == 12 && layers == 100 && most - least <= 14,
       "100 layers, half of them special: %lld units that cost %g to %g", (long long)units, least, most);
    free(unit);
    march_runs_free(&runs);
}

/* Thin layers of a further sheet: its units have no more layers than others, which are cut as without them. */
static void test_further_units(void)
{
    march_runs runs = {0};
    march_unit *unit = NULL;
    int64_t units = 0, wrong = 0;
    uint8_t full[100], thin[100];
    bool special[100] = {0};
    err e = {0};
    memset(full, 0xff, sizeof full);
    memset(thin, 1, sizeof thin);
    for (int i = 0; i < 7; i++)
        ok(!march_runs_add(&runs, 102 * i, i < 6 ? full : thin, special, 100, i == 6, &e), "a run is added");
    const int failed = march_runs_cut(&runs, 44, &unit, &units, &e);
    for (int64_t i = 0; i < units; i++)
        wrong += unit[i].base != 102 * (i / 10) + 10 * (i % 10) || unit[i].cells != 11;
    ok(!failed && units == 70 && !wrong, "and 100 thin ones of a further sheet: %lld units of 10, %lld not so",
       (long long)units, (long long)wrong);
    free(unit);
    march_runs_free(&runs);
}

/* A slit across each axis, half through and all through, and several. */
static void test_slits(const block *plain, const block *special)
{
    static const int axis[3] = {2, 0, 1}, of_halves[3] = {2, 1, 0}; /* two parts of a slit all through across x */
    const slit several = {"several",
                          {{0, 9, {0, 0}, {20, 30}, false, false},
                           {2, 17, {3, 4}, {25, 20}, false, false},
                           {1, 12, {2, 5}, {33, 29}, false, false},
                           {1, 25, {10, 8}, {30, 22}, true, true}},
                          false};
    char name[80];
    for (int a = 0; a < 6; a++) {
        const int32_t *cells = plain->cells, next = cells[(a + 1) % 3], last = cells[(a + 2) % 3];
        const slit one = {
            "one", {{a % 3, cells[a % 3] / 2, {0, 0}, {a < 3 ? next / 2 : next, last}, false, false}}, false};
        in_slit = &one;
        snprintf(name, sizeof name, "a slit across %c, %s through", 'x' + a % 3, a < 3 ? "half" : "all");
        test_cut(plain, a == 3 ? of_halves : axis, NULL, 7, name);
    }
    in_slit = &several;
    test_cut(plain, axis, NULL, 20, "several slits");
    test_cut(special, axis, "m=.5,n=.3", 20, "several slits, cut and mixed elements that contract");
    in_slit = NULL;
}

/* How many turns later than a unit's the last of those near it is, as a share of a pass. */
static double most_apart(const march *m)
{
    int64_t most = 0;
    for (int64_t i = 0; i < m->units * m->nears; i++)
        most = m->near[i] - i / m->nears > most ? m->near[i] - i / m->nears : most;
    return (double)most / (double)m->units;
}

static int32_t most_layers(const march *m)
{
    int32_t most = 0;
    for (int64_t i = 0; i < m->units; i++)
        most = m->unit[i].cells > most ? m->unit[i].cells : most;
    return most;
}

/* layers: of cells, of the longest unit. */
static double apart_in(const block *what, const slit *with, int64_t slots, int32_t *layers)
{
    model m = {0};
    script played = {0};
    tled_problem p = {0};
    march cut;
    err e = {0};
    in_slit = with;
    block_make(what, &m);
    in_slit = NULL;
    if (tled_problem_make(&p, &m, &played, PHYSICAL, &e) || march_make(&cut, &p, slots, &e))
        printf("Bail out! %s\n", e.text);
    const double apart = most_apart(&cut);
    *layers = most_layers(&cut);
    march_free(&cut);
    tled_problem_free(&p);
    model_free(&m);
    return apart;
}

/* A unit that has its turn long after one near it would be waited for in the next pass. A slit's second sheet and tips
 * have theirs beside those near them. */
static void test_turns(void)
{
    const block wide = {{62, 62, 16}, {.01, .01, .01}, 3000, .45, 1000, 30000, 0, 1, 0, {0, 1, 0}, 0, false};
    int32_t layers;
    const double without = apart_in(&wide, NULL, 40, &layers);
    for (int a = 0; a < 3; a++) {
        const int32_t *cells = wide.cells;
        const slit half = {
            "half", {{a, cells[a] / 2, {0, 0}, {cells[(a + 1) % 3] / 2, cells[(a + 2) % 3]}, false, false}}, false};
        const double apart = apart_in(&wide, &half, 40, &layers);
        ok(apart < .5, "a slit across %c: the last unit near another has its turn %.2f passes later, not %.2f", 'x' + a,
           apart, without);
    }
}

/* Nor are a further sheet's units longer than others, however few cells their layers have. */
static void test_lengths(void)
{
    const block tall = {{14, 14, 45}, {.01, .01, .01}, 3000, .45, 1000, 30000, 0, 1, 0, {0, 1, 0}, 0, false};
    int32_t without, layers;
    apart_in(&tall, NULL, 3, &without);
    for (int a = 0; a < 2; a++) {
        const slit half = {"half", {{a, 7, {0, 0}, {a ? 45 : 7, a ? 7 : 45}, false, false}}, false};
        apart_in(&tall, &half, 3, &layers);
        ok(without < 46 && layers <= without, "a slit across %c: the longest unit has %d layers, not %d", 'x' + a,
           layers, without);
    }
}

int main(void)
{
    const block tall = {{33, 31, 40}, {.01, .02, .03}, 3000, .45, 1000, 30000, 0, 1, 0, {0, 1, 0}, 0, false};
    static const int axes[][3] = {{2, 0, 1}, {0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 1, 0}},
                     sides[] = {27, 18, 9};
    block flat = tall, cut = tall, mixed = tall, both = tall;
    cut.fraction = both.fraction = -1;
    mixed.mixed = both.mixed = true;
    test_cut(&tall, axes[0], NULL, 7, "a block");
    for (int i = 0; i < 6; i++) {
        for (int a = 0; a < 3; a++)
            flat.cells[axes[i][a]] = sides[a];
        test_cut(&flat, axes[i], NULL, 40, "a flat block");
    }
    in_cuts = true;
    for (int i = 0; i < 6; i++) {
        for (int a = 0; a < 3; a++)
            flat.cells[axes[i][a]] = sides[a];
        test_cut(&flat, axes[i], NULL, 40, "a flat block of parts");
    }
    in_cuts = false;
    for (int a = 0; a < 3; a++)
        flat.cells[a] = 29;
    test_cut(&flat, axes[1], NULL, 40, "a cube");
    test_cut(&tall, axes[0], "m=.5", 20, "a muscle");
    test_cut(&cut, axes[0], NULL, 20, "cut elements");
    test_cut(&mixed, axes[0], NULL, 3, "mixed elements");
    test_cut(&mixed, axes[0], "n=.5", 20, "mixed elements, one volume of which contracts");
    test_cut(&both, axes[0], "m=.5,n=.3", 20, "cut and mixed elements that contract");
    test_slits(&tall, &both);
    test_thin();
    test_one_way();
    test_turns();
    test_lengths();
    test_units();
    test_special_units();
    test_further_units();
    return done_testing();
}
