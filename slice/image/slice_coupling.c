#include "slice/image/slice_coupling.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>

enum { BLACK = 255 };

/* m, m2: a beam that runs along an edge between two pieces is in one of them, whatever was rounded. */
static const double near = 1e-12;

static void make_beam(slice_coupling *c, const slice_view *v, double gap, int32_t i)
{
    double *b = c->beam + 4 * (int64_t)i;
    double way[2] = {0, 1};
    b[0] = v->corner[0] + v->pixel[0] * i;
    b[1] = 0;
    if (v->probe.array != SLICE_LINEAR) {
        const double angle = v->probe.angle * ((i + .5) / c->beams - .5);
        way[0] = sin(angle);
        way[1] = cos(angle);
        b[0] = v->probe.radius * way[0];
        b[1] = v->probe.radius * (way[1] - 1);
    }
    for (int a = 0; a < 2; a++)
        b[2 + a] = b[a] + gap * way[a];
    const double column = (b[0] - v->corner[0]) / v->pixel[0];
    c->shown[i] = column >= -.5 && column <= v->size.columns - .5;
    for (int end = 1; end < 4; end += 2) {
        const double row = (b[end] - v->corner[1]) / v->pixel[1];
        c->from = fmin(c->from, row - .5);
        c->to = fmax(c->to, row + .5);
    }
}

/* Of the pixels of a fan. */
static int make_table(slice_coupling *c, const slice_view *v, err *e)
{
    c->of = mem_array((int64_t)c->size.rows * c->size.columns, sizeof *c->of, "beams", e);
    for (int32_t r = 0; c->of && r < c->size.rows; r++)
        for (int32_t k = 0; k < c->size.columns; k++) {
            const double x = v->corner[0] + v->pixel[0] * k, z = v->corner[1] + v->pixel[1] * r + v->probe.radius;
            const double at = floor((atan2(x, z) / v->probe.angle + .5) * c->beams);
            c->of[(int64_t)r * c->size.columns + k] = (uint16_t)fmin(fmax(at, 0), c->beams - 1);
        }
    return c->of ? 0 : -1;
}

static int32_t reach_of(const slice_view *v, int32_t beams)
{
    const double step = v->probe.array == SLICE_LINEAR ? v->pixel[0] : v->probe.radius * v->probe.angle / beams;
    const double reach = SLICE_APERTURE / 2 / step;
    return reach < beams ? (int32_t)(reach + .5) : beams;
}

int slice_coupling_make(slice_coupling *c, const slice_view *v, double gap, double range, err *e)
{
    *c = (slice_coupling){.beams = v->size.columns, .size = v->size, .range = range, .from = INFINITY, .to = -INFINITY};
    c->reach = reach_of(v, c->beams);
    for (int a = 0; a < 2; a++) {
        c->pixel[a] = v->pixel[a];
        c->corner[a] = v->corner[a];
    }
    c->beam = mem_array(4 * (int64_t)c->beams, sizeof *c->beam, "beams", e);
    c->shown = mem_array(c->beams, 1, "beams", e);
    c->coupled = mem_array(c->beams, 1, "beams", e);
    c->loss = mem_array(c->beams, 1, "beams", e);
    if (!c->beam || !c->shown || !c->coupled || !c->loss)
        return -1;
    for (int32_t i = 0; i < c->beams; i++)
        make_beam(c, v, gap, i);
    return v->probe.array == SLICE_LINEAR ? 0 : make_table(c, v, e);
}

void slice_coupling_free(slice_coupling *c)
{
    free(c->beam);
    free(c->shown);
    free(c->coupled);
    free(c->loss);
    free(c->of);
    *c = (slice_coupling){0};
}

/* ---- which beams are coupled */

/* A polygon in which the image's plane cuts a tetrahedron; m. */
typedef struct polygon {
    int corners;
    double x[4], z[4], low, high; /* within low to high along x */
    double sense;                 /* 1: around counter-clockwise; -1 */
} polygon;

/* Most pieces lie deeper than the gap. */
static bool is_near(const slice_coupling *c, const slice_piece *p)
{
    bool above = false, below = false;
    for (int k = 0; k < p->corners; k++) {
        above |= p->v[k] <= c->to;
        below |= p->v[k] >= c->from;
    }
    return above && below;
}

static bool take_polygon(const slice_coupling *c, const slice_piece *p, polygon *to)
{
    double area = 0;
    if (!is_near(c, p))
        return false;
    *to = (polygon){.corners = p->corners, .low = INFINITY, .high = -INFINITY};
    for (int k = 0; k < p->corners; k++) {
        to->x[k] = c->corner[0] + c->pixel[0] * p->u[k];
        to->z[k] = c->corner[1] + c->pixel[1] * p->v[k];
        to->low = fmin(to->low, to->x[k]);
        to->high = fmax(to->high, to->x[k]);
    }
    for (int k = 0; k < p->corners; k++) {
        const int next = k + 1 < p->corners ? k + 1 : 0;
        area += to->x[k] * to->z[next] - to->x[next] * to->z[k];
    }
    to->sense = area < 0 ? -1 : 1;
    return area != 0;
}

/* Whether a beam's first part, b, has a point in common with it: what the sides leave of it. */
static bool meets(const polygon *p, const double b[4])
{
    double from = 0, to = 1;
    for (int k = 0; k < p->corners && from <= to; k++) {
        const int next = k + 1 < p->corners ? k + 1 : 0;
        const double x = p->sense * (p->x[next] - p->x[k]), z = p->sense * (p->z[next] - p->z[k]);
        const double start = x * (b[1] - p->z[k]) - z * (b[0] - p->x[k]) + near; /* above 0: within */
        const double grows = x * (b[3] - b[1]) - z * (b[2] - b[0]);
        if (grows > 0)
            from = fmax(from, -start / grows);
        else if (grows < 0)
            to = fmin(to, -start / grows);
        else if (start < 0)
            return false;
    }
    return from <= to;
}

/* The first beam that gets to this x; from beam to beam, no end of one goes back. */
static int32_t first_at(const slice_coupling *c, double x)
{
    int32_t low = 0, high = c->beams;
    while (low < high) {
        const int32_t middle = low + (high - low) / 2;
        const double *b = c->beam + 4 * (int64_t)middle;
        if (b[0] < x && b[2] < x)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static void couple(slice_coupling *c, const polygon *p)
{
    for (int32_t i = first_at(c, p->low - near); i < c->beams; i++) {
        const double *b = c->beam + 4 * (int64_t)i;
        if (b[0] > p->high + near && b[2] > p->high + near)
            break;
        c->coupled[i] = c->coupled[i] || meets(p, b);
    }
}

/* A beam that begins beside the image is not known, and in no aperture. */
static void lose(slice_coupling *c)
{
    c->dark = false;
    for (int32_t i = 0; i < c->beams; i++) {
        int32_t all = 0, some = 0;
        const int32_t first = i > c->reach ? i - c->reach : 0, last = i + c->reach;
        for (int32_t k = first; k <= last && k < c->beams; k++) {
            all += c->shown[k];
            some += c->shown[k] && c->coupled[k];
        }
        const double less = some ? 40 * log10((double)all / some) * 255 / c->range : BLACK;
        c->loss[i] = (uint8_t)lrint(fmin(less, BLACK));
        c->dark |= c->loss[i] > 0;
    }
}

void slice_coupling_find(slice_coupling *c, const slice_cutter *from)
{
    const int32_t *list;
    const int64_t count = slice_cutter_list(from, &list);
    for (int32_t i = 0; i < c->beams; i++)
        c->coupled[i] = 0;
    for (int64_t i = 0; i < count; i++) {
        polygon p;
        slice_piece room;
        if (take_polygon(c, slice_cutter_piece(from, i, &room), &p))
            couple(c, &p);
    }
    lose(c);
}

/* ---- pixels */

static uint8_t loss_at(const slice_coupling *c, int32_t row, int32_t column)
{
    return c->loss[c->of ? c->of[(int64_t)row * c->size.columns + column] : column];
}

void slice_coupling_darken(const slice_coupling *c, uint8_t *image)
{
    for (int32_t r = 0; c->dark && r < c->size.rows; r++)
        for (int32_t k = 0; k < c->size.columns; k++) {
            uint8_t *level = &image[(int64_t)r * c->size.columns + k];
            const uint8_t less = loss_at(c, r, k);
            *level = *level > less ? (uint8_t)(*level - less) : 0;
        }
}

void slice_coupling_hide(const slice_coupling *c, uint8_t *labels)
{
    for (int32_t r = 0; c->dark && r < c->size.rows; r++)
        for (int32_t k = 0; k < c->size.columns; k++)
            if (loss_at(c, r, k) == BLACK)
                labels[(int64_t)r * c->size.columns + k] = 0;
}
