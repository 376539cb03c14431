#include "rigid.h"

#include "base/mem.h"
#include "base/near.h"
#include "surface/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Adds each word of text (between characters of `blanks`) that is not there yet. */
static int add_words(names *to, const char *text, const char *blanks, err *e)
{
    char *words = mem_text(text, e), *rest;
    if (!words)
        return -1;
    int status = 0;
    for (char *w = strtok_r(words, blanks, &rest); w && !status; w = strtok_r(NULL, blanks, &rest))
        status = names_number(to, w, e) < 0 ? -1 : 0;
    free(words);
    return status;
}

static bool matches_any(const char *name, const names *patterns)
{
    for (int32_t i = 0; i < patterns->count; i++)
        if (surface_in_group(name, patterns->name[i]))
            return true;
    return false;
}

/* The rigid surface of that name, made where there is none, or -1 with e filled. */
static int64_t surface_named(rigid *r, const char *name, err *e)
{
    int32_t i = names_number(&r->names, name, e);
    if (i < 0 || i < r->surfaces)
        return i;
    if (mem_grow(&r->surface, &r->surface_capacity, r->surfaces + 1, sizeof *r->surface, "rigid surfaces", e))
        return -1;
    r->surface[i] = (rigid_surface){.name = r->names.name[i]};
    return r->surfaces++;
}

/* Adds face f of s to the rigid surface. */
static int add_face(rigid *r, const surface *s, const char *of, int64_t f, int32_t to, bool apart, err *e)
{
    const int32_t *vertex = &s->vertex[s->start[f]];
    int64_t corners = surface_end(s, f) - s->start[f];
    for (int64_t i = 0; i < 3 * corners; i++)
        if (!isfinite(s->position[3 * (int64_t)vertex[i / 3] + i % 3]))
            return err_set(e, NULL, 0, "surface %s: vertex %d is not at a finite place", s->name, vertex[i / 3]);
    if (mem_grow(&r->primitive, &r->primitive_capacity, r->primitives + 1, sizeof *r->primitive, "rigid primitives", e))
        return -1;
    r->primitive[r->primitives] =
        (rigid_primitive){s->position, vertex, corners, to, of, f, r->primitives, false, apart};
    r->primitives++;
    r->surface[to].primitives++;
    return 0;
}

/* The rigid surface that the faces of a group belong to: that of its first name to match, -1 where none does, -2 with e
 * filled. patterns NULL: the first name, "default" standing for the whole surface's. */
static int64_t surface_of_group(rigid *r, const surface *s, const char *group, const names *patterns, err *e)
{
    names of = {0};
    int64_t found = add_words(&of, group, " ", e) ? -2 : -1;
    for (int32_t i = 0; i < of.count && found == -1; i++) {
        const char *as = !patterns && !strcmp(of.name[i], "default") ? s->name : of.name[i];
        if (!patterns || matches_any(of.name[i], patterns))
            if ((found = surface_named(r, as, e)) < 0)
                found = -2;
    }
    names_free(&of);
    return found;
}

static int collect_surface(rigid *r, const surface *s, const names *patterns, err *e)
{
    int rc = -1;
    int64_t *to = mem_array(s->groups, sizeof *to, "groups", e);
    int32_t named = to ? names_number(&r->sources, s->name, e) : -1;
    if (named < 0)
        goto out;
    for (int64_t g = 0; g < s->groups; g++)
        if ((to[g] = surface_of_group(r, s, s->group_name[g], patterns, e)) == -2)
            goto out;
    for (int64_t f = 0; f < s->faces; f++)
        if (to[s->group[f]] >= 0 && add_face(r, s, r->sources.name[named], f, (int32_t)to[s->group[f]], !patterns, e))
            goto out;
    rc = 0;
out:
    free(to);
    return rc;
}

static int by_surface(const void *a, const void *b)
{
    const rigid_primitive *p = a, *q = b;
    if (p->surface != q->surface)
        return p->surface < q->surface ? -1 : 1;
    return (p->number > q->number) - (p->number < q->number);
}

static int collect(rigid *r, const model *m, const names *patterns, err *e)
{
    char name[MODEL_NAME];
    surface s;
    for (int at = 0; model_surface(m, &at, name, sizeof name);)
        if (surface_of(m, name, &s, e) || collect_surface(r, &s, patterns, e))
            return -1;
    if (r->primitives)
        qsort(r->primitive, (size_t)r->primitives, sizeof *r->primitive, by_surface);
    return 0;
}

/* Whether each pattern has a name to match. */
static int all_used(const names *patterns, const model *m, err *e)
{
    int rc = -1;
    char name[MODEL_NAME];
    names all = {0};
    surface s;
    for (int at = 0; model_surface(m, &at, name, sizeof name);) {
        if (surface_of(m, name, &s, e))
            goto out;
        for (int64_t g = 0; g < s.groups; g++)
            if (add_words(&all, s.group_name[g], " ", e))
                goto out;
    }
    for (int32_t p = 0; p < patterns->count; p++) {
        int32_t n = 0;
        while (n < all.count && !surface_in_group(all.name[n], patterns->name[p]))
            n++;
        if (n == all.count) {
            near_option(e, NULL, "surface", patterns->name[p], (const char *const *)all.name, all.count);
            goto out;
        }
    }
    rc = 0;
out:
    names_free(&all);
    return rc;
}

int rigid_collect(rigid *r, const model *m, const opt_list *patterns, err *e)
{
    int rc = -1;
    names list = {0};
    for (int i = 0; i < patterns->count; i++)
        if (add_words(&list, patterns->value[i], ",", e))
            goto out;
    if (patterns->count && !list.count) {
        err_option(e, "--rigid", "'%.200s' names no surface; expected names between commas", patterns->value[0]);
        goto out;
    }
    if (patterns->count && all_used(&list, m, e))
        goto out;
    if (!patterns->count && add_words(&list, "skull*,bone*,rigid*", ",", e))
        goto out;
    rc = collect(r, m, &list, e);
out:
    names_free(&list);
    return rc;
}

int rigid_collect_all(rigid *r, const model *file, err *e)
{
    return collect(r, file, NULL, e);
}

void rigid_free(rigid *r)
{
    names_free(&r->names);
    names_free(&r->sources);
    free(r->surface);
    free(r->primitive);
    *r = (rigid){0};
}
