#include "voxelise/surfaces/closed.h"

#include "base/mem.h"
#include "surface/hash.h"

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

/* ---- tables by vertex: what is alike has the same vertex, so it is looked for among few, that lie side by side */

typedef struct table {
    int64_t low, past; /* vertices */
    int64_t *start;    /* vertices + 1: the first entry of each */
    uint64_t *entry;   /* 32 bits to tell it by, 32 of the polygon */
    int64_t dots;      /* edges without length */
} table;

/* Takes one entry after another: first to count them, then to store them. */
typedef void table_fill(const closed_polygons *p, int64_t polygon, table *t, bool store);

static void put(table *t, int32_t vertex, uint32_t key, int64_t polygon, bool store)
{
    int64_t *start = &t->start[vertex - t->low];
    if (store)
        t->entry[start[1]++] = (uint64_t)key << 32 | (uint64_t)polygon;
    else
        start[2]++;
}

static int by_value(const void *a, const void *b)
{
    const uint64_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* Most vertices have a few entries. */
static void sort_entries(uint64_t *entry, int64_t count)
{
    enum { FEW = 24 };
    if (count > FEW) {
        qsort(entry, (size_t)count, sizeof *entry, by_value);
        return;
    }
    for (int64_t i = 1; i < count; i++) {
        uint64_t one = entry[i];
        int64_t at = i;
        for (; at > 0 && entry[at - 1] > one; at--)
            entry[at] = entry[at - 1];
        entry[at] = one;
    }
}

static void find_vertices(const closed_polygons *p, table *t)
{
    t->low = INT32_MAX, t->past = 0;
    for (int64_t i = 0; i < p->polygons; i++)
        for (int64_t c = 0; c < corner_count(p, i); c++) {
            int32_t v = corner(p, i, c);
            t->low = v < t->low ? v : t->low;
            t->past = v >= t->past ? (int64_t)v + 1 : t->past;
        }
    t->low = t->low < t->past ? t->low : t->past;
}

/* Counted two places up, so that filling leaves each vertex's first in its place. */
static int make_table(table *t, const closed_polygons *p, table_fill *fill, err *e)
{
    find_vertices(p, t);
    int64_t vertices = t->past - t->low;
    t->start = mem_array(vertices + 2, sizeof *t->start, "vertices", e);
    if (!t->start)
        return -1;
    for (int64_t i = 0; i < p->polygons; i++)
        fill(p, i, t, false);
    for (int64_t v = 0; v < vertices; v++)
        t->start[v + 2] += t->start[v + 1];
    t->entry = mem_array(t->start[vertices + 1], sizeof *t->entry, "polygons", e);
    if (!t->entry)
        return -1;
    for (int64_t i = 0; i < p->polygons; i++)
        fill(p, i, t, true);
    for (int64_t v = 0; v < vertices; v++)
        sort_entries(t->entry + t->start[v], t->start[v + 1] - t->start[v]);
    return 0;
}

static void free_table(table *t)
{
    free(t->start);
    free(t->entry);
    *t = (table){0};
}

static int64_t polygon_of(uint64_t entry)
{
    return (int64_t)(entry & UINT32_MAX);
}

/* Calls take with each run of entries of one vertex and one key. */
typedef void table_take(void *context, const uint64_t *entry, int64_t count);

static void each_run(const table *t, table_take *take, void *context)
{
    for (int64_t v = 0; v < t->past - t->low; v++)
        for (int64_t from = t->start[v], to = from; from < t->start[v + 1]; from = to) {
            while (to < t->start[v + 1] && t->entry[to] >> 32 == t->entry[from] >> 32)
                to++;
            take(context, t->entry + from, to - from);
        }
}

/* ---- polygons given again, by their least vertex */

static void fill_polygon(const closed_polygons *p, int64_t polygon, table *t, bool store)
{
    reading a = reading_of(p, polygon);
    put(t, read_corner(p, &a, 0), store ? (uint32_t)(hash_polygon(p, &a) >> 32) : 0, polygon, store);
}

typedef struct repeats {
    const closed_polygons *p;
    closed_result *r;
    int64_t *like; /* polygons: the first that reads as each does; owned by whoever looks for them */
    int64_t count;
} repeats;

/* Polygons of one hash: in nearly all cases one, or the same again and again. */
static void take_alike(void *context, const uint64_t *entry, int64_t count)
{
    repeats *f = context;
    for (int64_t i = 1; i < count; i++) {
        int64_t polygon = polygon_of(entry[i]);
        reading a = reading_of(f->p, polygon);
        for (int64_t before = 0; before < i && f->like[polygon] == polygon; before++) {
            int64_t other = polygon_of(entry[before]);
            if (f->like[other] == other && same_polygon(f->p, &a, other))
                f->like[polygon] = other;
        }
        f->r->drop[polygon] = f->like[polygon] != polygon;
        f->count += f->r->drop[polygon];
    }
}

/* Drops each polygon given before. */
static int find_repeated(repeats *f, err *e)
{
    table t = {0};
    f->like = mem_array(f->p->polygons, sizeof *f->like, "polygons", e);
    int status = f->like ? make_table(&t, f->p, fill_polygon, e) : -1;
    for (int64_t i = 0; !status && i < f->p->polygons; i++)
        f->like[i] = i;
    if (!status)
        each_run(&t, take_alike, f);
    free_table(&t);
    return status;
}

/* ---- edges, by their lower vertex, and the parts of the surface that they join */

static void fill_edges(const closed_polygons *p, int64_t polygon, table *t, bool store)
{
    const int64_t *start = &p->o->face_start[p->face[polygon]];
    int32_t a = p->weld[p->o->corner_vertex[start[1] - 1]];
    for (int64_t c = start[0]; c < start[1]; c++) {
        int32_t b = p->weld[p->o->corner_vertex[c]];
        if (a < b)
            put(t, a, (uint32_t)b, polygon, store);
        else if (a > b)
            put(t, b, (uint32_t)a, polygon, store);
        else
            t->dots++;
        a = b;
    }
}

/* Whether a polygon may have been given again: two that are alike share both edges at their least vertex, and nearly
 * nowhere else two polygons share two edges of one vertex, an edge more than twice, or one both ends. */
static bool may_repeat(const table *t)
{
    enum { MOST = 16 };
    uint64_t pair[MOST];
    for (int64_t v = 0; v < t->past - t->low; v++) {
        int pairs = 0;
        for (int64_t i = t->start[v]; i + 1 < t->start[v + 1]; i++) {
            const uint64_t *entry = t->entry + i;
            if (entry[0] >> 32 != entry[1] >> 32)
                continue;
            if (pairs == MOST || entry[0] == entry[1])
                return true;
            pair[pairs] = entry[0] << 32 | (entry[1] & UINT32_MAX);
            for (int n = 0; n < pairs; n++)
                if (pair[n] == pair[pairs] || entry[-1] >> 32 == entry[0] >> 32)
                    return true;
            pairs++;
        }
    }
    return t->dots > 0;
}

/* A part: what edges join. Known by one of its polygons. */
typedef struct part {
    int64_t parent;                  /* its polygon, or one nearer to that */
    int64_t open, uncancelled, left; /* edges; polygons given an odd number of times */
} part;

typedef struct edges {
    const closed_polygons *p;
    closed_result *r;
    const int64_t *like;
    table by_vertex;
    part *part; /* polygons; NULL where none is given again */
} edges;

static part *part_of(const edges *t, int64_t polygon)
{
    while (t->part[polygon].parent != polygon)
        polygon = t->part[polygon].parent = t->part[t->part[polygon].parent].parent;
    return &t->part[polygon];
}

static void join_parts(void *context, const uint64_t *entry, int64_t count)
{
    const edges *t = context;
    for (int64_t i = 1; i < count; i++)
        part_of(t, polygon_of(entry[i]))->parent = part_of(t, polygon_of(entry[0]))->parent;
}

/* Used an odd number of times, by polygons that are not dropped. */
static bool is_open(const edges *t, const uint64_t *entry, int64_t count)
{
    bool odd = false;
    for (int64_t i = 0; i < count; i++)
        odd ^= !t->r->drop[polygon_of(entry[i])];
    return odd;
}

static void count_open(void *context, const uint64_t *entry, int64_t count)
{
    const edges *t = context;
    part *of = part_of(t, polygon_of(entry[0]));
    of->open += is_open(t, entry, count);
    of->uncancelled += count % 2;
}

/* Whether the polygons that a part gives again cancel in pairs: fewer edges are open then, and some polygon is left. (A
 * torn surface given twice would be gone.) */
static bool cancels(const part *of)
{
    return of->uncancelled < of->open && of->left > 0;
}

/* Where polygons cancel, one that was given an even number of times goes altogether: two alike need not be cut into the
 * same triangles. */
static void cancel(const edges *t)
{
    closed_result *r = t->r;
    const int64_t *like = t->like;
    for (int64_t i = 0; i < t->p->polygons; i++)
        if (like[i] != i)
            r->drop[like[i]] = !r->drop[like[i]];
    for (int64_t i = 0; i < t->p->polygons; i++)
        part_of(t, i)->left += !r->drop[i];
    for (int64_t i = 0; i < t->p->polygons; i++) {
        bool pairs = cancels(part_of(t, i)), repeat = like[i] != i;
        r->sheet[i] = r->drop[i] && pairs && !repeat;
        r->drop[i] = r->drop[i] && (pairs || repeat);
        r->cancelled += repeat && pairs;
        r->once += repeat && !pairs;
    }
}

/* The ends of an edge: what it is kept by. */
static void edge_ends(const table *t, const uint64_t *entry, int32_t end[2])
{
    int64_t v = 0;
    while (t->start[v + 1] <= entry - t->entry)
        v++;
    end[0] = (int32_t)(t->low + v);
    end[1] = (int32_t)(*entry >> 32);
}

/* Each open edge is told of the first surface that has it: entries are in order of their polygons. */
static void tell_open(void *context, const uint64_t *entry, int64_t count)
{
    const edges *t = context;
    int64_t first = polygon_of(entry[0]);
    if (t->part && !cancels(part_of(t, first)) ? !is_open(t, entry, count) : count % 2 == 0)
        return;
    if (!t->r->open++)
        edge_ends(&t->by_vertex, entry, t->r->first);
    t->r->open_of[t->p->surface[first]]++;
}

static int judge_repeated(edges *t, err *e)
{
    t->part = mem_array(t->p->polygons, sizeof *t->part, "polygons", e);
    if (!t->part)
        return -1;
    for (int64_t i = 0; i < t->p->polygons; i++)
        t->part[i].parent = i;
    each_run(&t->by_vertex, join_parts, t);
    each_run(&t->by_vertex, count_open, t);
    cancel(t);
    return 0;
}

static int check_edges(edges *t, err *e)
{
    repeats again = {.p = t->p, .r = t->r};
    int status = make_table(&t->by_vertex, t->p, fill_edges, e);
    if (!status && may_repeat(&t->by_vertex))
        status = find_repeated(&again, e);
    t->like = again.like;
    if (!status && again.count)
        status = judge_repeated(t, e);
    if (!status)
        each_run(&t->by_vertex, tell_open, t);
    free_table(&t->by_vertex);
    free(t->part);
    free(again.like);
    return status;
}

int closed_check(const closed_polygons *p, closed_result *r, err *e)
{
    *r = (closed_result){0};
    if (p->polygons > UINT32_MAX)
        return err_set(e, p->o->name, 0, "%lld polygons; at most %u are possible", (long long)p->polygons, UINT32_MAX);
    edges t = {.p = p, .r = r};
    r->drop = mem_array(p->polygons, sizeof *r->drop, "polygons", e);
    r->sheet = r->drop ? mem_array(p->polygons, sizeof *r->sheet, "polygons", e) : NULL;
    r->open_of = r->sheet ? mem_array(p->surfaces, sizeof *r->open_of, "surfaces", e) : NULL;
    int status = r->open_of ? check_edges(&t, e) : -1;
    if (status)
        closed_free(r);
    return status;
}

void closed_free(closed_result *r)
{
    free(r->drop);
    free(r->sheet);
    free(r->open_of);
    *r = (closed_result){0};
}
