#include "inspect/distance_surface.h"

#include "base/mem.h"
#include "base/near.h"
#include "surface/surface.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* mm: squares of what is smaller have no overflow. */
static const double furthest = 1e100;

enum { TRIANGLES_MOST = 1 << 30, VERTICES = 1024 /* in a chunk */ };

static int check(const distance_surface *s, err *e)
{
    const char *name = s->file.name;
    if (!s->mesh.triangles)
        return err_set(e, name, 0, "no polygon; expected a surface");
    if (s->mesh.triangles >= TRIANGLES_MOST)
        return err_set(e, name, 0, "%" PRId64 " triangles; expected fewer than %d", s->mesh.triangles, TRIANGLES_MOST);
    for (int64_t i = 0; i < 3 * s->mesh.vertices; i++)
        if (!(fabs(s->mesh.position[i]) <= furthest))
            return err_set(e, name, obj_line_number(&s->file, s->file.v[i / 3].from),
                           "vertex %" PRId64 " has the coordinate %g mm; expected at most %g mm", i / 3 + 1,
                           s->mesh.position[i], furthest);
    return 0;
}

/* Keeps the triangles of a group. */
static int keep_group(distance_surface *s, const distance_source *from, err *e)
{
    const obj *o = &s->file;
    trimesh *m = &s->mesh;
    int64_t kept = 0;
    bool known = false;
    uint8_t *wanted = mem_array(o->groups, sizeof *wanted, "groups", e);
    if (!wanted)
        return -1;
    for (int32_t g = 0; g < o->groups; g++)
        known |= wanted[g] = surface_in_group(o->group[g], from->group);
    for (int64_t t = 0; t < m->triangles; t++)
        if (wanted[m->group[t]]) {
            memmove(m->corner + 3 * kept, m->corner + 3 * t, 3 * sizeof *m->corner);
            m->group[kept++] = m->group[t];
        }
    m->triangles = kept;
    free(wanted);
    if (known && !kept)
        return err_option(e, from->group_option, "group '%.200s' of %.200s has no polygon; expected one with some",
                          from->group, o->name);
    return known ? 0 : distance_unknown_group(o, from->group_option, from->group, e);
}

int distance_unknown_group(const obj *o, const char *option, const char *group, err *e)
{
    char what[300];
    snprintf(what, sizeof what, "group of %.250s", o->name);
    return near_option(e, option, what, group, (const char *const *)o->group, o->groups);
}

int distance_surface_read(distance_surface *s, const distance_source *from, notes *warnings, err *e)
{
    in *source = in_open(from->path, e);
    const int failed = !source || obj_read(&s->file, source, e) ? -1 : 0;
    in_close(source);
    if (failed || trimesh_of(&s->mesh, &s->file, from->mm, e) || check(s, e) || (from->group && keep_group(s, from, e)))
        return -1;
    obj_notes(&s->file, warnings);
    s->used = mem_array(s->mesh.vertices, sizeof *s->used, "vertices", e);
    if (!s->used)
        return -1;
    for (int64_t i = 0; i < 3 * s->mesh.triangles; i++)
        s->used[s->mesh.corner[i]] = true;
    for (int64_t v = 0; v < s->mesh.vertices; v++)
        s->used_count += s->used[v];
    return 0;
}

int distance_surface_index(distance_surface *s, notes *warnings, err *e)
{
    const trimesh *m = &s->mesh;
    if (pseudonormal_of(&s->normal, m->position, m->vertices, m->corner, m->triangles, e))
        return -1;
    if (s->normal.turned)
        notes_add(warnings,
                  "%s: at %" PRId64
                  " edge%s two polygons face different sides: signs near there mean nothing; expected "
                  "all to face outward",
                  s->file.name, s->normal.turned, s->normal.turned == 1 ? "" : "s");
    else if (!s->normal.border && s->normal.volume < 0)
        notes_add(warnings, "%s: a closed surface that faces inward: what is inside has positive signs", s->file.name);
    s->tree = triangle_tree_create(m->position, m->corner, m->triangles, e);
    return s->tree ? 0 : -1;
}

void distance_surface_free(distance_surface *s)
{
    obj_free(&s->file);
    trimesh_free(&s->mesh);
    free(s->used);
    triangle_tree_destroy(s->tree);
    pseudonormal_free(&s->normal);
    *s = (distance_surface){.tree = NULL};
}

typedef struct measuring {
    const distance_surface *from, *to;
    distance_field *f;
    int64_t *border; /* chunks */
} measuring;

/* Vertices that follow each other mostly lie near each other, so the last one's triangle is a guess. */
static void measure(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const measuring *m = context;
    int64_t guess = -1;
    for (int64_t v = from; v < to; v++) {
        const double *q = m->from->mesh.position + 3 * v;
        if (!m->from->used[v])
            continue;
        const triangle_hit hit = triangle_tree_nearest(m->to->tree, q, guess);
        guess = hit.triangle;
        m->f->distance[v] = sqrt(hit.distance2);
        memcpy(m->f->nearest + 3 * v, hit.point, sizeof hit.point);
        if (pseudonormal_on_border(&m->to->normal, &hit))
            m->border[chunk]++;
        else
            m->f->side[v] = pseudonormal_outside(&m->to->normal, &hit, q) ? 1 : -1;
    }
}

int distance_measure(distance_field *f, const distance_surface *from, const distance_surface *to, pool *threads, err *e)
{
    static const char what[] = "distances";
    const int64_t vertices = from->mesh.vertices, chunks = pool_chunks(vertices, VERTICES);
    measuring m = {from, to, f, mem_array(chunks, sizeof *m.border, what, e)};
    int status = -1;
    if (m.border && (f->distance = mem_array(vertices, sizeof *f->distance, what, e)) &&
        (f->side = mem_array(vertices, sizeof *f->side, what, e)) &&
        (f->nearest = mem_array(vertices, 3 * sizeof *f->nearest, what, e))) {
        pool_run(threads, vertices, VERTICES, measure, &m);
        for (int64_t i = 0; i < chunks; i++)
            f->border += m.border[i];
        status = 0;
    }
    free(m.border);
    return status;
}

void distance_field_free(distance_field *f)
{
    free(f->distance);
    free(f->side);
    free(f->nearest);
    *f = (distance_field){.border = 0};
}
