#include "anchor.h"

#include "base/mem.h"
#include "mesh/lattice.h"
#include "surface/closest.h"

#include <math.h>
#include <stdlib.h>

/* Of a voxel's side: what rounding may do to a place that lies just on a limit. */
static const double tolerance = 1e-9;

/* Boxes of at most this many cells are walked; larger ones are halved where the primitive comes near them. */
enum { WALKED = 64 };

typedef struct search {
    lattice grid;
    lattice_map map;
    const int32_t *node;   /* element.node */
    const float *fraction; /* element.fraction, or NULL */
    double strictness, reach, tie;
    uint8_t *rigid;
    int32_t *anchor, *held; /* nodes: the first surface that holds it, the last one; -1 = none */
    closest_shape shape;
    rigid_surface *surface;
    int32_t at; /* its index */
    bool apart; /* of the primitive at hand */
    bool holds; /* it holds a node */
} search;

typedef struct box { /* of cells, inclusive */
    int64_t low[3], high[3];
} box;

static void take(search *s, int32_t node)
{
    s->holds = true;
    s->rigid[node] = 1;
    if (s->anchor[node] < 0)
        s->anchor[node] = s->at;
    if (s->held[node] != s->at)
        s->surface->nodes++;
    s->held[node] = s->at;
}

/* Lines 7 to 10 of the algorithm. line: its direction from the centre, in voxel sides; 0 0 0: all directions. It meets
 * the voxel's boundary, a cube of side 1 here, where its largest component is 1/2. */
static void take_along(search *s, int32_t element, const double *line)
{
    double most = fmax(fabs(line[0]), fmax(fabs(line[1]), fabs(line[2])));
    for (int n = 0; n < 8; n++) {
        bool within = true;
        for (int a = 0; a < 3; a++)
            if (most > 0 && fabs(line[a] / most / 2 - (lattice_vtk[n][a] - 0.5)) > s->strictness + tolerance)
                within = false;
        if (within)
            take(s, s->node[8 * (int64_t)element + n]);
    }
}

/* Lines 5 and 6: p, the closest point, in the box of twice the voxel's sides. */
static void try_point(search *s, int32_t element, const double *centre, const double *p)
{
    double line[3], most = 0;
    for (int a = 0; a < 3; a++) {
        line[a] = (p[a] - centre[a]) / s->grid.spacing[a];
        most = fmax(most, fabs(line[a]));
    }
    if (most > 1 + tolerance)
        return;
    if (most <= tolerance)
        for (int a = 0; a < 3; a++)
            line[a] = s->shape.normal[a] / s->grid.spacing[a];
    take_along(s, element, line);
    /* The other end: of the normal, since which way round the polygon was written says nothing; and where
     * the primitive cuts a voxel that is less than half tissue, since then its centre lies in the bone:
     * nothing of it should hang loose there. But what comes from a file of its own may lie within tissue:
     * then it is another surface that cuts the voxel. */
    bool in_bone = s->fraction && s->fraction[element] < 0.5F && !s->apart && most <= 0.5 + tolerance;
    if (most <= tolerance || in_bone) {
        for (int a = 0; a < 3; a++)
            line[a] = -line[a];
        take_along(s, element, line);
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
static bool is_closest(const search *s, int64_t part, const double *centre, const double *p, double d)
{
    double width2 = s->tie * (2 * d + s->tie) * (1 + 1e-6), q[3];
    for (int64_t other = 0; other < s->shape.parts; other++) {
        double at = closest_part(&s->shape, other, centre, q);
        double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
        if ((at < d || (at == d && other < part)) && x * x + y * y + z * z <= width2)
            return false;
    }
    return true;
}

/* Lines 3 to 10: one voxel and one primitive; each element of a voxel that a slit parts. */
static void try_voxel(search *s, const int64_t *cell)
{
    const int32_t first = lattice_element(&s->map, cell[0], cell[1], cell[2]);
    if (first < 0)
        return;
    double centre[3], p[3];
    centre_of(s, cell, centre);
    double nearest = closest_distance(&s->shape, centre);
    if (nearest > s->reach)
        return;
    for (int64_t part = 0; part < s->shape.parts; part++) {
        double d = closest_part(&s->shape, part, centre, p);
        if (d > nearest + s->tie || !is_closest(s, part, centre, p, d))
            continue;
        for (int32_t element = first; element >= 0; element = lattice_next(&s->map, element))
            try_point(s, element, centre, p);
    }
}

static int64_t cells_in(const box *b)
{
    int64_t cells = 1;
    for (int a = 0; a < 3; a++)
        cells *= b->high[a] - b->low[a] + 1;
    return cells;
}

static void walk(search *s, const box *b)
{
    for (int64_t k = b->low[2]; k <= b->high[2]; k++)
        for (int64_t j = b->low[1]; j <= b->high[1]; j++)
            for (int64_t i = b->low[0]; i <= b->high[0]; i++)
                try_voxel(s, (int64_t[3]){i, j, k});
}

/* Whether the primitive may be within reach of a cell centre in b: at most the half
 * diagonal farther from b's middle. */
static bool comes_near(const search *s, const box *b)
{
    double middle[3], low[3], half = 0;
    centre_of(s, b->low, low);
    centre_of(s, b->high, middle);
    for (int a = 0; a < 3; a++) {
        double half_side = (middle[a] - low[a]) / 2;
        half += half_side * half_side;
        middle[a] -= half_side;
    }
    return closest_distance(&s->shape, middle) <= (s->reach + sqrt(half)) * (1 + 1e-6);
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
static void search_box(search *s, const box *all)
{
    box waiting[96] = {*all};
    for (int count = 1; count > 0;) {
        box b = waiting[--count];
        if (cells_in(&b) <= WALKED) {
            walk(s, &b);
        } else if (comes_near(s, &b)) {
            halve(&b, &waiting[count], &waiting[count + 1]);
            count += 2;
        }
    }
}

/* The cells whose centres are at most a voxel's side from the shape's bounding box along each axis. Returns false where
 * the lattice has none. */
static bool cells_near(const search *s, box *b)
{
    double low[3], high[3];
    lattice_local(&s->grid, s->shape.low, low);
    lattice_local(&s->grid, s->shape.high, high);
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

static int try_primitives(search *s, rigid *r, err *e)
{
    box near;
    for (int64_t i = 0; i < r->primitives; i++) {
        rigid_primitive *p = &r->primitive[i];
        if (closest_shape_of(&s->shape, p->position, p->vertex, p->corners, e))
            return -1;
        s->at = p->surface;
        s->surface = &r->surface[p->surface];
        s->apart = p->apart;
        s->holds = false;
        if (cells_near(s, &near))
            search_box(s, &near);
        p->idle = !s->holds;
        s->surface->idle += p->idle;
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
    for (int64_t n = 0; n < nodes; n++)
        s->anchor[n] = s->held[n] = -1;
    return 0;
}

/* The lattice and its elements; the lengths within which a primitive matters and within which two are equal. */
static int find_voxels(const model *m, search *s, err *e)
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
    return lattice_map_build(&s->map, m, e);
}

int anchor_nodes(model *m, rigid *r, double strictness, notes *warnings, err *e)
{
    search s = {.strictness = strictness};
    int rc = -1;
    if (find_voxels(m, &s, e) || add_arrays(m, &s, r, warnings, e) || try_primitives(&s, r, e))
        goto out;
    rc = 0;
out:
    lattice_map_free(&s.map);
    closest_shape_free(&s.shape);
    free(s.held);
    return rc;
}
