#include "probe/narrow.h"

#include <ccd/ccd.h>

/* Of EPA, of what is squared; lengths are over the probe's reach here, since it is absolute. */
static const double tolerance = 1e-9;

typedef struct body {
    const probe_placed *placed;
    const double *first; /* the direction in which the search begins */
} body;

typedef struct ball {
    ccd_vec3_t centre;
    double radius;
} ball;

static void put(ccd_vec3_t *to, const double x[3])
{
    for (int a = 0; a < 3; a++)
        to->v[a] = x[a];
}

static void far_of_probe(const void *object, const ccd_vec3_t *way, ccd_vec3_t *to)
{
    const probe_placed *placed = ((const body *)object)->placed;
    const probe *p = &placed->shape;
    double d[3], own[3];
    for (int i = 0; i < 3; i++)
        d[i] = placed->axis[i][0] * way->v[0] + placed->axis[i][1] * way->v[1] + placed->axis[i][2] * way->v[2];
    probe_farthest(p, d, own);
    for (int a = 0; a < 3; a++) {
        double x = placed->origin[a];
        for (int i = 0; i < 3; i++)
            x += placed->axis[i][a] * own[i];
        to->v[a] = x / p->reach;
    }
}

static void middle_of_probe(const void *object, ccd_vec3_t *to)
{
    const probe_placed *placed = ((const body *)object)->placed;
    put(to, placed->centre);
    ccdVec3Scale(to, 1 / placed->shape.reach);
}

static void far_of_ball(const void *object, const ccd_vec3_t *way, ccd_vec3_t *to)
{
    const ball *b = object;
    const double length = sqrt(ccdVec3Len2(way));
    ccdVec3Copy(to, way);
    ccdVec3Scale(to, length > 0 ? b->radius / length : 0);
    ccdVec3Add(to, &b->centre);
}

static void middle_of_ball(const void *object, ccd_vec3_t *to)
{
    ccdVec3Copy(to, &((const ball *)object)->centre);
}

static void first_way(const void *object, const void *other, ccd_vec3_t *way)
{
    (void)other;
    put(way, ((const body *)object)->first);
}

/* All within a radius of a triangle. */
typedef struct plate {
    ccd_vec3_t corner[3];
    double radius;
} plate;

static void far_of_plate(const void *object, const ccd_vec3_t *way, ccd_vec3_t *to)
{
    const plate *t = object;
    const double length = sqrt(ccdVec3Len2(way));
    int farthest = 0;
    for (int i = 1; i < 3; i++)
        if (ccdVec3Dot(way, &t->corner[i]) > ccdVec3Dot(way, &t->corner[farthest]))
            farthest = i;
    ccdVec3Copy(to, way);
    ccdVec3Scale(to, length > 0 ? t->radius / length : 0);
    ccdVec3Add(to, &t->corner[farthest]);
}

static bool meet(const probe_placed *p, const plate *t)
{
    static const double first[3] = {.3, .5, .8};
    const body probe_body = {p, first};
    ccd_t how;
    CCD_INIT(&how);
    how.support1 = far_of_probe;
    how.support2 = far_of_plate;
    how.first_dir = first_way;
    how.max_iterations = 500;
    return ccdGJKIntersect(&probe_body, t, &how) != 0;
}

double narrow_gap(const probe_placed *p, const double triangle[9], double most, double fine)
{
    plate t = {.radius = most / p->shape.reach};
    double low = 0, high = most;
    for (int i = 0; i < 3; i++) {
        put(&t.corner[i], triangle + 3 * (size_t)i);
        ccdVec3Scale(&t.corner[i], 1 / p->shape.reach);
    }
    if (!(most > 0) || !meet(p, &t))
        return most;
    while (high - low > fine) {
        const double middle = (low + high) / 2;
        t.radius = middle / p->shape.reach;
        if (meet(p, &t))
            high = middle;
        else
            low = middle;
    }
    return low;
}

bool narrow_at(const probe_placed *p, const double x[3], double radius, int starts, probe_touch *t)
{
    static const double firsts[NARROW_STARTS][3] = {{1, 0, 0},    {0, 0, 1},     {.3, .5, .8}, {-.7, .6, .4},
                                                    {0, -.8, .6}, {.9, -.1, .4}, {0, 1, 0},    {-.5, -.5, -.7}};
    ball b = {.radius = radius / p->shape.reach};
    ccd_t how;
    CCD_INIT(&how);
    how.support1 = far_of_probe;
    how.support2 = far_of_ball;
    how.center1 = middle_of_probe;
    how.center2 = middle_of_ball;
    how.first_dir = first_way;
    how.max_iterations = 500;
    how.epa_tolerance = tolerance;
    put(&b.centre, x);
    ccdVec3Scale(&b.centre, 1 / p->shape.reach);
    t->depth = -INFINITY;
    for (int i = 0; i < starts && i < NARROW_STARTS; i++) {
        const body probe_body = {p, firsts[i]};
        ccd_real_t depth;
        ccd_vec3_t way, where;
        if (ccdGJKPenetration(&probe_body, &b, &how, &depth, &way, &where) != 0 || depth * p->shape.reach < t->depth)
            continue;
        t->depth = depth * p->shape.reach;
        for (int a = 0; a < 3; a++)
            t->way[a] = way.v[a];
    }
    return t->depth >= 0;
}
