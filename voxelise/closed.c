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

/* Drops each polygon given before. like: of each polygon, the first that reads as it does. */
static int find_repeated(const closed_polygons *p, closed_result *r, int64_t *like, err *e)
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
        if (!table[at])
            table[at] = i + 1;
        like[i] = table[at] - 1;
        r->drop[i] = like[i] != i;
    }
    free(table);
    return 0;
}

/* ---- edges, and the parts of the surface that they join */

typedef struct edge {
    uint64_t ends;          /* lower vertex, higher vertex; 0: free, for an edge's higher end is not vertex 0 */
    int64_t polygon;        /* the first that has it */
    bool open, uncancelled; /* used an odd number of times: by polygons not dropped, by all */
    bool told;
} edge;

/* A part: what edges join. Known by one of its polygons. */
typedef struct part {
    int64_t parent;                  /* its polygon, or one nearer to that */
    int64_t open, uncancelled, left; /* edges; polygons given an odd number of times */
} part;

typedef struct edges {
    edge *table;
    int64_t size;
    part *part; /* polygons */
} edges;

static part *part_of(const edges *t, int64_t polygon)
{
    while (t->part[polygon].parent != polygon)
        polygon = t->part[polygon].parent = t->part[t->part[polygon].parent].parent;
    return &t->part[polygon];
}

/* The edge from a polygon's corner to the next, or NULL where both are at one place. */
static edge *edge_at(const edges *t, const closed_polygons *p, int64_t polygon, int64_t at)
{
    int32_t a = corner(p, polygon, at), b = corner(p, polygon, (at + 1) % corner_count(p, polygon));
    if (a == b)
        return NULL;
    uint64_t ends = a < b ? (uint64_t)a << 32 | (uint64_t)b : (uint64_t)b << 32 | (uint64_t)a;
    int64_t i = (int64_t)(hash_mix(ends) & (uint64_t)(t->size - 1));
    while (t->table[i].ends && t->table[i].ends != ends)
        i = (i + 1) & (t->size - 1);
    if (!t->table[i].ends)
        t->table[i] = (edge){.ends = ends, .polygon = polygon};
    return &t->table[i];
}

static void use_edges(const edges *t, const closed_polygons *p, const bool *drop)
{
    for (int64_t i = 0; i < p->polygons; i++)
        t->part[i].parent = i;
    for (int64_t i = 0; i < p->polygons; i++)
        for (int64_t c = 0; c < corner_count(p, i); c++) {
            edge *x = edge_at(t, p, i, c);
            if (!x)
                continue;
            x->uncancelled = !x->uncancelled;
            x->open ^= !drop[i];
            part_of(t, i)->parent = part_of(t, x->polygon)->parent;
        }
}

static void count_open(const edges *t)
{
    for (int64_t i = 0; i < t->size; i++)
        if (t->table[i].ends) {
            part *of = part_of(t, t->table[i].polygon);
            of->open += t->table[i].open;
            of->uncancelled += t->table[i].uncancelled;
        }
}

/* Whether the polygons that a part gives again cancel in pairs: fewer edges are open then, and some polygon is left. (A
 * torn surface given twice would be gone.) */
static bool cancels(const part *of)
{
    return of->uncancelled < of->open && of->left > 0;
}

/* Where polygons cancel, one that was given an even number of times goes altogether: two alike need not be cut into the
 * same triangles. */
static void cancel(const edges *t, const closed_polygons *p, closed_result *r, const int64_t *like)
{
    for (int64_t i = 0; i < p->polygons; i++)
        if (like[i] != i)
            r->drop[like[i]] = !r->drop[like[i]];
    for (int64_t i = 0; i < p->polygons; i++)
        part_of(t, i)->left += !r->drop[i];
    for (int64_t i = 0; i < p->polygons; i++) {
        bool pairs = cancels(part_of(t, i)), repeat = like[i] != i;
        r->drop[i] = r->drop[i] && (pairs || repeat);
        r->cancelled += repeat && pairs;
        r->once += repeat && !pairs;
    }
}

/* Each open edge is told of the first surface that has it. */
static void tell_open(const edges *t, const closed_polygons *p, closed_result *r)
{
    for (int64_t i = 0; i < p->polygons; i++)
        for (int64_t c = 0; c < corner_count(p, i); c++) {
            edge *x = edge_at(t, p, i, c);
            if (!x || x->told || !(cancels(part_of(t, i)) ? x->uncancelled : x->open))
                continue;
            x->told = true;
            r->open++;
            r->open_of[p->surface[i]]++;
        }
}

static int check_edges(const closed_polygons *p, closed_result *r, const int64_t *like, err *e)
{
    int64_t corners = 0;
    for (int64_t i = 0; i < p->polygons; i++)
        corners += corner_count(p, i);
    edges t = {.size = hash_size(corners)};
    t.table = mem_array(t.size, sizeof *t.table, "edges", e);
    t.part = t.table ? mem_array(p->polygons, sizeof *t.part, "polygons", e) : NULL;
    int status = t.part ? 0 : -1;
    if (!status) {
        use_edges(&t, p, r->drop);
        count_open(&t);
        cancel(&t, p, r, like);
        tell_open(&t, p, r);
    }
    free(t.table);
    free(t.part);
    return status;
}

int closed_check(const closed_polygons *p, closed_result *r, err *e)
{
    *r = (closed_result){0};
    int64_t *like = mem_array(p->polygons, sizeof *like, "polygons", e);
    r->drop = like ? mem_array(p->polygons, sizeof *r->drop, "polygons", e) : NULL;
    r->open_of = r->drop ? mem_array(p->surfaces, sizeof *r->open_of, "surfaces", e) : NULL;
    int status = r->open_of && !find_repeated(p, r, like, e) && !check_edges(p, r, like, e) ? 0 : -1;
    free(like);
    if (status)
        closed_free(r);
    return status;
}

void closed_free(closed_result *r)
{
    free(r->drop);
    free(r->open_of);
    *r = (closed_result){0};
}
