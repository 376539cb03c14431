#include "voxelise/closed.h"

#include "base/mem.h"
#include "voxelise/hash.h"

#include <stdlib.h>

/* ---- polygons given again: the same corners in the same order, from any corner on, either way round */

static int64_t corner_count(const closed_polygons *p, int64_t polygon)
{
    const int64_t *start = &p->o->face_start[p->face[polygon]];
    return start[1] - start[0];
}

static int32_t corner(const closed_polygons *p, int64_t polygon, int64_t at)
{
    return p->weld[p->o->corner_vertex[p->o->face_start[p->face[polygon]] + at]];
}

/* Where to begin and which way to go, so that equal polygons read alike: at the least vertex, toward its lesser
 * neighbour. */
typedef struct reading {
    int64_t polygon, count, first, step;
} reading;

static reading reading_of(const closed_polygons *p, int64_t polygon)
{
    reading r = {polygon, corner_count(p, polygon), 0, 1};
    for (int64_t i = 1; i < r.count; i++)
        if (corner(p, polygon, i) < corner(p, polygon, r.first))
            r.first = i;
    int32_t next = corner(p, polygon, (r.first + 1) % r.count);
    int32_t last = corner(p, polygon, (r.first + r.count - 1) % r.count);
    if (last < next)
        r.step = r.count - 1;
    return r;
}

static int32_t read_corner(const closed_polygons *p, const reading *r, int64_t at)
{
    return corner(p, r->polygon, (r->first + at * r->step) % r->count);
}

static uint64_t hash_polygon(const closed_polygons *p, const reading *r)
{
    uint64_t h = (uint64_t)r->count;
    for (int64_t i = 0; i < r->count; i++)
        h = hash_next(h, (uint64_t)read_corner(p, r, i));
    return h;
}

static bool same_polygon(const closed_polygons *p, const reading *a, int64_t other)
{
    if (corner_count(p, other) != a->count)
        return false;
    reading b = reading_of(p, other);
    for (int64_t i = 0; i < a->count; i++)
        if (read_corner(p, a, i) != read_corner(p, &b, i))
            return false;
    return true;
}

static int find_repeated(const closed_polygons *p, closed_result *r, err *e)
{
    int64_t size = hash_size(p->polygons);
    int64_t *table = mem_array(size, sizeof *table, "polygons", e); /* a polygon + 1; 0: free */
    if (!table)
        return -1;
    for (int64_t i = 0; i < p->polygons; i++) {
        reading a = reading_of(p, i);
        int64_t at = (int64_t)(hash_polygon(p, &a) & (uint64_t)(size - 1));
        while (table[at] && !same_polygon(p, &a, table[at] - 1))
            at = (at + 1) & (size - 1);
        r->drop[i] = table[at] != 0;
        r->repeated += r->drop[i];
        if (!table[at])
            table[at] = i + 1;
    }
    free(table);
    return 0;
}

/* ---- edges */

typedef struct edge {
    uint64_t ends; /* lower vertex, higher vertex; 0: free, for an edge's higher end is not vertex 0 */
    uint32_t odd, told;
} edge;

typedef struct edges {
    edge *table;
    int64_t size, open;
} edges;

/* The edge from a polygon's corner to the next, or NULL where both are at one place. */
static edge *edge_at(edges *t, const closed_polygons *p, int64_t polygon, int64_t at)
{
    int32_t a = corner(p, polygon, at), b = corner(p, polygon, (at + 1) % corner_count(p, polygon));
    if (a == b)
        return NULL;
    uint64_t ends = a < b ? (uint64_t)a << 32 | (uint64_t)b : (uint64_t)b << 32 | (uint64_t)a;
    int64_t i = (int64_t)(hash_mix(ends) & (uint64_t)(t->size - 1));
    while (t->table[i].ends && t->table[i].ends != ends)
        i = (i + 1) & (t->size - 1);
    t->table[i].ends = ends;
    return &t->table[i];
}

static void count_edges(edges *t, const closed_polygons *p, const bool *drop)
{
    for (int64_t i = 0; i < t->size; i++)
        t->table[i] = (edge){0};
    t->open = 0;
    for (int64_t i = 0; i < p->polygons; i++)
        for (int64_t c = 0, n = drop && drop[i] ? 0 : corner_count(p, i); c < n; c++) {
            edge *x = edge_at(t, p, i, c);
            if (!x)
                continue;
            x->odd ^= 1;
            t->open += x->odd ? 1 : -1;
        }
}

/* Each open edge is told of the first surface that has it. */
static void tell_open(edges *t, const closed_polygons *p, closed_result *r)
{
    for (int64_t i = 0; i < p->polygons; i++)
        for (int64_t c = 0, n = r->drop[i] ? 0 : corner_count(p, i); c < n; c++) {
            edge *x = edge_at(t, p, i, c);
            if (!x || !x->odd || x->told)
                continue;
            x->told = 1;
            r->open_of[p->surface[i]]++;
        }
}

static int check_edges(const closed_polygons *p, closed_result *r, err *e)
{
    int64_t corners = 0;
    for (int64_t i = 0; i < p->polygons; i++)
        corners += corner_count(p, i);
    edges t = {.size = hash_size(corners)};
    t.table = mem_array(t.size, sizeof *t.table, "edges", e);
    if (!t.table)
        return -1;
    count_edges(&t, p, r->drop);
    if (t.open && r->repeated) {
        count_edges(&t, p, NULL);
        r->cancel = t.open == 0;
        if (!r->cancel)
            count_edges(&t, p, r->drop);
    }
    for (int64_t i = 0; r->cancel && i < p->polygons; i++)
        r->drop[i] = false;
    r->open = t.open;
    if (r->open)
        tell_open(&t, p, r);
    free(t.table);
    return 0;
}

int closed_check(const closed_polygons *p, closed_result *r, err *e)
{
    *r = (closed_result){0};
    r->drop = mem_array(p->polygons, sizeof *r->drop, "polygons", e);
    r->open_of = mem_array(p->surfaces, sizeof *r->open_of, "surfaces", e);
    if (r->drop && r->open_of && !find_repeated(p, r, e) && !check_edges(p, r, e))
        return 0;
    closed_free(r);
    return -1;
}

void closed_free(closed_result *r)
{
    free(r->drop);
    free(r->open_of);
    *r = (closed_result){0};
}
