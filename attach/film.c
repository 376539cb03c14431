#include "film.h"

#include "attach/shape/voxel_cut.h"
#include "base/mem.h"
#include "film_sides.h"
#include "mesh/cut_moments.h"
#include "mesh/held.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LAYERS = 4 }; /* of a film: its volume is summed in the middle of each */

enum { PRODUCTS = CUT_MOMENTS - 3 }; /* of places' coordinates in an element: xy, yz, zx and xyz */

/* A piece of a film, in one element. */
typedef struct patch {
    int32_t element, anchor;
    double point[3], normal[3], product[PRODUCTS]; /* times area */
    double area, depth;                            /* m2; m, times area */
    int64_t number;
} patch;

typedef struct maker {
    const film_sides *sides;
    const film_triangle *at; /* the one at hand */
    patch *patch;
    int64_t patches, room;
    double *part; /* elements x (1 + CUT_MOMENTS): what films have of its volume, and sums of its coordinates over it */
    double normal[3], depth, wider; /* of the triangle at hand: in how far its films are wider than at their points */
    double thick;                   /* m: of the layer at hand */
    double voxel;                   /* m3 */
    err *e;
} maker;

static void moved_by(const film_piece *t, double d, double to[3][3])
{
    for (int i = 0; i < 9; i++)
        to[i / 3][i % 3] = t->x[i / 3][i % 3] + d * t->way[i / 3][i % 3];
}

static double area_at(const film_piece *t, double d, double normal[3])
{
    double x[3][3];
    moved_by(t, d, x);
    return film_normal(x[0], x[1], x[2], normal) / 2;
}

/* ---- pieces */

/* Adds weight times the moments at a place, of a cell. */
static void add_place(const maker *k, const double x[3], const double cell[3], double weight, double to[CUT_MOMENTS])
{
    const lattice *l = &k->sides->grid;
    double u[3];
    for (int i = 0; i < 3; i++)
        u[i] = 2 * ((x[i] - l->origin[i]) / l->spacing[i] - cell[i]) - 1;
    const double by[CUT_MOMENTS] = {u[0], u[1], u[2], u[0] * u[1], u[1] * u[2], u[2] * u[0], u[0] * u[1] * u[2]};
    for (int i = 0; i < CUT_MOMENTS; i++)
        to[i] += weight * by[i];
}

/* Over a piece, by a rule on triangles that is exact for cubics: their middle, their sides' middles, their corners. */
static void add_piece(const maker *k, const voxel_piece *piece, const double cell[3], double thick,
                      double to[CUT_MOMENTS])
{
    for (int i = 1; i + 1 < piece->corners; i++) {
        const double *x[3] = {piece->corner[0], piece->corner[i], piece->corner[i + 1]};
        double n[3], middle[3];
        const double volume = film_normal(x[0], x[1], x[2], n) / 2 * thick;
        for (int a = 0; a < 3; a++)
            middle[a] = (x[0][a] + x[1][a] + x[2][a]) / 3;
        add_place(k, middle, cell, volume * 27 / 60, to);
        for (int c = 0; c < 3; c++) {
            const double *from = x[c], *next = x[(c + 1) % 3];
            const double side[3] = {(from[0] + next[0]) / 2, (from[1] + next[1]) / 2, (from[2] + next[2]) / 2};
            add_place(k, from, cell, volume * 3 / 60, to);
            add_place(k, side, cell, volume * 8 / 60, to);
        }
    }
}

static int take_patch(void *context, const voxel_piece *piece)
{
    maker *k = context;
    const int32_t element = film_element_near(k->sides, piece->cell, piece->middle);
    if (element < 0)
        return 0;
    if (MEM_ROOM(&k->patch, &k->room, k->patches + 1, "the films", k->e))
        return -1;
    const double area = piece->area * k->wider;
    patch *to = &k->patch[k->patches];
    const int32_t *cell = k->sides->cell + 3 * (int64_t)element;
    const double at[3] = {cell[0], cell[1], cell[2]};
    double moments[CUT_MOMENTS] = {0};
    add_piece(k, piece, at, k->wider, moments);
    *to = (patch){element, k->at->anchor, {0}, {0}, {0}, area, area * k->depth, k->patches};
    memcpy(to->product, moments + CUT_MOMENTS - PRODUCTS, sizeof to->product);
    for (int a = 0; a < 3; a++) {
        to->point[a] = area * piece->middle[a];
        to->normal[a] = area * k->normal[a];
    }
    k->patches++;
    return 0;
}

static int take_layer(void *context, const voxel_piece *piece)
{
    maker *k = context;
    const int32_t element = film_element_in(k->sides, piece->cell, piece->middle);
    const double cell[3] = {(double)piece->cell[0], (double)piece->cell[1], (double)piece->cell[2]};
    if (element < 0)
        return 0;
    double *to = k->part + (1 + CUT_MOMENTS) * (int64_t)element;
    to[0] += piece->area * k->thick;
    add_piece(k, piece, cell, k->thick, to + 1);
    return 0;
}

/* ---- triangles */

/* Half a voxel, or less where there is no tissue twice as deep: of a sheet that is thinner than a voxel films are a
 * half. 0: there is none at all. */
static double depth_of(const film_sides *s, const film_piece *t, const double normal[3])
{
    double depth = film_voxel(s, normal) / 2, x[3];
    for (int tries = 0; tries < 4; tries++) {
        for (int a = 0; a < 3; a++)
            x[a] = (t->x[0][a] + t->x[1][a] + t->x[2][a]) / 3 + 2 * depth * normal[a];
        if (film_share_at(s, x) > 0)
            return depth;
        depth /= 2;
    }
    return 0;
}

/* The films of a triangle that is small enough. */
static int add_films(void *context, const film_piece *t)
{
    maker *k = context;
    const lattice *l = &k->sides->grid;
    double x[3][3], n[3], from;
    area_at(t, 0, k->normal);
    k->depth = depth_of(k->sides, t, k->normal);
    if (!(k->depth > 0))
        return 0;
    moved_by(t, k->depth, x);
    k->wider = area_at(t, k->depth / 2, n) / area_at(t, k->depth, n);
    if (!isfinite(k->wider) || voxel_cut(l, x, take_patch, k))
        return isfinite(k->wider) ? -1 : 0;
    from = film_begins(k->sides, k->at, k->normal);
    k->thick = (k->depth - from) / LAYERS;
    for (int i = 0; i < LAYERS; i++) {
        moved_by(t, from + (i + .5) * k->thick, x);
        voxel_cut(l, x, take_layer, k); /* never fails */
    }
    return 0;
}

/* To one side, or to both. */
static int add_sides(maker *k)
{
    const film_triangle *of = k->at;
    for (int side = 1; side >= -1; side -= 2) {
        film_piece t = {.x = {{0}}};
        if (!(of->sides & (side > 0 ? FILM_ABOVE : FILM_BELOW)))
            continue;
        film_ways(k->sides, of, side, t.x, t.way);
        if (side < 0) { /* so that its normal turns too */
            const film_piece turned = t;
            memcpy(t.x[1], turned.x[2], sizeof t.x[1]), memcpy(t.x[2], turned.x[1], sizeof t.x[2]);
            memcpy(t.way[1], turned.way[2], sizeof t.way[1]), memcpy(t.way[2], turned.way[1], sizeof t.way[2]);
        }
        if (film_pieces(k->sides, &t, add_films, k))
            return -1;
    }
    return 0;
}

/* ---- arrays */

static int by_element(const void *a, const void *b)
{
    const patch *p = a, *q = b;
    if (p->element != q->element)
        return p->element < q->element ? -1 : 1;
    if (p->anchor != q->anchor)
        return p->anchor < q->anchor ? -1 : 1;
    return (p->number > q->number) - (p->number < q->number);
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Joins the pieces of an element that are one surface's and face one way: of a thin plate, the sides stay apart. */
static void join(maker *k)
{
    int64_t count = 0, first = 0;
    qsort(k->patch, (size_t)k->patches, sizeof *k->patch, by_element);
    for (int64_t i = 0; i < k->patches; i++) {
        const patch *from = &k->patch[i];
        patch *to = NULL;
        if (i && (from->element != k->patch[count - 1].element || from->anchor != k->patch[count - 1].anchor))
            first = count;
        for (int64_t j = first; j < count && !to; j++)
            to = dot(k->patch[j].normal, from->normal) > 0 ? &k->patch[j] : NULL;
        if (!to) {
            k->patch[count++] = *from;
            continue;
        }
        for (int a = 0; a < 3; a++) {
            to->point[a] += from->point[a];
            to->normal[a] += from->normal[a];
        }
        for (int a = 0; a < PRODUCTS; a++)
            to->product[a] += from->product[a];
        to->area += from->area;
        to->depth += from->depth;
    }
    k->patches = count;
}

/* The body of the node nearest to a film that its surface holds. */
static int add_bodies(const maker *k, model *m, const double *point, err *e)
{
    const model_array *body = model_find(m, "node.body"), *anchor = model_find(m, "node.anchor");
    held nearest;
    if (!body)
        return 0;
    model_array *to = model_add(m, "bone.body", e);
    if (!to || held_build(&nearest, model_find(m, "node.position")->f64, anchor->i32, anchor->rows,
                          (int32_t)model_count(m, "anchor"), e))
        return -1;
    for (int64_t i = 0; i < k->patches; i++) {
        const int32_t node = held_nearest(&nearest, k->patch[i].anchor, point + 3 * i);
        to->i32[i] = node < 0 ? -1 : body->i32[node];
    }
    held_free(&nearest);
    return 0;
}

static int write_bone(const maker *k, model *m, double *area, err *e)
{
    if (model_axis_add(m, "bone", k->patches, e))
        return -1;
    model_array *element = model_add(m, "bone.element", e), *anchor = element ? model_add(m, "bone.anchor", e) : NULL;
    model_array *point = anchor ? model_add(m, "bone.point", e) : NULL;
    model_array *normal = point ? model_add(m, "bone.normal", e) : NULL;
    model_array *depth = normal ? model_add(m, "bone.depth", e) : NULL;
    model_array *of_area = depth ? model_add(m, "bone.area", e) : NULL;
    model_array *products = of_area ? model_add(m, "bone.products", e) : NULL;
    for (int64_t i = 0; products && i < k->patches; i++) {
        const patch *p = &k->patch[i];
        const double length = sqrt(dot(p->normal, p->normal));
        element->i32[i] = p->element;
        anchor->i32[i] = p->anchor;
        for (int a = 0; a < 3; a++) {
            point->f64[3 * i + a] = p->point[a] / p->area;
            normal->f32[3 * i + a] = (float)(p->normal[a] / length);
        }
        for (int a = 0; a < PRODUCTS; a++)
            products->f32[PRODUCTS * i + a] = (float)(p->product[a] / p->area);
        depth->f64[i] = p->depth / p->area;
        of_area->f64[i] = p->area;
        *area += p->area;
    }
    return products ? add_bodies(k, m, point->f64, e) : -1;
}

static int write_film(const maker *k, model *m, int64_t elements, err *e)
{
    int64_t count = 0;
    for (int64_t i = 0; i < elements; i++)
        count += k->part[(1 + CUT_MOMENTS) * i] > 0;
    if (model_axis_add(m, "film", count, e))
        return -1;
    model_array *element = model_add(m, "film.element", e), *share = element ? model_add(m, "film.share", e) : NULL;
    model_array *moments = share ? model_add(m, "film.moments", e) : NULL;
    for (int64_t i = 0, at = 0; moments && i < elements; i++) {
        const double *of = k->part + (1 + CUT_MOMENTS) * i;
        if (!(of[0] > 0))
            continue;
        element->i32[at] = (int32_t)i;
        share->f32[at] = (float)fmin(of[0] / k->voxel, 1);
        for (int c = 0; c < CUT_MOMENTS; c++)
            moments->f32[CUT_MOMENTS * at + c] = (float)fmax(-1, fmin(1, of[1 + c] / of[0]));
        at++;
    }
    return moments ? 0 : -1;
}

void film_drop(model *m, notes *warnings)
{
    model_axis_drop(m, "bone", warnings);
    model_axis_drop(m, "film", warnings);
}

static int make(maker *k, model *m, double *area, err *e)
{
    const int64_t elements = model_count(m, "element");
    k->part = mem_array(elements, (1 + CUT_MOMENTS) * sizeof *k->part, "the films", e);
    if (!k->part)
        return -1;
    for (int64_t i = 0; i < k->sides->triangles; i++) {
        k->at = &k->sides->triangle[i];
        if (add_sides(k))
            return -1;
    }
    join(k);
    return write_bone(k, m, area, e) || write_film(k, m, elements, e) ? -1 : 0;
}

int film_make(model *m, const rigid *r, double *area, notes *warnings, err *e)
{
    film_sides sides;
    const int failed = film_sides_make(&sides, m, r, e);
    maker k = {.sides = &sides, .e = e};
    *area = 0;
    film_drop(m, warnings);
    if (!failed) {
        const double *h = sides.grid.spacing;
        k.voxel = h[0] * h[1] * h[2];
    }
    const int status = failed || make(&k, m, area, e) ? -1 : 0;
    model_array *fixed = model_find(m, "node.rigid");
    if (!status && fixed)
        memset(fixed->u8, 0, (size_t)fixed->rows);
    free(k.patch);
    free(k.part);
    film_sides_free(&sides);
    return status;
}
