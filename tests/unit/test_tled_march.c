/* A problem cut for a march: every node is moved by one unit, which has all of its elements, with their own corners; what is said of
 * special cells is the problem's, and others are of the plain law. Nodes stand in one order, in which what is owned of a layer is
 * one piece. With each of the six axes; and not where too few threads would have a cell. And units: as many as there is room for at
 * once where their layers are all alike.
 */
// needs: tled/march.c tled/march_units.c tled/march_near.c tled/places.c tled/*.c
#include "mesh/lattice.h"
#include "tled/march_units.h"

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

/* Whether owned nodes stand as they come in layers, each in a row of its place; and all nodes are owned. Notes which stands where. */
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
    return !s->wrong && next == s->p->nodes;
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
    bool good =
        k < cell->muscles && cell->curve[k] == (int32_t)v->contract && cell->peak[k] == (float)(share * v->peak);
    for (int a = 0; a < 3; a++)
        good &= cell->fibre[k][a] == fibre[s->m->axis[a]];
    return good;
}

static void see_special(seen *s, int64_t layer, int i, int j, int32_t element)
{
    const tled_problem *p = s->p;
    const int32_t *which = s->m->which + MARCH_THREADS * (int64_t)s->m->detail[layer];
    const march_cell *cell = &s->m->cell[which[thread_of(i, j)]];
    const tled_law law = tled_law_of(p, element);
    const double share = tled_fraction(p, element), other = tled_mixture(p, element);
    const int32_t mix = tled_mix(p, element);
    int muscles = 0;
    s->special++;
    s->wrong += cell->mu != (float)(share * law.mu) || cell->bulk != (float)(share * law.bulk) ||
                cell->hourglass != (float)(share * law.hourglass);
    s->wrong += !has_muscle(s, cell, &muscles, p->fibre ? p->fibre + 3 * (int64_t)element : NULL,
                            p->element_volume[element], share * (1 - other));
    s->wrong += mix >= 0 && !has_muscle(s, cell, &muscles, p->mixfibre ? p->mixfibre + 3 * (int64_t)element : NULL, mix,
                                        share * other);
    s->wrong += cell->muscles != muscles;
}

/* Whether an element is all of the plain law, and nothing of it may contract. */
static bool is_plain(const seen *s, int32_t element)
{
    const tled_problem *p = s->p;
    const tled_law law = tled_law_of(p, element);
    const tled_volume *plain = &p->volume[s->m->plain];
    const int32_t mix = tled_mix(p, element);
    return tled_fraction(p, element) == 1 && (float)law.mu == (float)plain->mu &&
           (float)law.bulk == (float)plain->bulk && (float)law.hourglass == (float)plain->hourglass &&
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

static void see_unit(seen *s, const march_unit *u)
{
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

/* contract: what does, or NULL. */
static void test_cut(const block *what, const int axis[3], const char *contract, int64_t slots, const char *name)
{
    model m = {0};
    script played = {0};
    tled_problem p = {0};
    march cut;
    err e = {0};
    block_make(what, &m);
    if (contract && script_add_contract(&played, &m, contract, .1, NULL, &e))
        printf("Bail out! %s\n", e.text);
    if (tled_problem_make(&p, &m, &played, .0075, &e))
        printf("Bail out! %s\n", e.text);
    int32_t *list = calloc((size_t)p.nodes * 4, sizeof *list);
    const int failed = march_make(&cut, &p, slots, &e);
    seen s = {&p, &cut, list, list + p.nodes, list + 2 * p.nodes, list + 3 * p.nodes, 0, 0};
    ok(!failed && cut.units > 0 && in_order(&s), "%s: nodes stand as they are owned %s", name, e.text);
    ok(cut.units > 0 && !memcmp(cut.axis, axis, sizeof cut.axis) && all_seen(&s),
       "%s: rows along %c, across %c, %lld units, %.3g threads an element: each node moved once, of all its elements",
       name, "xyz"[cut.axis[0]], "xyz"[cut.axis[1]], (long long)cut.units, cut.computed);
    ok((contract || what->mixed || what->fraction < 0) == (s.special > 0), "%s: %lld special cells are the problem's",
       name, (long long)s.special);
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
    const int failed = tled_problem_make(&p, &m, &played, .0075, &e) || march_make(&cut, &p, 396, &e);
    ok(!failed && cut.units == 0 && !cut.order, "a row of elements is none for a march: %.3g threads an element %s",
       cut.computed, e.text);
    march_free(&cut);
    tled_problem_free(&p);
    model_free(&m);
}

static void test_units(void)
{
    march_runs runs = {0};
    march_unit *unit = NULL;
    int64_t units = 0, layers = 0;
    int32_t longest = 0;
    uint8_t warps[100];
    err e = {0};
    memset(warps, 0xff, sizeof warps);
    for (int i = 0; i < 6; i++)
        ok(!march_runs_add(&runs, 102 * i, warps, 100, &e), "a run is added");
    const int failed = march_runs_cut(&runs, 60, &unit, &units, &e);
    for (int64_t i = 0; i < units; i++) {
        layers += unit[i].cells - 1;
        longest = unit[i].cells > longest ? unit[i].cells : longest;
    }
    ok(!failed && units == 60 && layers == 600 && longest == 11,
       "600 layers for 60 blocks: %lld units, the longest of %d", (long long)units, longest);
    free(unit);
    march_runs_free(&runs);
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
    for (int a = 0; a < 3; a++)
        flat.cells[a] = 29;
    test_cut(&flat, axes[1], NULL, 40, "a cube");
    test_cut(&tall, axes[0], "m=.5", 20, "a muscle");
    test_cut(&cut, axes[0], NULL, 20, "cut elements");
    test_cut(&mixed, axes[0], NULL, 3, "mixed elements");
    test_cut(&mixed, axes[0], "n=.5", 20, "mixed elements, one volume of which contracts");
    test_cut(&both, axes[0], "m=.5,n=.3", 20, "cut and mixed elements that contract");
    test_thin();
    test_units();
    return done_testing();
}
