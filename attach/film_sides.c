#include "film_sides.h"

#include "base/mem.h"
#include "surface/coincident.h"
#include "surface/triangle.h"
#include "surface/triangulate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double film_normal(const double *a, const double *b, const double *c, double normal[3])
{
    triangle_normal(a, b, c, normal);
    const double length = triangle_length(normal);
    for (int k = 0; k < 3; k++)
        normal[k] = length > 0 ? normal[k] / length : 0;
    return length;
}

double film_voxel(const film_sides *s, const double direction[3])
{
    double square = 0;
    for (int a = 0; a < 3; a++)
        square += pow(direction[a] * s->grid.spacing[a], 2);
    return sqrt(square);
}

/* ---- elements */

static void cell_of(const film_sides *s, const double place[3], int64_t cell[3])
{
    double local[3];
    lattice_local(&s->grid, place, local);
    for (int a = 0; a < 3; a++)
        cell[a] = (int64_t)floor(fmax(-1e9, fmin(1e9, local[a])));
}

static double share_of(const film_sides *s, int32_t element)
{
    double sum = 0;
    for (; element >= 0; element = lattice_next(&s->map, element))
        sum += s->fraction ? (double)s->fraction[element] : 1;
    return sum;
}

double film_share_at(const film_sides *s, const double place[3])
{
    int64_t cell[3];
    cell_of(s, place, cell);
    return share_of(s, lattice_element(&s->map, cell[0], cell[1], cell[2]));
}

/* How far a place is from what an element has inside, squared, in voxels. */
static double away_from(const film_sides *s, int32_t element, const double place[3])
{
    double local[3], square = 0;
    lattice_local(&s->grid, place, local);
    for (int a = 0; a < 3; a++) {
        const double at = s->inside ? (double)s->inside[3 * (int64_t)element + a] : .5;
        square += pow(local[a] - s->cell[3 * (int64_t)element + a] - at, 2);
    }
    return square;
}

int32_t film_element_in(const film_sides *s, const int64_t cell[3], const double place[3])
{
    int32_t best = lattice_element(&s->map, cell[0], cell[1], cell[2]);
    for (int32_t i = best; i >= 0; i = lattice_next(&s->map, i))
        if (away_from(s, i, place) < away_from(s, best, place))
            best = i;
    return best;
}

/* How far a place is outside of a cell, in voxels along the axis where that is most. */
static double outside_of(const film_sides *s, const int64_t cell[3], const double place[3])
{
    double local[3], most = 0;
    lattice_local(&s->grid, place, local);
    for (int a = 0; a < 3; a++)
        most = fmax(most, fabs(local[a] - (double)cell[a] - .5) - .5);
    return most;
}

int32_t film_element_near(const film_sides *s, const int64_t cell[3], const double place[3])
{
    int32_t best = film_element_in(s, cell, place);
    double least = (s->fraction ? .25 : .5) + 1e-9;
    if (best >= 0)
        return best;
    for (int i = 0; i < 27; i++) {
        const int64_t at[3] = {cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1};
        const int32_t element = film_element_in(s, at, place);
        const double away = outside_of(s, at, place);
        if (element >= 0 && away < least) {
            best = element;
            least = away;
        }
    }
    return best;
}

/* ---- pieces */

static double side_of(const film_piece *t, int i)
{
    double square = 0;
    for (int a = 0; a < 3; a++)
        square += pow(t->x[(i + 1) % 3][a] - t->x[i][a], 2);
    return square;
}

/* Halves a triangle at its longest side, i. */
static void halve(const film_piece *t, int i, film_piece *one, film_piece *other)
{
    const int j = (i + 1) % 3;
    *one = *other = *t;
    for (int a = 0; a < 3; a++) {
        one->x[j][a] = other->x[i][a] = (t->x[i][a] + t->x[j][a]) / 2;
        one->way[j][a] = other->way[i][a] = (t->way[i][a] + t->way[j][a]) / 2;
    }
}

/* Tells whether a triangle lies more than three voxels from every element: no film comes of such a triangle. */
static bool is_away(const film_sides *s, const film_piece *t)
{
    const double *h = s->grid.spacing, far = 3 * fmax(h[0], fmax(h[1], h[2]));
    for (int a = 0; a < 3; a++) {
        const double low = s->grid.origin[a] + h[a] * s->map.low[a], high = low + h[a] * s->map.size[a];
        if (fmax(t->x[0][a], fmax(t->x[1][a], t->x[2][a])) < low - far ||
            fmin(t->x[0][a], fmin(t->x[1][a], t->x[2][a])) > high + far)
            return true;
    }
    return false;
}

int film_pieces(const film_sides *s, const film_piece *triangle, int (*take)(void *context, const film_piece *piece),
                void *context)
{
    enum { MOST = 96 };
    const double *h = s->grid.spacing, least = fmin(h[0], fmin(h[1], h[2]));
    film_piece waiting[MOST] = {*triangle};
    int status = 0;
    for (int count = 1; count > 0 && !status;) {
        const film_piece one = waiting[--count];
        int longest = 0;
        if (is_away(s, &one))
            continue;
        for (int i = 1; i < 3; i++)
            longest = side_of(&one, i) > side_of(&one, longest) ? i : longest;
        if (side_of(&one, longest) > least * least && count + 2 <= MOST) {
            halve(&one, longest, &waiting[count], &waiting[count + 1]);
            count += 2;
        } else {
            status = take(context, &one);
        }
    }
    return status;
}

/* ---- sides */

/* How much tissue is on one side of a piece, 0 to 1: past the voxel that it is in, and past the next. n: its normal. */
static double tissue_beside(const film_sides *s, const film_piece *t, const double n[3], int side)
{
    double x[3], sum = 0;
    for (int i = 0; i < 2; i++) {
        for (int a = 0; a < 3; a++)
            x[a] = (t->x[0][a] + t->x[1][a] + t->x[2][a]) / 3 + side * (i ? 1.25 : .75) * film_voxel(s, n) * n[a];
        sum += fmin(film_share_at(s, x), 1) / 2;
    }
    return sum;
}

/* Of a triangle or a surface, over the area that has tissue beside it: what is on either side, the more of both, and
 * the area. */
typedef struct tissue {
    const film_sides *s;
    double above, below, most, area;
} tissue;

static int add_tissue(void *context, const film_piece *t)
{
    tissue *to = context;
    double n[3];
    const double area = film_normal(t->x[0], t->x[1], t->x[2], n) / 2;
    const double above = tissue_beside(to->s, t, n, 1), below = tissue_beside(to->s, t, n, -1);
    to->above += area * above;
    to->below += area * below;
    to->most += area * fmax(above, below);
    to->area += above > 0 || below > 0 ? area : 0;
    return 0;
}

static void add_triangle(const film_sides *s, const film_triangle *t, tissue *to)
{
    film_piece whole = {.way = {{0}}};
    for (int i = 0; i < 3; i++)
        memcpy(whole.x[i], s->position + 3 * (int64_t)t->vertex[i], sizeof whole.x[i]);
    to->s = s;
    film_pieces(s, &whole, add_tissue, to); /* never fails */
}

static double area_of(const film_sides *s, const film_triangle *t)
{
    double n[3];
    return film_normal(s->position + 3 * (int64_t)t->vertex[0], s->position + 3 * (int64_t)t->vertex[1],
                       s->position + 3 * (int64_t)t->vertex[2], n) /
           2;
}

/* of: the surface's. */
static void decide(const film_sides *s, film_triangle *t, const tissue *of)
{
    tissue own = {.area = 0};
    t->is_bounded = fabs(of->above - of->below) > .5 * of->most;
    if (t->is_bounded) {
        t->sides = of->above > of->below ? FILM_ABOVE : FILM_BELOW;
        return;
    }
    add_triangle(s, t, &own);
    t->sides = own.above > 0 && own.above > own.below - .5 * own.area ? FILM_ABOVE : 0;
    if (own.below > 0 && own.below > own.above - .5 * own.area)
        t->sides |= FILM_BELOW;
}

static int find_sides(film_sides *s, const rigid *r, err *e)
{
    tissue *of = mem_array(r->surfaces, sizeof *of, "the films", e);
    if (!of)
        return -1;
    for (int64_t i = 0; i < s->triangles; i++)
        add_triangle(s, &s->triangle[i], &of[s->triangle[i].anchor]);
    for (int64_t i = 0; i < s->triangles; i++)
        decide(s, &s->triangle[i], &of[s->triangle[i].anchor]);
    free(of);
    return 0;
}

/* ---- vertices */

static int gather(film_sides *s, const rigid *r, err *e)
{
    int64_t corners = 0, at = 0;
    for (int64_t i = 0; i < r->primitives; i++)
        corners += r->primitive[i].corners;
    s->position = mem_array(corners, 3 * sizeof *s->position, "the films", e);
    s->normal = mem_array(corners, 3 * sizeof *s->normal, "the films", e);
    s->place = mem_array(corners, sizeof *s->place, "the films", e);
    if (!s->position || !s->normal || !s->place)
        return -1;
    for (int64_t i = 0; i < r->primitives; i++)
        for (int64_t c = 0; c < r->primitive[i].corners; c++, at++)
            memcpy(s->position + 3 * at, r->primitive[i].position + 3 * (int64_t)r->primitive[i].vertex[c],
                   3 * sizeof *s->position);
    if (coincident_places(s->position, corners, s->place, e) < 0)
        return -1;
    for (int64_t i = 0; i < corners; i++) /* places are in the order of their first points */
        memmove(s->position + 3 * (int64_t)s->place[i], s->position + 3 * i, 3 * sizeof *s->position);
    return 0;
}

/* first: of its corners among all. */
static int add_primitive(film_sides *s, const rigid_primitive *p, int64_t first, err *e)
{
    const int64_t count = p->corners - 2;
    int32_t *corner = count < 1 ? NULL : mem_array(3 * count, sizeof *corner, "the films", e);
    if (count < 1)
        return 0;
    int status = corner ? triangulate(p->position, p->vertex, p->corners, corner, e) : -1;
    for (int64_t i = 0; !status && i < count; i++) {
        film_triangle t = {.anchor = p->surface};
        for (int c = 0; c < 3; c++)
            t.vertex[c] = s->place[first + corner[3 * i + c]];
        if (!(area_of(s, &t) > 0))
            continue;
        status = MEM_ROOM(&s->triangle, &s->room, s->triangles + 1, "the films", e);
        if (!status)
            s->triangle[s->triangles++] = t;
    }
    free(corner);
    return status;
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The means of normals by area, of triangles as they are turned to their tissue. */
static void find_normals(film_sides *s)
{
    for (int64_t i = 0; i < s->triangles; i++) {
        const film_triangle *t = &s->triangle[i];
        double n[3];
        const double sign = t->sides == FILM_BELOW ? -1 : 1, area = area_of(s, t) * sign;
        film_normal(s->position + 3 * (int64_t)t->vertex[0], s->position + 3 * (int64_t)t->vertex[1],
                    s->position + 3 * (int64_t)t->vertex[2], n);
        for (int k = 0; k < 9; k++)
            s->normal[3 * (int64_t)t->vertex[k / 3] + k % 3] += area * n[k % 3];
    }
}

void film_ways(const film_sides *s, const film_triangle *t, int side, double x[3][3], double way[3][3])
{
    double n[3];
    for (int i = 0; i < 3; i++)
        memcpy(x[i], s->position + 3 * (int64_t)t->vertex[i], sizeof x[i]);
    film_normal(x[0], x[1], x[2], n);
    for (int i = 0; i < 3; i++) {
        const double *m = s->normal + 3 * (int64_t)t->vertex[i];
        const double length = sqrt(dot(m, m)), cosine = dot(m, n);
        const bool is_sharp =
            !(fabs(cosine) > .5 * length); /* no more than twice as far as the faces that meet there */
        for (int a = 0; a < 3; a++)
            way[i][a] = side * (is_sharp ? n[a] : m[a] / cosine);
    }
}

double film_begins(const film_sides *s, const film_triangle *t, const double normal[3])
{
    return s->fraction || !t->is_bounded ? 0 : -film_voxel(s, normal) / 2;
}

int film_sides_make(film_sides *s, const model *m, const rigid *r, err *e)
{
    const model_array *fraction = model_find(m, "element.fraction"), *inside = model_find(m, "element.inside");
    int64_t first = 0;
    *s = (film_sides){.fraction = fraction ? fraction->f32 : NULL, .inside = inside ? inside->f32 : NULL};
    if (lattice_of(m, &s->grid, e) || lattice_map_build(&s->map, m, NULL, e) || gather(s, r, e))
        return -1;
    s->cell = model_find(m, "element.lattice")->i32;
    for (int64_t i = 0; i < r->primitives; first += r->primitive[i++].corners)
        if (add_primitive(s, &r->primitive[i], first, e))
            return -1;
    if (find_sides(s, r, e))
        return -1;
    find_normals(s);
    return 0;
}

void film_sides_free(film_sides *s)
{
    lattice_map_free(&s->map);
    free(s->triangle);
    free(s->position);
    free(s->normal);
    free(s->place);
    *s = (film_sides){0};
}
