#include "muscle_shape.h"

#include "base/mem.h"
#include "fibre_field.h"
#include "mesh/lattice.h"
#include "place/principal.h"
#include "surface/triangle_tree.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double cells_wanted = 2000, most_boxes = 2e6; /* cells of a muscle, and of the box about it */
static const double least_reach = 1.5;                     /* cells' sides: of the mean about a place */

/* All in a frame of its own. */
struct muscle_shape {
    double origin[3], axis[3][3]; /* of the frame: rows are its axes */
    int longest;                  /* axis, along which the surface is spread most */
    trimesh local;                /* the surface there */
    double side, low[3];          /* of a cell; the corner of the first one */
    int64_t count[3];             /* cells of the box */
    int32_t *cell;                /* count[2] x count[1] x count[0]: its number, -1 = none */
    int64_t cells;
    int32_t *box; /* cells: where in the box */
    float *fibre; /* cells x 3: in the frame */
    double spacing[3];
};

/* ---- the frame: principal axes of the surface, by area */

static const double *corner_of(const trimesh *t, int64_t triangle, int i)
{
    return t->position + 3 * (int64_t)t->corner[3 * triangle + i];
}

/* The triangle's middle. Returns its area. */
static double middle_of(const trimesh *t, int64_t triangle, double *middle)
{
    const double *x = corner_of(t, triangle, 0), *y = corner_of(t, triangle, 1), *z = corner_of(t, triangle, 2);
    double p[3], q[3], n[3];
    for (int a = 0; a < 3; a++) {
        middle[a] = (x[a] + y[a] + z[a]) / 3;
        p[a] = y[a] - x[a];
        q[a] = z[a] - x[a];
    }
    for (int a = 0; a < 3; a++)
        n[a] = p[(a + 1) % 3] * q[(a + 2) % 3] - p[(a + 2) % 3] * q[(a + 1) % 3];
    return sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
}

static void find_frame(muscle_shape *s, const trimesh *t)
{
    double all = 0, middle[3], c[3][3] = {{0}}, v[3][3];
    for (int64_t i = 0; i < t->triangles; i++) {
        const double area = middle_of(t, i, middle);
        all += area;
        for (int a = 0; a < 3; a++)
            s->origin[a] += area * middle[a];
    }
    for (int a = 0; a < 3; a++)
        s->origin[a] /= fmax(all, DBL_MIN);
    for (int64_t i = 0; i < t->triangles; i++) {
        const double area = middle_of(t, i, middle);
        for (int k = 0; k < 9; k++)
            c[k / 3][k % 3] += area * (middle[k / 3] - s->origin[k / 3]) * (middle[k % 3] - s->origin[k % 3]);
    }
    principal_axes(c, v);
    s->longest = principal_largest(c);
    for (int k = 0; k < 9; k++)
        s->axis[k / 3][k % 3] = v[k % 3][k / 3];
}

static void to_frame(const muscle_shape *s, const double *x, double *local)
{
    for (int k = 0; k < 3; k++) {
        local[k] = 0;
        for (int a = 0; a < 3; a++)
            local[k] += s->axis[k][a] * (x[a] - s->origin[a]);
    }
}

static int move_surface(muscle_shape *s, const trimesh *t, err *e)
{
    s->local = (trimesh){.vertices = t->vertices, .triangles = t->triangles};
    s->local.position = mem_array(t->vertices, 3 * sizeof *s->local.position, "a muscle's cells", e);
    s->local.corner = s->local.position ? mem_array(3 * t->triangles, sizeof *s->local.corner, "cells", e) : NULL;
    if (!s->local.corner)
        return -1;
    for (int64_t i = 0; i < t->vertices; i++)
        to_frame(s, t->position + 3 * i, s->local.position + 3 * i);
    memcpy(s->local.corner, t->corner, 3 * (size_t)t->triangles * sizeof *t->corner);
    return 0;
}

/* ---- cells */

/* The volume that it encloses, m3, by the divergence theorem. */
static double enclosed(const trimesh *t)
{
    double sum = 0;
    for (int64_t i = 0; i < t->triangles; i++) {
        const double *x = corner_of(t, i, 0), *y = corner_of(t, i, 1), *z = corner_of(t, i, 2);
        for (int a = 0; a < 3; a++)
            sum += x[a] * (y[(a + 1) % 3] * z[(a + 2) % 3] - y[(a + 2) % 3] * z[(a + 1) % 3]);
    }
    return fabs(sum) / 6;
}

/* Their side, and the box that they fill, in which they lie in the middle. False where there is nothing to fill. */
static bool choose_cells(muscle_shape *s)
{
    double high[3], box = 1;
    for (int a = 0; a < 3; a++) {
        s->low[a] = INFINITY, high[a] = -INFINITY;
        for (int64_t i = 0; i < s->local.vertices; i++) {
            s->low[a] = fmin(s->low[a], s->local.position[3 * i + a]);
            high[a] = fmax(high[a], s->local.position[3 * i + a]);
        }
        box *= high[a] - s->low[a];
    }
    s->side = fmax(cbrt(enclosed(&s->local) / cells_wanted), cbrt(box / most_boxes));
    if (!(s->side > 0))
        return false;
    for (int a = 0; a < 3; a++) {
        s->spacing[a] = s->side;
        s->count[a] = (int64_t)ceil((high[a] - s->low[a]) / s->side);
        s->count[a] = s->count[a] > 0 ? s->count[a] : 1;
        s->low[a] = (s->low[a] + high[a] - (double)s->count[a] * s->side) / 2;
    }
    return true;
}

static int64_t box_at(const muscle_shape *s, int64_t i, int64_t j, int64_t k)
{
    return (k * s->count[1] + j) * s->count[0] + i;
}

static void place_in_box(const muscle_shape *s, int64_t box, int64_t *at)
{
    at[0] = box % s->count[0];
    at[1] = box / s->count[0] % s->count[1];
    at[2] = box / s->count[0] / s->count[1];
}

static void middle_in_box(const muscle_shape *s, const int64_t *at, double *x)
{
    for (int a = 0; a < 3; a++)
        x[a] = s->low[a] + s->side * ((double)at[a] + .5);
}

/* Numbers the cells whose middle is inside. */
static void number_cells(muscle_shape *s, const triangle_tree *inside, int64_t boxes)
{
    int64_t at[3];
    double x[3];
    for (int64_t n = 0; n < boxes; n++) {
        place_in_box(s, n, at);
        middle_in_box(s, at, x);
        s->cell[n] = triangle_tree_holds(inside, x) ? (int32_t)s->cells++ : -1;
    }
}

static int fill_cells(muscle_shape *s, err *e)
{
    const int64_t boxes = s->count[0] * s->count[1] * s->count[2];
    s->cell = mem_array(boxes, sizeof *s->cell, "a muscle's cells", e);
    if (!s->cell)
        return -1;
    triangle_tree *inside = triangle_tree_create(s->local.position, s->local.corner, s->local.triangles, e);
    if (!inside)
        return -1;
    number_cells(s, inside, boxes);
    triangle_tree_destroy(inside);
    s->box = mem_array(s->cells, sizeof *s->box, "a muscle's cells", e);
    s->fibre = s->box ? mem_array(3 * s->cells, sizeof *s->fibre, "a muscle's cells", e) : NULL;
    for (int64_t n = 0; s->fibre && n < boxes; n++)
        if (s->cell[n] >= 0)
            s->box[s->cell[n]] = (int32_t)n;
    return s->fibre ? 0 : -1;
}

void muscle_shape_free(muscle_shape *s)
{
    if (!s)
        return;
    trimesh_free(&s->local);
    free(s->cell);
    free(s->box);
    free(s->fibre);
    free(s);
}

muscle_shape *muscle_shape_create(const trimesh *of, err *e)
{
    muscle_shape *s = mem_array(1, sizeof *s, "a muscle's cells", e);
    if (!s)
        return NULL;
    find_frame(s, of);
    if (!move_surface(s, of, e) && (!choose_cells(s) || !fill_cells(s, e)))
        return s;
    muscle_shape_free(s);
    return NULL;
}

int64_t muscle_shape_cells(const muscle_shape *s)
{
    return s->cells;
}

void muscle_shape_place(const muscle_shape *s, int64_t cell, double place[3])
{
    int64_t at[3];
    double local[3];
    place_in_box(s, s->box[cell], at);
    middle_in_box(s, at, local);
    for (int a = 0; a < 3; a++) {
        place[a] = s->origin[a];
        for (int k = 0; k < 3; k++)
            place[a] += s->axis[k][a] * local[k];
    }
}

/* ---- what the cells say of a place */

/* The mean of the cells' fibres within reach of a place, in the frame; those that point back, as they may in a bend,
 * are turned the way of the nearest. False: no cell is so near. */
static bool mean_fibre(const muscle_shape *s, const double *x, double reach, double *mean)
{
    int64_t from[3], to[3], at[3];
    double nearest = INFINITY, middle[3];
    const float *toward = NULL;
    for (int a = 0; a < 3; a++) {
        from[a] = (int64_t)fmax(floor((x[a] - reach - s->low[a]) / s->side), 0);
        to[a] = (int64_t)fmin(floor((x[a] + reach - s->low[a]) / s->side), (double)(s->count[a] - 1));
        mean[a] = 0;
    }
    for (int pass = 0; pass < 2; pass++)
        for (at[2] = from[2]; at[2] <= to[2]; at[2]++)
            for (at[1] = from[1]; at[1] <= to[1]; at[1]++)
                for (at[0] = from[0]; at[0] <= to[0]; at[0]++) {
                    const int32_t cell = s->cell[box_at(s, at[0], at[1], at[2])];
                    const float *f = cell < 0 ? NULL : s->fibre + 3 * (int64_t)cell;
                    if (!f || (f[0] == 0 && f[1] == 0 && f[2] == 0))
                        continue;
                    middle_in_box(s, at, middle);
                    double d2 = 0, turn = 0;
                    for (int a = 0; a < 3; a++)
                        d2 += (middle[a] - x[a]) * (middle[a] - x[a]);
                    if (!(d2 < reach * reach))
                        continue;
                    if (!pass) {
                        toward = d2 < nearest ? f : toward;
                        nearest = fmin(d2, nearest);
                        continue;
                    }
                    for (int a = 0; a < 3; a++)
                        turn += (double)(f[a] * toward[a]);
                    const double weight = copysign((1 - d2 / (reach * reach)) * (1 - d2 / (reach * reach)), turn);
                    for (int a = 0; a < 3; a++)
                        mean[a] += weight * (double)f[a];
                }
    return toward != NULL;
}

/* The longest side of an element's box. */
static double size_of(const body *b, int64_t element)
{
    double size = 0;
    for (int a = 0; a < 3; a++) {
        double low = INFINITY, high = -INFINITY;
        for (int n = 0; n < b->columns; n++) {
            const double x = b->position[3 * (int64_t)b->node[b->columns * element + n] + a];
            low = fmin(low, x), high = fmax(high, x);
        }
        size = fmax(size, high - low);
    }
    return size;
}

/* The fibre of an element: of the cells within half of its size, or, where there is none, of the nearest ones. */
static void take_fibre(const muscle_shape *s, const body *b, int64_t element, float *fibre)
{
    double x[3], centre[3], mean[3], length = 0, most = 0;
    body_centre(b, element, centre);
    to_frame(s, centre, x);
    for (int a = 0; a < 3; a++)
        most += fabs(x[a]) + s->side * (double)s->count[a];
    double reach = fmax(least_reach * s->side, size_of(b, element) / 2);
    while (!mean_fibre(s, x, reach, mean) && reach < most)
        reach *= 2;
    for (int a = 0; a < 3; a++)
        length += mean[a] * mean[a];
    length = sqrt(length);
    for (int a = 0; length > 0 && a < 3; a++) {
        double along = 0;
        for (int k = 0; k < 3; k++)
            along += s->axis[k][a] * mean[k];
        fibre[a] = (float)(along / length);
    }
}

/* ---- the potential in the cells */

/* The corners of cells, numbered as they come, and where they are in the frame. number: of the corners of the box. */
static int64_t number_nodes(const muscle_shape *s, int32_t *node, int32_t *number, double *position)
{
    const int64_t row = s->count[0] + 1, layer = row * (s->count[1] + 1);
    int64_t count = 0, at[3];
    for (int64_t n = 0; n < layer * (s->count[2] + 1); n++)
        number[n] = -1;
    for (int64_t i = 0; i < 8 * s->cells; i++) {
        place_in_box(s, s->box[i / 8], at);
        for (int a = 0; a < 3; a++)
            at[a] += lattice_vtk[i % 8][a];
        int32_t *to = &number[at[2] * layer + at[1] * row + at[0]];
        for (int a = 0; *to < 0 && a < 3; a++)
            position[3 * count + a] = s->low[a] + s->side * (double)at[a];
        if (*to < 0)
            *to = (int32_t)count++;
        node[i] = *to;
    }
    return count;
}

/* The arrays that a body of voxels has, all of them of volume 0, and nothing rigid. */
typedef struct cells_body {
    int32_t *node, *number, *volume, *part;
    double *position;
    int64_t *element, start[2];
} cells_body;

static int make_body(const muscle_shape *s, cells_body *c, body *b, err *e)
{
    static const char what[] = "a muscle's cells";
    const int64_t corners = (s->count[0] + 1) * (s->count[1] + 1) * (s->count[2] + 1);
    c->node = mem_array(8 * s->cells, sizeof *c->node, what, e);
    c->number = c->node ? mem_array(corners, sizeof *c->number, what, e) : NULL;
    c->position = c->number ? mem_array(24 * s->cells, sizeof *c->position, what, e) : NULL;
    c->volume = c->position ? mem_array(s->cells, sizeof *c->volume, what, e) : NULL;
    c->element = c->volume ? mem_array(s->cells, sizeof *c->element, what, e) : NULL;
    const int64_t nodes = c->element ? number_nodes(s, c->node, c->number, c->position) : 0;
    c->part = c->element ? mem_array(nodes, sizeof *c->part, what, e) : NULL;
    if (!c->part)
        return -1;
    for (int64_t n = 0; n < nodes; n++)
        c->part[n] = -1;
    for (int64_t i = 0; i < s->cells; i++)
        c->element[i] = i;
    c->start[1] = s->cells;
    *b = (body){.elements = s->cells,
                .nodes = nodes,
                .columns = 8,
                .position = c->position,
                .node = c->node,
                .volume = c->volume,
                .fibre = s->fibre,
                .part = c->part,
                .start = c->start,
                .element = c->element};
    return 0;
}

static int lay_fibres(muscle_shape *s, err *e)
{
    cells_body c = {0};
    body b;
    double axis[3] = {0};
    axis[s->longest] = 1;
    field *f = make_body(s, &c, &b, e) ? NULL : field_create(&b, s->spacing, e);
    muscle_field *m = f ? field_open(f, 0, e) : NULL;
    const int rc = m ? field_fibres(m, NULL, NULL, 0, axis, e) : -1;
    field_close(m);
    field_free(f);
    free(c.node);
    free(c.number);
    free(c.position);
    free(c.volume);
    free(c.element);
    free(c.part);
    return rc;
}

int muscle_shape_fibres(muscle_shape *s, const body *b, int32_t volume, err *e)
{
    if (!s->cells)
        return 0;
    if (lay_fibres(s, e))
        return -1;
    for (int64_t at = b->start[volume]; at < b->start[volume + 1]; at++)
        take_fibre(s, b, b->element[at], body_fibre(b, b->element[at], volume));
    return 0;
}
