#include "anchor.h"

#include "base/mem.h"
#include "mesh/lattice.h"
#include "surface/closest.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

/* Of a voxel's side: what rounding may do to a place that lies just on a limit. */
static const double tolerance = 1e-9;

/* Boxes of at most this many cells are walked; larger ones are halved where the primitive comes near them. */
enum { WALKED = 64 };

enum { CHUNK = 64 }; /* primitives */

/* What all threads share; of the arrays of nodes see take(). */
typedef struct search {
    lattice grid;
    lattice_map map;
    const int32_t *node;   /* element.node */
    const float *fraction; /* element.fraction, or NULL */
    double strictness, reach, tie;
    uint8_t *rigid;
    int32_t *anchor;            /* nodes: the first surface that holds it; -1 = none */
    atomic_int *held;           /* nodes: the last one */
    rigid_primitive *primitive; /* of the surface at hand */
    int32_t at;                 /* its index */
    rigid_surface *found;       /* chunks: what it holds */
    err *failed;                /* chunks */
} search;

/* One primitive. */
typedef struct primitive {
    const search *s;
    closest_shape shape;
    bool apart;
    bool holds;    /* it holds a node */
    int64_t nodes; /* that it holds as the first of its surface */
} primitive;

typedef struct box { /* of cells, inclusive */
    int64_t low[3], high[3];
} box;

/* Surfaces come one after another, so that whichever primitive of one holds a node first, the node is the same. Only
 * that one's thread touches rigid and anchor. */
static void take(primitive *p, int32_t node)
{
    const search *s = p->s;
    p->holds = true;
    if (atomic_load_explicit(&s->held[node], memory_order_relaxed) == s->at ||
        atomic_exchange_explicit(&s->held[node], s->at, memory_order_relaxed) == s->at)
        return;
    s->rigid[node] = 1;
    if (s->anchor[node] < 0)
        s->anchor[node] = s->at;
    p->nodes++;
}

/* Lines 7 to 10 of the algorithm. line: its direction from the centre, in voxel sides; 0 0 0: all directions. It meets
 * the voxel's boundary, a cube of side 1 here, where its largest component is 1/2. */
static void take_along(primitive *p, int32_t element, const double *line)
{
    const search *s = p->s;
    double most = fmax(fabs(line[0]), fmax(fabs(line[1]), fabs(line[2])));
    for (int n = 0; n < 8; n++) {
        bool within = true;
        for (int a = 0; a < 3; a++)
            if (most > 0 && fabs(line[a] / most / 2 - (lattice_vtk[n][a] - 0.5)) > s->strictness + tolerance)
                within = false;
        if (within)
            take(p, s->node[8 * (int64_t)element + n]);
    }
}

/* Lines 5 and 6: p, the closest point, in the box of twice the voxel's sides. */
static void try_point(primitive *p, int32_t element, const double *centre, const double *point)
{
    const search *s = p->s;
    double line[3], most = 0;
    for (int a = 0; a < 3; a++) {
        line[a] = (point[a] - centre[a]) / s->grid.spacing[a];
        most = fmax(most, fabs(line[a]));
    }
    if (most > 1 + tolerance)
        return;
    if (most <= tolerance)
        for (int a = 0; a < 3; a++)
            line[a] = p->shape.normal[a] / s->grid.spacing[a];
    take_along(p, element, line);
    /* The other end: of the normal, since which way round the polygon was written says nothing; and where
     * the primitive cuts a voxel that is less than half tissue, since then its centre lies in the bone:
     * nothing of it should hang loose there. But what comes from a file of its own may lie within tissue:
     * then it is another surface that cuts the voxel. */
    bool in_bone = s->fraction && s->fraction[element] < 0.5F && !p->apart && most <= 0.5 + tolerance;
    if (most <= tolerance || in_bone) {
        for (int a = 0; a < 3; a++)
            line[a] = -line[a];
        take_along(p, element, line);
    }
}

static void centre_of(const search *s, const int64_t *cell, double *centre)
{
    for (int a = 0; a < 3; a++)
        centre[a] = s->grid.origin[a] + s->grid.spacing[a] * ((double)cell[a] + 0.5);
}

/* Whether p, a part's point at distance d, is closest in its own right. In one convex piece the points at most a tie's
 * width t farther than the closest one's d are within sqrt(2 d t + t t) of that: of those so near to each other the
 * closest counts, or else a cut through a polygon would shift its closest point. */
static bool is_closest(const primitive *p, int64_t part, const double *centre, const double *point, double d)
{
    const double tie = p->s->tie, width2 = tie * (2 * d + tie) * (1 + 1e-6);
    double q[3];
    for (int64_t other = 0; other < p->shape.parts; other++) {
        double at = closest_part(&p->shape, other, centre, q);
        double x = point[0] - q[0], y = point[1] - q[1], z = point[2] - q[2];
        if ((at < d || (at == d && other < part)) && x * x + y * y + z * z <= width2)
            return false;
    }
    return true;
}

/* Lines 3 to 10: one voxel and one primitive; each element of a voxel that a slit parts. */
static void try_voxel(primitive *p, const int64_t *cell)
{
    const search *s = p->s;
    const int32_t first = lattice_element(&s->map, cell[0], cell[1], cell[2]);
    if (first < 0)
        return;
    double centre[3], point[3];
    centre_of(s, cell, centre);
    double nearest = closest_distance(&p->shape, centre);
    if (nearest > s->reach)
        return;
    for (int64_t part = 0; part < p->shape.parts; part++) {
        double d = closest_part(&p->shape, part, centre, point);
        if (d > nearest + s->tie || !is_closest(p, part, centre, point, d))
            continue;
        for (int32_t element = first; element >= 0; element = lattice_next(&s->map, element))
            try_point(p, element, centre, point);
    }
}

static int64_t cells_in(const box *b)
{
    int64_t cells = 1;
    for (int a = 0; a < 3; a++)
        cells *= b->high[a] - b->low[a] + 1;
    return cells;
}

static void walk(primitive *p, const box *b)
{
    for (int64_t k = b->low[2]; k <= b->high[2]; k++)
        for (int64_t j = b->low[1]; j <= b->high[1]; j++)
            for (int64_t i = b->low[0]; i <= b->high[0]; i++)
                try_voxel(p, (int64_t[3]){i, j, k});
}

/* Whether the primitive may be within reach of a cell centre in b: at most the half
 * diagonal farther from b's middle. */
static bool comes_near(const primitive *p, const box *b)
{
    const search *s = p->s;
    double middle[3], low[3], half = 0;
    centre_of(s, b->low, low);
    centre_of(s, b->high, middle);
    for (int a = 0; a < 3; a++) {
        double half_side = (middle[a] - low[a]) / 2;
        half += half_side * half_side;
        middle[a] -= half_side;
    }
    return closest_distance(&p->shape, middle) <= (s->reach + sqrt(half)) * (1 + 1e-6);
}

/* The halves of b across its longest side. */
static void halve(const box *b, box *low, box *high)
{
    int longest = 0;
    for (int a = 1; a < 3; a++)
        if (b->high[a] - b->low[a] > b->high[longest] - b->low[longest])
            longest = a;
    *low = *high = *b;
    low->high[longest] = b->low[longest] + (b->high[longest] - b->low[longest]) / 2;
    high->low[longest] = low->high[longest] + 1;
}

/* The voxels of a box, so that the work follows the primitive's area and not its box. Of each pair of halves one waits:
 * with 31 bits a side never more than 3 x 31 + 1. */
static void search_box(primitive *p, const box *all)
{
    box waiting[96] = {*all};
    for (int count = 1; count > 0;) {
        box b = waiting[--count];
        if (cells_in(&b) <= WALKED) {
            walk(p, &b);
        } else if (comes_near(p, &b)) {
            halve(&b, &waiting[count], &waiting[count + 1]);
            count += 2;
        }
    }
}

/* The cells whose centres are at most a voxel's side from the shape's bounding box along each axis. Returns false where
 * the lattice has none. */
static bool cells_near(const primitive *p, box *b)
{
    const search *s = p->s;
    double low[3], high[3];
    lattice_local(&s->grid, p->shape.low, low);
    lattice_local(&s->grid, p->shape.high, high);
    for (int a = 0; a < 3; a++) {
        double first = s->map.low[a], last = first + s->map.size[a] - 1;
        double from = fmax(floor(low[a] - 1.5), first), to = fmin(ceil(high[a] + 0.5), last);
        if (!(from <= to))
            return false;
        b->low[a] = (int64_t)from;
        b->high[a] = (int64_t)to;
    }
    return true;
}

static void try_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const search *s = context;
    rigid_surface *found = &s->found[chunk];
    primitive p = {.s = s};
    box near;
    *found = (rigid_surface){0};
    for (int64_t i = from; i < to; i++) {
        rigid_primitive *r = &s->primitive[i];
        if (closest_shape_of(&p.shape, r->position, r->vertex, r->corners, &s->failed[chunk]))
            break;
        p.apart = r->apart;
        p.holds = false;
        if (cells_near(&p, &near))
            search_box(&p, &near);
        r->idle = !p.holds;
        found->idle += r->idle;
    }
    found->nodes = p.nodes;
    closest_shape_free(&p.shape);
}

/* The primitives from one on that are of the same surface. */
static int64_t count_alike(const rigid *r, int64_t first)
{
    int64_t count = 1;
    while (first + count < r->primitives && r->primitive[first + count].surface == r->primitive[first].surface)
        count++;
    return count;
}

/* Surface after surface. */
static int try_primitives(search *s, rigid *r, pool *threads, err *e)
{
    const int64_t most = pool_chunks(r->primitives, CHUNK);
    s->found = mem_array(most, sizeof *s->found, "rigid surfaces", e);
    s->failed = s->found ? mem_array(most, sizeof *s->failed, "rigid surfaces", e) : NULL;
    if (!s->failed)
        return -1;
    for (int64_t first = 0, count; first < r->primitives; first += count) {
        count = count_alike(r, first);
        s->primitive = &r->primitive[first];
        s->at = s->primitive->surface;
        pool_run(threads, count, CHUNK, try_some, s);
        for (int64_t c = 0; c < pool_chunks(count, CHUNK); c++) {
            r->surface[s->at].nodes += s->found[c].nodes;
            r->surface[s->at].idle += s->found[c].idle;
            if (err_join(e, &s->failed[c]))
                return -1;
        }
    }
    return 0;
}

static int name_anchors(model *m, const rigid *r, err *e)
{
    if (model_axis_add(m, "anchor", r->surfaces, e))
        return -1;
    model_array *name = model_add(m, "anchor.name", e);
    for (int64_t i = 0; name && i < r->surfaces; i++)
        if (model_set_text(name, i, r->surface[i].name, e))
            return -1;
    return name ? 0 : -1;
}

/* Adds the arrays, with no node rigid. */
static int add_arrays(model *m, search *s, const rigid *r, notes *warnings, err *e)
{
    model_axis_drop(m, "anchor", warnings);
    model_remove(m, "node.rigid"); /* so that a second time leaves the arrays in the same order */
    if (name_anchors(m, r, e))
        return -1;
    int64_t nodes = model_count(m, "node");
    model_array *a = model_add(m, "node.rigid", e);
    s->rigid = a ? a->u8 : NULL;
    a = a ? model_add(m, "node.anchor", e) : NULL;
    s->anchor = a ? a->i32 : NULL;
    s->held = a ? mem_array(nodes, sizeof *s->held, "nodes", e) : NULL;
    if (!s->held)
        return -1;
    for (int64_t n = 0; n < nodes; n++) {
        s->anchor[n] = -1;
        atomic_init(&s->held[n], -1);
    }
    return 0;
}

/* The lattice and its elements; the lengths within which a primitive matters and within which two are equal. */
static int find_voxels(const model *m, search *s, pool *threads, err *e)
{
    const model_array *node = model_need(m, "element.node", e);
    if (!node || lattice_of(m, &s->grid, e))
        return -1;
    if (node->columns != 8)
        return err_set(e, NULL, 0, "element.node has %d columns; expected a model of voxels, with 8", node->columns);
    const model_array *fraction = model_find(m, "element.fraction");
    s->node = node->i32;
    s->fraction = fraction ? fraction->f32 : NULL;
    const double *h = s->grid.spacing;
    s->reach = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]) * (1 + 1e-6);
    s->tie = tolerance * fmin(h[0], fmin(h[1], h[2]));
    return lattice_map_build(&s->map, m, threads, e);
}

int anchor_nodes(model *m, rigid *r, double strictness, pool *threads, notes *warnings, err *e)
{
    search s = {.strictness = strictness};
    int rc = -1;
    if (find_voxels(m, &s, threads, e) || add_arrays(m, &s, r, warnings, e) || try_primitives(&s, r, threads, e))
        goto out;
    rc = 0;
out:
    lattice_map_free(&s.map);
    free(s.held);
    free(s.found);
    free(s.failed);
    return rc;
}
