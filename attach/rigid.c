#include "rigid.h"

#include "base/mem.h"
#include "base/near.h"
#include "mesh/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Patterns taken apart, or names. */
typedef struct words {
    char **v; /* each owned */
    int64_t count, capacity;
} words;

static void words_free(words *w)
{
    for (int64_t i = 0; i < w->count; i++)
        free(w->v[i]);
    free(w->v);
}

/* Adds each word of text (between characters of `blanks`) that is not there yet. */
static int words_add(words *w, const char *text, const char *blanks, err *e)
{
    for (text += strspn(text, blanks); *text; text += strspn(text, blanks)) {
        size_t size = strcspn(text, blanks);
        int64_t i = 0;
        while (i < w->count && (strncmp(w->v[i], text, size) || w->v[i][size]))
            i++;
        if (i == w->count) {
            if (mem_grow(&w->v, &w->capacity, w->count + 1, sizeof *w->v, "names of surfaces", e))
                return -1;
            w->v[w->count] = mem_array((int64_t)size + 1, 1, "names of surfaces", e);
            if (!w->v[w->count])
                return -1;
            memcpy(w->v[w->count++], text, size);
        }
        text += size;
    }
    return 0;
}

static bool matches_any(const char *name, const words *patterns)
{
    for (int64_t i = 0; i < patterns->count; i++)
        if (surface_in_group(name, patterns->v[i]))
            return true;
    return false;
}

static int64_t find(const rigid *r, const char *name)
{
    int64_t i = 0;
    while (i < r->surfaces && strcmp(r->surface[i].name, name))
        i++;
    return i;
}

/* The rigid surface of that name, made where there is none, or -1 with e filled. */
static int64_t surface_named(rigid *r, const char *name, err *e)
{
    int64_t i = find(r, name);
    if (i < r->surfaces)
        return i;
    if (i == INT32_MAX)
        return err_set(e, NULL, 0, "more than %d rigid surfaces", INT32_MAX);
    if (mem_grow(&r->surface, &r->surface_capacity, i + 1, sizeof *r->surface, "rigid surfaces", e))
        return -1;
    r->surface[i] = (rigid_surface){.name = mem_text(name, e)};
    if (!r->surface[i].name)
        return -1;
    return r->surfaces++;
}

/* Adds face f of s to the rigid surface. */
static int add_face(rigid *r, const surface *s, int64_t f, int32_t to, err *e)
{
    const int32_t *vertex = &s->vertex[s->start[f]];
    int64_t corners = surface_end(s, f) - s->start[f];
    for (int64_t i = 0; i < 3 * corners; i++)
        if (!isfinite(s->position[3 * (int64_t)vertex[i / 3] + i % 3]))
            return err_set(e, NULL, 0, "surface %s: vertex %d is not at a finite place", s->name, vertex[i / 3]);
    if (mem_grow(&r->primitive, &r->primitive_capacity, r->primitives + 1, sizeof *r->primitive, "rigid primitives", e))
        return -1;
    r->primitive[r->primitives++] = (rigid_primitive){s->position, vertex, corners, to};
    r->surface[to].primitives++;
    return 0;
}

/* The rigid surface that the faces of a group belong to: that of its first name to match, -1 where none does, -2 with e
 * filled. patterns NULL: the first name, "default" standing for the whole surface's. */
static int64_t surface_of_group(rigid *r, const surface *s, const char *names, const words *patterns, err *e)
{
    words name = {0};
    int64_t found = words_add(&name, names, " ", e) ? -2 : -1;
    for (int64_t i = 0; i < name.count && found == -1; i++) {
        const char *as = !patterns && !strcmp(name.v[i], "default") ? s->name : name.v[i];
        if (!patterns || matches_any(name.v[i], patterns))
            if ((found = surface_named(r, as, e)) < 0)
                found = -2;
    }
    words_free(&name);
    return found;
}

static int collect_surface(rigid *r, const surface *s, const words *patterns, err *e)
{
    int rc = -1;
    int64_t *to = mem_array(s->groups, sizeof *to, "groups", e);
    if (!to)
        return -1;
    for (int64_t g = 0; g < s->groups; g++)
        if ((to[g] = surface_of_group(r, s, s->group_name[g], patterns, e)) == -2)
            goto out;
    for (int64_t f = 0; f < s->faces; f++)
        if (to[s->group[f]] >= 0 && add_face(r, s, f, (int32_t)to[s->group[f]], e))
            goto out;
    rc = 0;
out:
    free(to);
    return rc;
}

static int by_surface(const void *a, const void *b)
{
    const rigid_primitive *p = a, *q = b;
    return (p->surface > q->surface) - (p->surface < q->surface);
}

static int collect(rigid *r, const model *m, const words *patterns, err *e)
{
    char name[MODEL_NAME];
    surface s;
    for (int i = 0; model_surface(m, i, name, sizeof name); i++)
        if (surface_of(m, name, &s, e) || collect_surface(r, &s, patterns, e))
            return -1;
    if (r->primitives)
        qsort(r->primitive, (size_t)r->primitives, sizeof *r->primitive, by_surface);
    return 0;
}

/* Whether each pattern has a name to match. */
static int all_used(const words *patterns, const model *m, err *e)
{
    int rc = -1;
    char name[MODEL_NAME];
    words names = {0};
    surface s;
    for (int i = 0; model_surface(m, i, name, sizeof name); i++) {
        if (surface_of(m, name, &s, e))
            goto out;
        for (int64_t g = 0; g < s.groups; g++)
            if (words_add(&names, s.group_name[g], " ", e))
                goto out;
    }
    for (int64_t p = 0; p < patterns->count; p++) {
        int64_t n = 0;
        while (n < names.count && !surface_in_group(names.v[n], patterns->v[p]))
            n++;
        if (n == names.count) {
            near_unknown(e, NULL, 0, "surface", patterns->v[p], (const char *const *)names.v, (int)names.count);
            goto out;
        }
    }
    rc = 0;
out:
    words_free(&names);
    return rc;
}

int rigid_collect(rigid *r, const model *m, const opt_list *patterns, err *e)
{
    int rc = -1;
    words list = {0};
    for (int i = 0; i < patterns->count; i++)
        if (words_add(&list, patterns->value[i], ",", e))
            goto out;
    if (patterns->count && !list.count) {
        err_set(e, NULL, 0, "--rigid names no surface; names between commas were expected");
        goto out;
    }
    if (patterns->count && all_used(&list, m, e))
        goto out;
    if (!patterns->count && words_add(&list, "skull*,bone*,rigid*", ",", e))
        goto out;
    rc = collect(r, m, &list, e);
out:
    words_free(&list);
    return rc;
}

int rigid_collect_all(rigid *r, const model *file, err *e)
{
    return collect(r, file, NULL, e);
}

void rigid_free(rigid *r)
{
    for (int64_t i = 0; i < r->surfaces; i++)
        free(r->surface[i].name);
    free(r->surface);
    free(r->primitive);
    *r = (rigid){0};
}
