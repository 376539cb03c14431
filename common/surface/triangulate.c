#include "surface/triangulate.h"

#include "base/mem.h"
#include "surface/corner_tree.h"

#include <math.h>
#include <stdlib.h>

/* A polygon of as many corners needs no memory of its own, and of so many its corners are in a tree. */
enum { SMALL = 32, LARGE = 256 };

/* A set of corners, as bits; each word of a level above says which of 64 words below have any. */
enum { LEVELS = 6, WORD = 64 };

typedef struct corners {
    uint64_t *level[LEVELS];
    int levels;
} corners;

/* What is left of a polygon. A corner is seen along the axis that the polygon's normal is nearest to: u and v are its
 * coordinates along the other two, in the order that makes the polygon run anticlockwise. Dropping a coordinate rounds
 * nothing. */
typedef struct polygon {
    corner *corner;
    int32_t count, left, first;
    corners maybe;     /* perhaps ears: they are to be tested */
    int32_t doubted;   /* corners that were left when all of them last were to be tested */
    corner_tree *tree; /* NULL: not LARGE */
} polygon;

/* Takes its words from `word`, which has room for them all. */
static void corners_begin(corners *c, int32_t count, uint64_t *word)
{
    int64_t words = count;
    do {
        words = (words + WORD - 1) / WORD;
        c->level[c->levels++] = word;
        word += words;
    } while (words > 1);
}

/* How many words that takes. */
static int64_t corners_words(int32_t count)
{
    return count / (WORD - 1) + LEVELS + 1;
}

static void corners_add(corners *c, int32_t i)
{
    for (int l = 0; l < c->levels; l++, i /= WORD)
        c->level[l][i / WORD] |= UINT64_C(1) << i % WORD;
}

static void corners_remove(corners *c, int32_t i)
{
    for (int l = 0; l < c->levels; l++, i /= WORD)
        if (c->level[l][i / WORD] &= ~(UINT64_C(1) << i % WORD))
            return;
}

/* The first from i on, or -1. */
static int32_t corners_from(const corners *c, int32_t i, int32_t count)
{
    for (int l = 0; l < c->levels && i < count; l++, i = i / WORD + 1, count = (count + WORD - 1) / WORD) {
        uint64_t word = c->level[l][i / WORD] >> i % WORD;
        if (!word)
            continue;
        i += __builtin_ctzll(word);
        while (l--)
            i = i * WORD + __builtin_ctzll(c->level[l][i]);
        return i;
    }
    return -1;
}

/* The two axes to look along, from Newell's normal: twice the vector area. Taken about the first corner, so that far
 * offsets cost no digits. */
static void choose_axes(const double *position, const int32_t *vertex, int32_t count, int *u, int *v)
{
    double n[3] = {0};
    const double *o = &position[3 * (int64_t)vertex[0]];
    for (int32_t i = 1; i + 1 < count; i++) {
        const double *a = &position[3 * (int64_t)vertex[i]], *b = &position[3 * (int64_t)vertex[i + 1]];
        for (int k = 0; k < 3; k++) {
            int p = (k + 1) % 3, q = (k + 2) % 3;
            n[k] += (a[p] - o[p]) * (b[q] - o[q]) - (a[q] - o[q]) * (b[p] - o[p]);
        }
    }
    int k = fabs(n[0]) > fabs(n[1]) ? 0 : 1;
    k = fabs(n[2]) >= fabs(n[k]) ? 2 : k;
    *u = (k + (n[k] < 0 ? 2 : 1)) % 3;
    *v = (k + (n[k] < 0 ? 1 : 2)) % 3;
}

/* Whether the triangle at corner i can be cut off: convex, with no other corner in it. */
static bool is_ear(const polygon *p, int32_t i)
{
    const corner *b = &p->corner[i], *a = &p->corner[b->before], *c = &p->corner[b->next];
    if (!(corner_area(a, b, c) > 0))
        return false;
    if (p->tree)
        return !corner_tree_blocks(p->tree, a, b, c);
    double low_u = fmin(a->u, fmin(b->u, c->u)), high_u = fmax(a->u, fmax(b->u, c->u));
    double low_v = fmin(a->v, fmin(b->v, c->v)), high_v = fmax(a->v, fmax(b->v, c->v));
    for (const corner *d = &p->corner[c->next]; d != a; d = &p->corner[d->next])
        if (d->u >= low_u && d->u <= high_u && d->v >= low_v && d->v <= high_v && corner_blocks(a, b, c, d))
            return false;
    return true;
}

/* Every corner that is left is to be tested again. */
static void doubt_all(polygon *p)
{
    int32_t i = p->first;
    for (int32_t k = 0; k < p->left; k++, i = p->corner[i].next)
        corners_add(&p->maybe, i);
    p->doubted = p->left;
}

/* Where no ear is left (the polygon crosses itself, or what is left is flat): the corner whose triangle covers least,
 * so that little is covered twice. */
static int32_t least_bad(const polygon *p)
{
    if (p->tree)
        return corner_tree_smallest(p->tree) < 0 ? p->first : corner_tree_smallest(p->tree);
    int32_t best = p->first, i = best;
    double least = INFINITY;
    for (int32_t k = 0; k < p->left; k++, i = p->corner[i].next) {
        const corner *c = &p->corner[i];
        double s = fabs(corner_area(&p->corner[c->before], c, &p->corner[c->next]));
        if (s < least)
            best = i, least = s;
    }
    return best;
}

/* From corner i on, round the polygon, the next that is to be tested; -1: none is. */
static int32_t next_maybe(const polygon *p, int32_t i)
{
    int32_t next = corners_from(&p->maybe, i, p->count);
    return next < 0 ? corners_from(&p->maybe, 0, i) : next;
}

/* From corner i on, the next ear. A cut changes its two neighbours only, unless the polygon crosses itself: then others
 * may have become ears, but to look for those after every cut would take too long. */
static int32_t next_ear(polygon *p, int32_t i)
{
    for (;;) {
        for (int32_t c; (c = next_maybe(p, i)) >= 0; corners_remove(&p->maybe, c))
            if (is_ear(p, c))
                return c;
        if (p->left >= p->doubted - p->doubted / 16)
            return least_bad(p);
        doubt_all(p);
    }
}

/* Cuts corner i off. */
static void cut(polygon *p, int32_t i)
{
    const corner *c = &p->corner[i];
    p->corner[c->before].next = c->next;
    p->corner[c->next].before = c->before;
    corners_remove(&p->maybe, i);
    corners_add(&p->maybe, c->before);
    corners_add(&p->maybe, c->next);
    p->first = p->first == i ? c->next : p->first;
    p->left--;
    if (p->tree)
        corner_tree_cut(p->tree, i);
}

static void begin(polygon *p, const double *position, const int32_t *vertex, uint64_t *word)
{
    int u, v;
    int32_t count = p->count;
    choose_axes(position, vertex, count, &u, &v);
    for (int32_t i = 0; i < count; i++) {
        const double *at = &position[3 * (int64_t)vertex[i]];
        const int32_t before = i ? i - 1 : count - 1;
        p->corner[i] = (corner){at[u], at[v], before, i + 1 < count ? i + 1 : 0};
    }
    p->left = count;
    corners_begin(&p->maybe, count, word);
    doubt_all(p);
}

/* Cuts p into triangles. */
static void cut_all(polygon *p, int32_t *triangle)
{
    for (int32_t at = 1; p->left > 2; triangle += 3) {
        int32_t i = p->left > 3 ? next_ear(p, at) : p->corner[p->first].next;
        triangle[0] = p->corner[i].before;
        triangle[1] = i;
        triangle[2] = at = p->corner[i].next;
        cut(p, i);
    }
}

static int cut_large(polygon *p, const double *position, const int32_t *vertex, int32_t *triangle, err *e)
{
    int status = -1;
    uint64_t *word = mem_array(corners_words(p->count), sizeof *word, "a polygon's corners", e);
    p->corner = mem_array(p->count, sizeof *p->corner, "a polygon's corners", e);
    if (!word || !p->corner)
        goto out;
    begin(p, position, vertex, word);
    p->tree = p->count > LARGE ? corner_tree_create(p->corner, p->count, e) : NULL;
    if (p->count > LARGE && !p->tree)
        goto out;
    cut_all(p, triangle);
    status = 0;
out:
    corner_tree_destroy(p->tree);
    free(p->corner);
    free(word);
    return status;
}

int triangulate(const double *position, const int32_t *vertex, int64_t count, int32_t *triangle, err *e)
{
    corner small[SMALL];
    uint64_t word = 0;
    polygon p = {.corner = small, .count = (int32_t)count};
    if (count < 3)
        return 0;
    if (count > INT32_MAX)
        return err_set(e, NULL, 0, "a polygon of %lld corners; expected at most %d", (long long)count, INT32_MAX);
    if (count > SMALL)
        return cut_large(&p, position, vertex, triangle, e);
    begin(&p, position, vertex, &word);
    cut_all(&p, triangle);
    return 0;
}
