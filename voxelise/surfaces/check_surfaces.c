#include "voxelise/surfaces/check_surfaces.h"

#include "base/mem.h"
#include "surface/triangulate.h"
#include "voxelise/surfaces/closed.h"
#include "voxelise/surfaces/expansion.h"
#include "voxelise/surfaces/meet.h"
#include "voxelise/surfaces/thin.h"
#include "voxelise/surfaces/weld.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A use of an edge. */
typedef struct use {
    uint64_t ends; /* lower vertex, higher vertex */
    int32_t polygon;
    bool back; /* from the higher to the lower */
} use;

/* A part that edges join is known by one of its polygons. */
typedef struct part {
    int32_t parent; /* its polygon, or one nearer to that */
    bool turned;    /* against its parent */
} part;

/* A shell: a part that has a triangle. */
typedef struct shell {
    double volume, point[3]; /* in one of its triangles */
    bool met, hollow;        /* it has its point; inside of an odd number of others */
} shell;

typedef struct work {
    const obj *o;
    const int64_t *face;
    int64_t faces;
    weld place;
    int32_t *polygon; /* triangles: of each */
    int32_t *vertex;  /* triangles x 3: places */
    int64_t triangles, capacity, vertex_capacity, cut_capacity;
    int32_t *cut;
    use *use;
    int64_t uses;
    part *part;      /* polygons */
    int32_t *number; /* polygons: a shell's, at the polygon that it is known by; -1 = none yet */
    shell *shell;
    shell **by_y; /* shells, by their points' y */
    double middle[3];
} work;

static void work_free(work *w)
{
    weld_free(&w->place);
    free(w->polygon);
    free(w->vertex);
    free(w->cut);
    free(w->use);
    free(w->part);
    free(w->number);
    free(w->shell);
    free(w->by_y);
}

static int64_t corner_count(const work *w, int64_t polygon)
{
    const int64_t *start = &w->o->face_start[w->face[polygon]];
    return start[1] - start[0];
}

static const int32_t *corners(const work *w, int64_t polygon)
{
    return &w->o->corner_vertex[w->o->face_start[w->face[polygon]]];
}

/* ---- triangles */

/* Whether three places are in a line: the exact cross product is 0. In doubles a component errs by
 * less than 8 epsilon of its two products. */
static bool is_degenerate(const double *a, const double *b, const double *c)
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double one = (b[j] - a[j]) * (c[k] - a[k]), other = (b[k] - a[k]) * (c[j] - a[j]);
        if (fabs(one - other) > 8 * DBL_EPSILON * (fabs(one) + fabs(other)))
            return false;
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double uj[2], uk[2], vj[2], vk[2], one[8], other[8], h[16];
        int nuj = expansion_of_sum(b[j], -a[j], uj), nuk = expansion_of_sum(b[k], -a[k], uk);
        int nvj = expansion_of_sum(c[j], -a[j], vj), nvk = expansion_of_sum(c[k], -a[k], vk);
        int n = expansion_product(nuj, uj, nvk, vk, one), m = expansion_product(nuk, uk, nvj, vj, other);
        expansion_negate(m, other);
        if (expansion_sum(n, one, m, other, h))
            return false;
    }
    return true;
}

static int add_triangles(work *w, int64_t polygon, check_result *r, err *e)
{
    int64_t count = corner_count(w, polygon) - 2;
    const int32_t *corner = corners(w, polygon);
    if (mem_grow(&w->cut, &w->cut_capacity, 3 * count, sizeof *w->cut, "triangles", e) ||
        mem_grow(&w->polygon, &w->capacity, w->triangles + count, sizeof *w->polygon, "triangles", e) ||
        mem_grow(&w->vertex, &w->vertex_capacity, 3 * (w->triangles + count), sizeof *w->vertex, "triangles", e) ||
        triangulate(w->o->position, corner, count + 2, w->cut, e))
        return -1;
    for (int64_t t = 0; t < count; t++) {
        int32_t *v = &w->vertex[3 * w->triangles];
        const double *p[3];
        for (int i = 0; i < 3; i++) {
            v[i] = w->place.of[corner[w->cut[3 * t + i]]];
            p[i] = &w->place.position[3 * (int64_t)v[i]];
        }
        r->degenerate += is_degenerate(p[0], p[1], p[2]);
        w->polygon[w->triangles++] = (int32_t)polygon;
    }
    return 0;
}

/* Of all polygons that were not given before. */
static int find_triangles(work *w, const bool *drop, check_result *r, err *e)
{
    for (int64_t i = 0; i < w->faces; i++)
        if (!drop[i] && add_triangles(w, i, r, e))
            return -1;
    r->triangles = w->triangles;
    return 0;
}

/* ---- edges */

static int compare_uses(const void *a, const void *b)
{
    const use *x = a, *y = b;
    if (x->ends != y->ends)
        return (x->ends > y->ends) - (x->ends < y->ends);
    return (x->polygon > y->polygon) - (x->polygon < y->polygon);
}

static int list_uses(work *w, const bool *drop, err *e)
{
    int64_t all = 0;
    for (int64_t i = 0; i < w->faces; i++)
        all += drop[i] ? 0 : corner_count(w, i);
    w->use = mem_array(all, sizeof *w->use, "edges", e);
    if (!w->use)
        return -1;
    for (int64_t i = 0; i < w->faces; i++)
        for (int64_t c = 0, n = corner_count(w, i); !drop[i] && c < n; c++) {
            int32_t a = w->place.of[corners(w, i)[c]], b = w->place.of[corners(w, i)[(c + 1) % n]];
            uint64_t low = (uint64_t)(a < b ? a : b);
            uint64_t high = (uint64_t)(a < b ? b : a);
            if (a != b)
                w->use[w->uses++] = (use){low << 32 | high, (int32_t)i, a > b};
        }
    qsort(w->use, (size_t)w->uses, sizeof *w->use, compare_uses);
    return 0;
}

/* The polygon that a part is known by, and whether this one is turned against it. */
static int32_t part_of(const work *w, int32_t polygon, bool *turned)
{
    *turned = false;
    while (w->part[polygon].parent != polygon) {
        part *p = &w->part[polygon];
        const part *above = &w->part[p->parent];
        p->turned = p->turned != above->turned;
        p->parent = above->parent;
        *turned = *turned != p->turned;
        polygon = p->parent;
    }
    return polygon;
}

/* Two polygons that share an edge face the same way where they run along it in opposite directions. */
static void join(const work *w, const use *a, const use *b)
{
    bool one, other, same = a->back == b->back;
    int32_t p = part_of(w, a->polygon, &one), q = part_of(w, b->polygon, &other);
    if (p != q)
        w->part[p] = (part){q, (one != other) != same};
}

static int join_edges(work *w, check_result *r, err *e)
{
    w->part = mem_array(w->faces, sizeof *w->part, "polygons", e);
    if (!w->part)
        return -1;
    for (int64_t i = 0; i < w->faces; i++)
        w->part[i].parent = (int32_t)i;
    for (int64_t from = 0, to; from < w->uses; from = to) {
        for (to = from + 1; to < w->uses && w->use[to].ends == w->use[from].ends; to++)
            join(w, &w->use[from], &w->use[to]);
        r->open += to - from == 1;
        r->crowded += to - from > 2;
        r->turned += to - from == 2 && w->use[from].back == w->use[from + 1].back;
    }
    return 0;
}

/* ---- shells */

static const double *place(const work *w, int64_t triangle, int corner)
{
    return &w->place.position[3 * (int64_t)w->vertex[3 * triangle + corner]];
}

/* Six times the volume of the cone over a triangle from the middle, and twice its area. */
static double cone(const work *w, int64_t triangle, double *area)
{
    double p[3][3], n[3];
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++)
            p[i][a] = place(w, triangle, i)[a] - w->middle[a];
    for (int a = 0; a < 3; a++) {
        int j = (a + 1) % 3, k = (a + 2) % 3;
        n[a] = (p[1][j] - p[0][j]) * (p[2][k] - p[0][k]) - (p[1][k] - p[0][k]) * (p[2][j] - p[0][j]);
    }
    *area = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    return n[0] * p[0][0] + n[1] * p[0][1] + n[2] * p[0][2];
}

static int number_shells(work *w, check_result *r, err *e)
{
    w->number = mem_array(w->faces, sizeof *w->number, "shells", e);
    if (!w->number)
        return -1;
    memset(w->number, -1, (size_t)w->faces * sizeof *w->number);
    for (int64_t t = 0; t < w->triangles; t++) {
        bool turned;
        int32_t *number = &w->number[part_of(w, w->polygon[t], &turned)];
        if (*number < 0)
            *number = (int32_t)r->shells++;
    }
    w->shell = mem_array(r->shells, sizeof *w->shell, "shells", e);
    w->by_y = mem_array(r->shells, sizeof(shell *), "shells", e);
    return w->shell && w->by_y ? 0 : -1;
}

static shell *shell_of(const work *w, int64_t triangle, bool *turned)
{
    return &w->shell[w->number[part_of(w, w->polygon[triangle], turned)]];
}

/* A point in the inside of a triangle, off its lines of symmetry. */
static void place_point(const work *w, int64_t triangle, double *q)
{
    for (int a = 0; a < 3; a++)
        q[a] = 0.3 * place(w, triangle, 0)[a] + 0.36 * place(w, triangle, 1)[a] + 0.34 * place(w, triangle, 2)[a];
}

static void measure_shells(work *w, check_result *r)
{
    for (int64_t t = 0; t < w->triangles; t++) {
        bool turned;
        double area, six = cone(w, t, &area);
        shell *s = shell_of(w, t, &turned);
        s->volume += turned ? -six / 6 : six / 6;
        r->area += area / 2;
        if (!s->met)
            place_point(w, t, s->point);
        s->met = true;
    }
}

/* Whether a ray from q along x crosses a triangle. */
static bool crosses(const double *const *p, const double *q)
{
    bool within = false;
    double x = 0;
    for (int i = 0; i < 3; i++) {
        const double *a = p[i], *b = p[(i + 1) % 3], *swap = a;
        if (b[1] < a[1])
            a = b, b = swap; /* an edge's two triangles round alike */
        if ((a[1] > q[1]) != (b[1] > q[1]) && (q[2] - a[2] < (b[2] - a[2]) * (q[1] - a[1]) / (b[1] - a[1])))
            within = !within;
    }
    if (!within)
        return false;
    double u[3], v[3], n[3];
    for (int a = 0; a < 3; a++)
        u[a] = p[1][a] - p[0][a], v[a] = p[2][a] - p[0][a];
    for (int a = 0; a < 3; a++)
        n[a] = u[(a + 1) % 3] * v[(a + 2) % 3] - u[(a + 2) % 3] * v[(a + 1) % 3];
    x = p[0][0] - (n[1] * (q[1] - p[0][1]) + n[2] * (q[2] - p[0][2])) / n[0];
    return x > q[0];
}

static int compare_y(const void *a, const void *b)
{
    const shell *x = *(shell *const *)a, *y = *(shell *const *)b;
    if (x->point[1] != y->point[1])
        return (x->point[1] > y->point[1]) - (x->point[1] < y->point[1]);
    return (x > y) - (x < y);
}

/* The first shell whose point is not below y. */
static int64_t first_above(const work *w, int64_t shells, double y)
{
    int64_t from = 0, to = shells;
    while (from < to) {
        int64_t middle = from + (to - from) / 2;
        if (w->by_y[middle]->point[1] < y)
            from = middle + 1;
        else
            to = middle;
    }
    return from;
}

/* Which shells are inside of an odd number of others, so that they bound hollows: rays from their points cross these
 * oddly. A triangle looks only at the points that are as high along y as it is. */
static void find_hollows(work *w, int64_t shells)
{
    for (int64_t s = 0; s < shells; s++)
        w->by_y[s] = &w->shell[s];
    qsort(w->by_y, (size_t)shells, sizeof(shell *), compare_y);
    for (int64_t t = 0; shells > 1 && t < w->triangles; t++) {
        bool turned;
        const shell *own = shell_of(w, t, &turned);
        const double *p[3] = {place(w, t, 0), place(w, t, 1), place(w, t, 2)};
        double high = fmax(p[0][1], fmax(p[1][1], p[2][1]));
        int64_t i = first_above(w, shells, fmin(p[0][1], fmin(p[1][1], p[2][1])));
        for (; i < shells && w->by_y[i]->point[1] <= high; i++)
            if (w->by_y[i] != own && crosses(p, w->by_y[i]->point))
                w->by_y[i]->hollow = !w->by_y[i]->hollow;
    }
}

/* ---- all of it */

/* Makes every triangle face out of its shell: what lies behind it is inside. */
static void face_out(work *w)
{
    for (int64_t t = 0; t < w->triangles; t++) {
        bool turned;
        const shell *s = shell_of(w, t, &turned);
        int32_t *v = &w->vertex[3 * t], second = v[1];
        if (turned != (s->volume < 0))
            v[1] = v[2], v[2] = second;
    }
}

static int measure(work *w, check_result *r, const double *voxel, int threads, err *e)
{
    for (int a = 0; a < 3; a++)
        w->middle[a] = w->triangles ? r->low[a] / 2 + r->high[a] / 2 : 0;
    if (number_shells(w, r, e))
        return -1;
    measure_shells(w, r);
    r->thin = NAN;
    if (meet_count(w->place.position, w->vertex, w->triangles, threads, &r->met, &r->deepest, e))
        return -1;
    if (r->open)
        return 0;
    find_hollows(w, r->shells);
    for (int64_t s = 0; s < r->shells; s++)
        r->volume += fabs(w->shell[s].volume) * (w->shell[s].hollow ? -1 : 1);
    face_out(w);
    return voxel ? thin_share(w->place.position, w->place.places, w->vertex, w->triangles, voxel, threads, &r->thin, e)
                 : 0;
}

int check_surface(check_result *r, const obj *o, const int64_t *face, int64_t faces, const double *voxel, int threads,
                  err *e)
{
    work w = {.o = o, .face = face, .faces = faces};
    closed_result closed = {0};
    *r = (check_result){.polygons = faces};
    int status = -1;
    if (faces > INT32_MAX) {
        err_set(e, o->name, 0, "%lld polygons; at most %d can be checked", (long long)faces, INT32_MAX);
        return -1;
    }
    int32_t *surface = mem_array(faces, sizeof *surface, "polygons", e);
    if (!surface || weld_make(&w.place, o, face, faces, e))
        goto out;
    closed_polygons p = {
        .o = o, .weld = w.place.of, .face = face, .surface = surface, .polygons = faces, .surfaces = 1};
    if (closed_check(&p, &closed, e))
        goto out;
    r->vertices = w.place.places;
    r->repeated = closed.once + closed.cancelled;
    memcpy(r->low, w.place.low, sizeof r->low);
    memcpy(r->high, w.place.high, sizeof r->high);
    if (find_triangles(&w, closed.drop, r, e) || list_uses(&w, closed.drop, e) || join_edges(&w, r, e) ||
        measure(&w, r, voxel, threads, e))
        goto out;
    status = 0;
out:
    closed_free(&closed);
    free(surface);
    work_free(&w);
    return status;
}
