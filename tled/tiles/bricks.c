#include "tled/tiles/bricks.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* A table of bricks by part and place. */
typedef struct table {
    int32_t *brick; /* count x 4 */
    int64_t count, capacity;
    int64_t *seat; /* seats: a brick, or -1 */
    int64_t seats; /* a power of 2 */
    err *e;
} table;

/* Bricks mostly have sides of 2^n, by which a shift divides: this is done thrice for each node. */
static int32_t floor_division(int32_t a, int32_t b)
{
    return b & (b - 1) ? a / b - (a % b < 0) : a >> __builtin_ctz((unsigned)b);
}

static uint64_t hash(const int32_t key[4])
{
    uint64_t h = 0;
    for (int i = 0; i < 4; i++)
        h = (h ^ (uint32_t)key[i]) * UINT64_C(0x9E3779B97F4A7C15), h ^= h >> 29;
    return h;
}

static int grow_seats(table *t)
{
    int64_t seats = 2 * t->seats;
    int64_t *seat = mem_array(seats, sizeof *seat, "the tiles", t->e);
    if (!seat)
        return -1;
    for (int64_t i = 0; i < seats; i++)
        seat[i] = -1;
    for (int64_t k = 0; k < t->count; k++) {
        uint64_t at = hash(t->brick + 4 * k);
        while (seat[at & (uint64_t)(seats - 1)] >= 0)
            at++;
        seat[at & (uint64_t)(seats - 1)] = k;
    }
    free(t->seat);
    t->seat = seat;
    t->seats = seats;
    return 0;
}

/* The number of a brick; a new one is numbered as it comes. -1 with e filled. */
static int64_t number_of(table *t, const int32_t key[4])
{
    if (2 * t->count >= t->seats && grow_seats(t))
        return -1;
    uint64_t mask = (uint64_t)t->seats - 1, at = hash(key) & mask;
    for (; t->seat[at] >= 0; at = (at + 1) & mask)
        if (!memcmp(t->brick + 4 * t->seat[at], key, 4 * sizeof *key))
            return t->seat[at];
    if (mem_grow(&t->brick, &t->capacity, 4 * (t->count + 1), sizeof *t->brick, "the tiles", t->e))
        return -1;
    memcpy(t->brick + 4 * t->count, key, 4 * sizeof *key);
    t->seat[at] = t->count;
    return t->count++;
}

static int number_all(table *t, int64_t nodes, const int32_t *at, const int size[3], int32_t *part)
{
    int32_t last[4] = {-1};
    for (int64_t n = 0, number = -1; n < nodes; n++) {
        int32_t key[4] = {part[n]};
        for (int a = 0; a < 3; a++)
            key[1 + a] = floor_division(at[3 * n + a], size[a]);
        if (memcmp(key, last, sizeof key) != 0) /* mostly a row goes on */
            number = number_of(t, key);
        if (number < 0)
            return -1;
        memcpy(last, key, sizeof last);
        part[n] = (int32_t)number;
    }
    return 0;
}

int bricks_find(const tled_problem *p, const int32_t *at, const int size[3], int32_t *part, int32_t **brick,
                int64_t *count, err *e)
{
    table t = {.seats = 512, .e = e};
    const int failed = grow_seats(&t) || number_all(&t, p->nodes, at, size, part) ? -1 : 0;
    free(t.seat);
    *brick = t.brick;
    *count = t.count;
    return failed;
}
