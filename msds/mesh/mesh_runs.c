#include "msds/mesh/mesh_runs.h"

#include "base/mem.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct run {
    int64_t from, to; /* along x: from to to - 1 */
    int64_t voxels;   /* of a root: those of its component */
    int32_t up;       /* a run of the component before this one, or itself: the root */
    bool outside;     /* of a root: its component is joined to the outside */
} run;

typedef struct runs {
    uint8_t *mask;
    const int64_t *size;
    uint8_t of; /* the value that runs have */
    run *one;
    int64_t count, capacity;
    int64_t *row; /* rows + 1: the first run of each */
} runs;

static int32_t root_of(const runs *r, int64_t i)
{
    int32_t at = (int32_t)i;
    while (r->one[at].up != at) {
        r->one[at].up = r->one[r->one[at].up].up;
        at = r->one[at].up;
    }
    return at;
}

static void join(const runs *r, int64_t a, int64_t b)
{
    const int32_t x = root_of(r, a), y = root_of(r, b);
    if (x < y)
        r->one[y].up = x;
    else
        r->one[x].up = y;
}

static int find_row(runs *r, int64_t row, err *e)
{
    const uint8_t *v = r->mask + row * r->size[0];
    const int64_t j = row % r->size[1], k = row / r->size[1];
    const bool deep = r->size[2] > 1; /* a flat image has no edge across it */
    const bool edge = j == 0 || j == r->size[1] - 1 || (deep && (k == 0 || k == r->size[2] - 1));
    for (int64_t x = 0; x < r->size[0];) {
        const int64_t from = x;
        while (x < r->size[0] && v[x] == v[from])
            x++;
        if (v[from] != r->of)
            continue;
        if (r->count >= INT32_MAX)
            return err_set(e, NULL, 0, "a mask of more than %d runs of voxels; expected a smoother one", INT32_MAX);
        if (MEM_ROOM(&r->one, &r->capacity, r->count + 1, "runs of voxels", e))
            return -1;
        r->one[r->count] = (run){from, x, x - from, (int32_t)r->count, edge || from == 0 || x == r->size[0]};
        r->count++;
    }
    return 0;
}

/* Joins what touches in two rows, going along both. */
static void join_rows(const runs *r, int64_t a, int64_t b)
{
    int64_t i = r->row[a], j = r->row[b];
    while (i < r->row[a + 1] && j < r->row[b + 1]) {
        if (r->one[i].from < r->one[j].to && r->one[j].from < r->one[i].to)
            join(r, i, j);
        if (r->one[i].to < r->one[j].to)
            i++;
        else
            j++;
    }
}

static int find_all(runs *r, err *e)
{
    const int64_t rows = r->size[1] * r->size[2];
    r->row = mem_array(rows + 1, sizeof *r->row, "rows of voxels", e);
    for (int64_t i = 0; r->row && i < rows; i++) {
        r->row[i] = r->count;
        if (find_row(r, i, e))
            return -1;
        r->row[i + 1] = r->count;
        if (i % r->size[1])
            join_rows(r, i - 1, i);
        if (i >= r->size[1])
            join_rows(r, i - r->size[1], i);
    }
    for (int64_t i = 0; r->row && i < r->count; i++) {
        const int32_t root = root_of(r, i);
        if (root != i) {
            r->one[root].voxels += r->one[i].voxels;
            r->one[root].outside |= r->one[i].outside;
        }
    }
    return r->row ? 0 : -1;
}

static void turn(const runs *r, int64_t row, const run *of)
{
    memset(r->mask + row * r->size[0] + of->from, !r->of, (size_t)(of->to - of->from));
}

static void runs_free(runs *r)
{
    free(r->one);
    free(r->row);
}

int mesh_runs_largest(uint8_t *mask, const int64_t size[3], err *e)
{
    runs r = {.size = size, .of = 1};
    int32_t largest = 0;
    r.mask = mask;
    const int status = find_all(&r, e);
    for (int64_t i = 0; !status && i < r.count; i++)
        if (r.one[i].up == i && r.one[i].voxels > r.one[largest].voxels)
            largest = (int32_t)i;
    for (int64_t row = 0; !status && row < size[1] * size[2]; row++)
        for (int64_t i = r.row[row]; i < r.row[row + 1]; i++)
            if (root_of(&r, i) != largest)
                turn(&r, row, &r.one[i]);
    runs_free(&r);
    return status;
}

int mesh_runs_fill(uint8_t *mask, const int64_t size[3], err *e)
{
    runs r = {.size = size, .of = 0};
    r.mask = mask;
    const int status = find_all(&r, e);
    for (int64_t row = 0; !status && row < size[1] * size[2]; row++)
        for (int64_t i = r.row[row]; i < r.row[row + 1]; i++)
            if (!r.one[root_of(&r, i)].outside)
                turn(&r, row, &r.one[i]);
    runs_free(&r);
    return status;
}
