#include "voxelise/solids.h"

#include "base/mem.h"
#include "surface/triangulate.h"
#include "voxelise/surfaces/closed.h"
#include "voxelise/surfaces/weld.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What is needed on the way. */
typedef struct work {
    const obj *o;
    const volumes *plan;
    solids *s;
    num_unit unit;
    bool sheets;
    weld place;       /* the vertices of s */
    int64_t *start;   /* volumes + 1: the first of a volume's polygons */
    int64_t *face;    /* polygons, volume after volume */
    int32_t *surface; /* polygons */
    int32_t *cut;     /* triangles of one polygon */
    int64_t cut_capacity, vertex_capacity, volume_capacity, rigid_capacity;
} work;

static void work_free(work *w)
{
    weld_free(&w->place);
    free(w->start);
    free(w->face);
    free(w->surface);
    free(w->cut);
}

static bool is_polygon(const obj *o, int64_t face)
{
    return o->face_start[face + 1] - o->face_start[face] >= 3;
}

/* ---- polygons by volume */

static int gather_polygons(work *w, err *e)
{
    const obj *o = w->o;
    const volumes *plan = w->plan;
    w->start = mem_array((int64_t)plan->volumes + 2, sizeof *w->start, "polygons", e);
    if (!w->start)
        return -1;
    /* Counted two places up, so that filling leaves each volume's first in its place. */
    for (int64_t f = 0; f < o->faces; f++)
        for (int64_t m = plan->group_start[o->face_group[f]]; m < plan->group_start[o->face_group[f] + 1]; m++)
            w->start[plan->member[m].volume + 2] += is_polygon(o, f);
    for (int32_t v = 0; v < plan->volumes; v++)
        w->start[v + 2] += w->start[v + 1];
    int64_t polygons = w->start[plan->volumes + 1];
    w->face = mem_array(polygons, sizeof *w->face, "polygons", e);
    w->surface = mem_array(polygons, sizeof *w->surface, "polygons", e);
    if (!w->face || !w->surface)
        return -1;
    for (int64_t f = 0; f < o->faces; f++)
        for (int64_t m = plan->group_start[o->face_group[f]]; m < plan->group_start[o->face_group[f] + 1]; m++) {
            if (!is_polygon(o, f))
                continue;
            int64_t at = w->start[plan->member[m].volume + 1]++;
            w->face[at] = f;
            w->surface[at] = plan->member[m].surface;
        }
    return 0;
}

/* ---- volume after volume */

/* "skin 8, skull 4" */
static void name_open(const work *w, const closed_result *r, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (int32_t s = 0; s < w->plan->surfaces; s++) {
        if (!r->open_of[s])
            continue;
        int wrote = snprintf(text + used, size - used, "%s%s %lld", used ? ", " : "", w->plan->surface[s].name,
                             (long long)r->open_of[s]);
        if (wrote < 0 || (size_t)wrote >= size - used)
            return;
        used += (size_t)wrote;
    }
}

static void find_open(const work *w, const closed_result *r, double at[3])
{
    for (int a = 0; a < 3 && r->open; a++)
        at[a] = (w->place.position[3 * r->first[0] + a] + w->place.position[3 * r->first[1] + a]) / 2;
}

static int report(const work *w, int32_t number, const closed_result *r, bool allow_open, notes *warnings, err *e)
{
    const char *volume = w->plan->volume[number].name, *unit = num_unit_name(w->unit);
    const double *at = w->s->open_at[number];
    if (r->cancelled)
        notes_add(warnings,
                  "volume %s repeats polygons (%lld of them): they cancel in pairs, as where two solids touch", volume,
                  (long long)r->cancelled);
    if (r->once)
        notes_add(warnings, "volume %s repeats polygons (%lld of them): each counts once", volume, (long long)r->once);
    if (!r->open)
        return 0;
    char names[500];
    name_open(w, r, names, sizeof names);
    if (allow_open) {
        notes_add(
            warnings,
            "volume %s is open: %lld open edges (%s), the first at %.6g%s,%.6g%s,%.6g%s; what is inside it is a guess",
            volume, (long long)r->open, names, at[0], unit, at[1], unit, at[2], unit);
        return 0;
    }
    return err_set(e, w->o->name, 0,
                   "volume %s is open: %lld open edges (%s), the first at %.6g%s,%.6g%s,%.6g%s; expected every edge to "
                   "join two polygons (--allow-open accepts open edges)",
                   volume, (long long)r->open, names, at[0], unit, at[1], unit, at[2], unit);
}

static int add_triangle(work *w, int32_t volume, bool rigid, const int32_t *corner, const int32_t *cut, err *e)
{
    solids *s = w->s;
    if (mem_grow(&s->vertex, &w->vertex_capacity, 3 * (s->triangles + 1), sizeof *s->vertex, "triangles", e) ||
        mem_grow(&s->volume, &w->volume_capacity, s->triangles + 1, sizeof *s->volume, "triangles", e) ||
        mem_grow(&s->rigid, &w->rigid_capacity, s->triangles + 1, sizeof *s->rigid, "triangles", e))
        return -1;
    for (int i = 0; i < 3; i++)
        s->vertex[3 * s->triangles + i] = w->place.of[corner[cut[i]]];
    s->rigid[s->triangles] = rigid;
    s->volume[s->triangles++] = volume;
    return 0;
}

static int add_polygon(work *w, int32_t volume, bool rigid, int64_t face, err *e)
{
    static const int32_t whole[3] = {0, 1, 2};
    int64_t from = w->o->face_start[face], count = w->o->face_start[face + 1] - from;
    const int32_t *corner = &w->o->corner_vertex[from];
    if (count == 3)
        return add_triangle(w, volume, rigid, corner, whole, e);
    if (mem_grow(&w->cut, &w->cut_capacity, 3 * (count - 2), sizeof *w->cut, "triangles", e) ||
        triangulate(w->o->position, corner, count, w->cut, e))
        return -1;
    for (int64_t t = 0; t < count - 2; t++)
        if (add_triangle(w, volume, rigid, corner, &w->cut[3 * t], e))
            return -1;
    return 0;
}

static int build_volume(work *w, int32_t volume, bool allow_open, notes *warnings, err *e)
{
    int64_t from = w->start[volume];
    closed_polygons p = {.o = w->o,
                         .weld = w->place.of,
                         .face = &w->face[from],
                         .surface = &w->surface[from],
                         .polygons = w->start[volume + 1] - from,
                         .surfaces = w->plan->surfaces};
    closed_result r;
    if (closed_check(&p, &r, e))
        return -1;
    w->s->open[volume] = r.open;
    find_open(w, &r, w->s->open_at[volume]);
    int status = report(w, volume, &r, allow_open, warnings, e);
    for (int64_t i = 0; !status && i < p.polygons; i++) {
        const int times = w->sheets && r.sheet[i] ? 2 : !r.drop[i];
        for (int n = 0; n < times && !status; n++)
            status = add_polygon(w, volume, volumes_is_rigid(w->plan->surface[p.surface[i]].name), p.face[i], e);
    }
    closed_free(&r);
    return status;
}

static void take_places(work *w)
{
    solids *s = w->s;
    s->position = w->place.position;
    s->vertices = w->place.places;
    memcpy(s->low, w->place.low, sizeof s->low);
    memcpy(s->high, w->place.high, sizeof s->high);
    w->place.position = NULL;
}

int solids_build(solids *s, const obj *o, const volumes *plan, num_unit unit, bool sheets, bool allow_open,
                 notes *warnings, err *e)
{
    *s = (solids){0};
    work w = {.o = o, .plan = plan, .s = s, .unit = unit, .sheets = sheets};
    s->open = mem_array(plan->volumes, sizeof *s->open, "volumes", e);
    s->open_at = s->open ? mem_array(plan->volumes, sizeof *s->open_at, "volumes", e) : NULL;
    int status =
        !s->open_at || gather_polygons(&w, e) || weld_make(&w.place, o, w.face, w.start[plan->volumes], e) ? -1 : 0;
    for (int32_t v = 0; !status && v < plan->volumes; v++)
        status = build_volume(&w, v, allow_open, warnings, e);
    if (!status)
        take_places(&w);
    work_free(&w);
    if (status)
        solids_free(s);
    return status;
}

void solids_free(solids *s)
{
    free(s->position);
    free(s->vertex);
    free(s->volume);
    free(s->rigid);
    free(s->open);
    free(s->open_at);
    *s = (solids){0};
}

inside_triangles solids_triangles(const solids *s, const volumes *plan, bool lowest)
{
    inside_triangles t = {s->position, s->vertices, s->vertex, s->volume, s->triangles};
    while (lowest && t.triangles && plan->volume[s->volume[t.triangles - 1]].level > 0)
        t.triangles--;
    return t;
}

bool solids_are_open(const solids *s, const volumes *plan)
{
    for (int32_t v = 0; v < plan->volumes; v++)
        if (s->open[v] && plan->volume[v].level == 0)
            return true;
    return false;
}
