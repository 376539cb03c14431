#include "voxelise/slits.h"

#include "base/mem.h"
#include "mesh/lattice.h"
#include "voxelise/split.h"
#include "voxelise/touching.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A part at a lattice point. */
typedef struct item {
    joins_part part;
    int64_t number; /* of the part among those of voxels of several; -1: its voxel has one */
    int8_t corner;  /* of its element */
    int32_t group;  /* the lowest item that it hangs together with */
    int32_t next;   /* the group that it goes to */
    bool left;      /* it leaves its group */
} item;

typedef struct work {
    joins j;
    touching at;
    split parts;
    bool *alone;    /* parts: at no point does it hang together with another voxel */
    int32_t *group; /* parts x 8: which of a corner's nodes it has */
    bool separate;  /* elements of one voxel share no node */
    item *item;     /* at one point */
    int64_t items, capacity;
} work;

/* ---- one point */

static int add_items(work *w, const int32_t *cell, int corner, err *e)
{
    const int64_t element = joins_element(&w->j, cell);
    const pieces_cell *p = element < 0 ? NULL : pieces_of(&w->j.x->part, element);
    const int32_t count = p ? p->parts : 1;
    if (element < 0)
        return 0;
    if (mem_grow(&w->item, &w->capacity, w->items + count, sizeof *w->item, "slits", e))
        return -1;
    for (int32_t n = 0; n < count; n++)
        w->item[w->items++] = (item){{{cell[0], cell[1], cell[2]}, element, p, n},
                                     count > 1 ? split_number(&w->parts, p) + n : -1,
                                     (int8_t)corner,
                                     0,
                                     0,
                                     false};
    return 0;
}

/* The parts of the voxels about a point, by k, j, i. Voxel n has the corner opposite of n there. */
static int take_items(work *w, const int32_t *place, err *e)
{
    w->items = 0;
    for (int n = 0; n < 8; n++) {
        const int32_t cell[3] = {place[0] - 1 + (n & 1), place[1] - 1 + (n >> 1 & 1), place[2] - 1 + (n >> 2)};
        int corner = 0;
        while (lattice_vtk[corner][0] == (n & 1) || lattice_vtk[corner][1] == (n >> 1 & 1) ||
               lattice_vtk[corner][2] == n >> 2)
            corner++;
        if (add_items(w, cell, corner, e))
            return -1;
    }
    for (int64_t i = 0; i < w->items; i++)
        w->item[i].group = (int32_t)i;
    return 0;
}

static void unite(work *w, int64_t one, int64_t other)
{
    const int32_t a = w->item[one].group, b = w->item[other].group, low = a < b ? a : b;
    for (int64_t i = 0; i < w->items; i++)
        if (w->item[i].group == a || w->item[i].group == b)
            w->item[i].group = low;
}

/* Along how many axes the voxels of two items differ. */
static int apart(const item *a, const item *b)
{
    int count = 0;
    for (int i = 0; i < 3; i++)
        count += a->part.at[i] != b->part.at[i];
    return count;
}

/* Whether an element lies between the voxels of two items, which touch at an edge or a corner: then what hangs together
 * by faces decides. */
static bool is_between(const work *w, const item *a, const item *b)
{
    for (int64_t i = 0; i < w->items; i++) {
        const int32_t *at = w->item[i].part.at;
        bool within = true;
        for (int n = 0; n < 3; n++)
            within = within && (at[n] == a->part.at[n] || at[n] == b->part.at[n]);
        if (within && apart(&w->item[i], a) && apart(&w->item[i], b))
            return true;
    }
    return false;
}

static bool hang_together(work *w, const item *a, const item *b, int far)
{
    if (!far)
        return split_are_one(&w->parts, a->number, b->number);
    return (far == 1 || !is_between(w, a, b)) && joins_are_joined(&w->j, &a->part, &b->part);
}

/* Faces first: most points are done then. */
static void unite_items(work *w)
{
    for (int far = 0; far <= 3; far++)
        for (int64_t i = 0; i < w->items; i++)
            for (int64_t k = i + 1; k < w->items; k++) {
                const item *a = &w->item[i], *b = &w->item[k];
                if (a->group != b->group && apart(a, b) == far && hang_together(w, a, b, far))
                    unite(w, i, k);
            }
}

/* ---- the end of a slit, where parts of one voxel are still joined by what lies before it */

static bool same_element(const work *w, const item *a, const item *b)
{
    return !apart(a, b) && (a->number == b->number || split_are_one(&w->parts, a->number, b->number));
}

/* How near an item's element comes to the point. */
static double distance2(const work *w, const item *of)
{
    double least = INFINITY, place[3];
    for (int a = 0; a < 3; a++)
        place[a] = lattice_vtk[of->corner][a] * (double)w->j.samples - .5;
    for (int64_t i = 0; i < w->items; i++)
        if (same_element(w, &w->item[i], of))
            least = fmin(least, joins_distance2(&w->j, &w->item[i].part, place));
    return least;
}

/* Whether another element of the same voxel and group comes nearer to the point. */
static bool gives_way(const work *w, const item *a)
{
    for (int64_t i = 0; a->number >= 0 && i < w->items; i++) {
        const item *b = &w->item[i];
        if (apart(a, b) || b->group != a->group || same_element(w, a, b))
            continue;
        const double own = distance2(w, a), other = distance2(w, b);
        if (other < own || (other == own && b->number < a->number))
            return true;
    }
    return false;
}

/* The items that are marked leave their groups, and are groups of their own. */
static void leave(work *w)
{
    for (int64_t i = 0; i < w->items; i++) {
        item *a = &w->item[i];
        int64_t lowest = 0;
        while (w->item[lowest].left != a->left || w->item[lowest].group != a->group)
            lowest++;
        a->next = (int32_t)(a->left ? i : lowest);
    }
    for (int64_t i = 0; i < w->items; i++)
        w->item[i].group = w->item[i].next;
    for (int far = 0; far <= 3; far++)
        for (int64_t i = 0; i < w->items; i++)
            for (int64_t k = i + 1; k < w->items; k++) {
                const item *a = &w->item[i], *b = &w->item[k];
                if (a->left && b->left && a->group != b->group && apart(a, b) == far && hang_together(w, a, b, far))
                    unite(w, i, k);
            }
}

/* Of elements of one voxel, only the nearest keeps a node that they would share, so that no node is in two of them, nor
 * in more than eight elements: the tip is held by the nodes on either side of the slit. */
static void separate(work *w)
{
    for (bool any = true; any;) {
        any = false;
        for (int64_t i = 0; i < w->items; i++) {
            w->item[i].left = gives_way(w, &w->item[i]);
            any = any || w->item[i].left;
        }
        if (any)
            leave(w);
    }
}

static int look_at(work *w, const int32_t *place, err *e)
{
    if (take_items(w, place, e))
        return -1;
    unite_items(w);
    if (w->separate)
        separate(w);
    return 0;
}

/* ---- which parts of a voxel are one element */

static void take_alone(work *w)
{
    for (int64_t i = 0; i < w->items; i++)
        for (int64_t k = 0; w->item[i].number >= 0 && k < w->items; k++)
            if (w->item[k].group == w->item[i].group && apart(&w->item[i], &w->item[k]))
                w->alone[w->item[i].number] = false;
}

static void take_groups(work *w)
{
    for (int64_t i = 0; i < w->items; i++)
        if (w->item[i].number >= 0)
            w->group[8 * w->item[i].number + w->item[i].corner] = w->item[i].group;
}

/* Parts of a voxel that see each other are one: a sheet thinner than the samples are apart is in pieces otherwise. */
static void unite_seen(work *w)
{
    const pieces_list *l = &w->j.x->part;
    for (int64_t c = 0; c < l->cells; c++) {
        const pieces_cell *p = &l->cell[c];
        const int64_t number = p->parts > 1 ? split_number(&w->parts, p) : 0;
        for (int32_t n = 0; n < p->parts; n++)
            for (int32_t o = n + 1; o < p->parts; o++) {
                const joins_part one = {{p->cell[0], p->cell[1], p->cell[2]}, p->element, p, n};
                const joins_part other = {{p->cell[0], p->cell[1], p->cell[2]}, p->element, p, o};
                if (!split_are_one(&w->parts, number + n, number + o) && joins_are_joined(&w->j, &one, &other))
                    split_unite(&w->parts, number + n, number + o);
            }
    }
}

/* A part that hangs together with no other voxel stays with the largest of its own. */
static void unite_alone(work *w)
{
    const pieces_list *l = &w->j.x->part;
    for (int64_t c = 0; c < l->cells; c++) {
        const pieces_cell *p = &l->cell[c];
        const int64_t number = p->parts > 1 ? split_number(&w->parts, p) : 0;
        const int64_t largest = p->parts > 1 ? split_largest(&w->parts, p) : 0;
        for (int32_t n = 0; n < p->parts && p->parts > 1; n++) {
            bool alone = true;
            for (int32_t o = 0; o < p->parts; o++)
                alone = alone && (w->alone[number + o] || !split_are_one(&w->parts, number + n, number + o));
            if (alone)
                split_unite(&w->parts, number + n, largest);
        }
    }
}

/* Parts of the same nodes are one element. */
static void unite_same(work *w)
{
    const pieces_list *l = &w->j.x->part;
    for (int64_t c = 0; c < l->cells; c++) {
        const pieces_cell *p = &l->cell[c];
        const int64_t number = p->parts > 1 ? split_number(&w->parts, p) : 0;
        for (int32_t n = 0; n < p->parts; n++)
            for (int32_t o = n + 1; o < p->parts; o++)
                if (!memcmp(&w->group[8 * (number + n)], &w->group[8 * (number + o)], 8 * sizeof *w->group))
                    split_unite(&w->parts, number + n, number + o);
    }
}

static int find_alone(work *w, err *e)
{
    for (int64_t i = 0; i < w->parts.parts; i++)
        w->alone[i] = true;
    for (int64_t i = 0; i < w->at.count; i++) {
        if (look_at(w, w->at.point[i], e))
            return -1;
        take_alone(w);
    }
    unite_alone(w);
    return 0;
}

static int join_parts(work *w, err *e)
{
    const int64_t count = w->parts.parts;
    w->alone = mem_array(count, sizeof *w->alone, "slits", e);
    w->group = w->alone ? mem_array(8 * count, sizeof *w->group, "slits", e) : NULL;
    if (!w->group)
        return -1;
    unite_seen(w);
    if (find_alone(w, e))
        return -1;
    for (int64_t i = 0; i < w->at.count; i++) {
        if (look_at(w, w->at.point[i], e))
            return -1;
        take_groups(w);
    }
    unite_same(w);
    w->separate = true;
    return find_alone(w, e);
}

/* ---- nodes */

/* The number of an item's group among those of its point, by their lowest items. */
static int32_t node_of(const work *w, const item *of)
{
    int32_t before = 0;
    for (int64_t i = 0; i < of->group; i++)
        before += w->item[i].group == i;
    return before;
}

static int add_point(slits *s, const work *w, const int32_t *place, err *e)
{
    int32_t nodes = 0;
    for (int64_t i = 0; i < w->items; i++)
        nodes += w->item[i].group == i;
    if (nodes < 2)
        return 0;
    if (mem_grow(&s->point, &s->point_capacity, s->points + 1, sizeof *s->point, "slits", e) ||
        mem_grow(&s->corner, &s->corner_capacity, s->corners + w->items, sizeof *s->corner, "slits", e))
        return -1;
    slits_point *p = &s->point[s->points++];
    *p = (slits_point){{place[0], place[1], place[2]}, nodes, s->corners, 0};
    for (int64_t i = 0; i < w->items; i++) {
        const item *t = &w->item[i];
        const int64_t element = split_element(&w->parts, t->part.element, t->number);
        s->corner[s->corners++] = (slits_corner){element, node_of(w, t), t->corner};
    }
    p->to = s->corners;
    s->nodes += nodes - 1;
    return 0;
}

static int add_points(slits *s, work *w, err *e)
{
    for (int64_t i = 0; i < w->at.count; i++)
        if (look_at(w, w->at.point[i], e) || add_point(s, w, w->at.point[i], e))
            return -1;
    return 0;
}

/* ---- a place that is inside */

static void put_inside(const work *w, const joins_part *p, float *to)
{
    int32_t at[3] = {0};
    joins_middle(&w->j, p, at);
    for (int a = 0; a < 3; a++)
        to[a] = (float)((at[a] + .5) / w->j.samples);
}

/* Of each element the sample nearest to the middle of those of its first part. */
static int find_inside(slits *s, const work *w, err *e)
{
    const pieces_list *l = &w->j.x->part;
    const int64_t elements = w->j.x->elements + w->parts.before[l->cells];
    s->inside = mem_array(3 * elements, sizeof *s->inside, "slits", e);
    for (int64_t i = 0; s->inside && i < 3 * elements; i++)
        s->inside[i] = .5F;
    for (int64_t c = 0; s->inside && c < l->cells; c++) {
        const pieces_cell *p = &l->cell[c];
        const int64_t number = p->parts > 1 ? split_number(&w->parts, p) : -1;
        for (int32_t n = p->parts - 1; n >= 0; n--) {
            const joins_part part = {{p->cell[0], p->cell[1], p->cell[2]}, p->element, p, n};
            put_inside(w, &part, &s->inside[3 * split_element(&w->parts, p->element, number < 0 ? -1 : number + n)]);
        }
    }
    return s->inside ? 0 : -1;
}

int slits_find(slits *s, voxels *x, const cuts *cut, const inside_triangles *t, const grid *g, int samples,
               int32_t volumes, err *e)
{
    *s = (slits){0};
    work w = {0};
    int status = -1;
    const int64_t before = x->elements;
    if (joins_create(&w.j, x, cut, t, g, samples, e) || touching_find(&w.at, &w.j, e) ||
        split_create(&w.parts, &x->part, e) || join_parts(&w, e))
        goto out;
    split_number_elements(&w.parts);
    if (add_points(s, &w, e) || (s->nodes && samples > 1 && find_inside(s, &w, e)) ||
        split_voxels(&w.parts, x, samples, volumes, e))
        goto out;
    s->elements = x->elements - before;
    status = 0;
out:
    joins_free(&w.j);
    touching_free(&w.at);
    split_free(&w.parts);
    pieces_list_free(&x->part);
    free(w.alone);
    free(w.group);
    free(w.item);
    if (status)
        slits_free(s);
    return status;
}

void slits_free(slits *s)
{
    free(s->point);
    free(s->corner);
    free(s->inside);
    *s = (slits){0};
}
