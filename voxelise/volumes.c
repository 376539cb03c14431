#include "voxelise/volumes.h"

#include "base/mem.h"
#include "base/near.h"
#include "model/materials.h"
#include "surface/names.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

bool volumes_begins(const char *name, const char *with)
{
    return strncasecmp(name, with, strlen(with)) == 0;
}

bool volumes_is_rigid(const char *name)
{
    return volumes_begins(name, "skull") || volumes_begins(name, "bone") || volumes_begins(name, "rigid");
}

void volumes_free(volumes *v)
{
    for (int32_t i = 0; i < v->volumes; i++) {
        free(v->volume[i].name);
        free(v->volume[i].surfaces);
    }
    for (int32_t i = 0; i < v->surfaces; i++)
        free(v->surface[i].name);
    free(v->volume);
    free(v->surface);
    free(v->member);
    free(v->group_start);
    free(v->token);
    free(v->token_start);
    *v = (volumes){0};
}

/* ---- the surfaces of an OBJ */

char *volumes_lower(const char *name, size_t length, err *e)
{
    char *lower = mem_array((int64_t)length + 1, 1, "names", e);
    for (size_t i = 0; lower && i < length; i++)
        lower[i] = (char)tolower((unsigned char)name[i]);
    return lower;
}

/* The index of the surface so named, in any case, new or not; -1 with e filled. seen: names in lower case. */
static int32_t surface_named(volumes *v, names *seen, int64_t *capacity, const char *name, size_t length, err *e)
{
    char *lower = volumes_lower(name, length, e);
    if (!lower)
        return -1;
    int32_t at = names_number(seen, lower, e);
    if (at != v->surfaces) {
        free(lower);
        return at;
    }
    if (mem_grow(&v->surface, capacity, v->surfaces + 1, sizeof *v->surface, "surfaces", e)) {
        free(lower);
        return -1;
    }
    memcpy(lower, name, length);
    v->surface[v->surfaces] = (volumes_surface){.name = lower};
    return v->surfaces++;
}

static int64_t count_names(const obj *o)
{
    int64_t count = 0;
    for (int32_t g = 0; g < o->groups; g++)
        for (const char *p = o->group[g]; *p; p += strcspn(p, " "), p += strspn(p, " "))
            count++;
    return count;
}

/* One group's names become tokens. */
static int take_group(volumes *v, names *seen, int64_t *capacity, const obj *o, int32_t group, err *e)
{
    int64_t count = v->token_start[group];
    for (const char *p = o->group[group] + strspn(o->group[group], " "); *p;) {
        size_t length = strcspn(p, " ");
        int32_t s = surface_named(v, seen, capacity, p, length, e);
        if (s < 0)
            return -1;
        v->token[count++] = s;
        p += length;
        p += strspn(p, " ");
    }
    v->token_start[group + 1] = count;
    return 0;
}

static bool group_is_rigid(const volumes *v, int32_t group)
{
    for (int64_t i = v->token_start[group]; i < v->token_start[group + 1]; i++)
        if (!volumes_is_rigid(v->surface[v->token[i]].name))
            return false;
    return true;
}

/* Polygons of each surface, from those of each group. */
static int count_polygons(volumes *v, const obj *o, err *e)
{
    int64_t *polygons = mem_array(o->groups, sizeof *polygons, "groups", e);
    if (!polygons)
        return -1;
    for (int64_t f = 0; f < o->faces; f++)
        polygons[o->face_group[f]] += o->face_start[f + 1] - o->face_start[f] >= 3;
    for (int32_t g = 0; g < o->groups; g++) {
        bool rigid = group_is_rigid(v, g);
        for (int64_t i = v->token_start[g]; i < v->token_start[g + 1]; i++) {
            volumes_surface *s = &v->surface[v->token[i]];
            s->polygons += polygons[g];
            s->own += rigid || !volumes_is_rigid(s->name) ? polygons[g] : 0;
        }
    }
    free(polygons);
    return 0;
}

int volumes_no_polygons(const obj *o, err *e)
{
    return err_set(e, o->name, 0, "no polygons; expected closed surfaces (f lines of 3 corners and more)");
}

int volumes_surfaces(volumes *v, const obj *o, err *e)
{
    names seen = {0};
    int64_t capacity = 0;
    int status = -1;
    v->token = mem_array(count_names(o), sizeof *v->token, "surfaces", e);
    v->token_start = mem_array((int64_t)o->groups + 1, sizeof *v->token_start, "surfaces", e);
    v->groups = o->groups;
    if (!v->token || !v->token_start)
        goto out;
    for (int32_t g = 0; g < o->groups; g++)
        if (take_group(v, &seen, &capacity, o, g, e))
            goto out;
    status = count_polygons(v, o, e);
    int64_t polygons = 0;
    for (int32_t s = 0; s < v->surfaces; s++) {
        v->rigid = v->rigid || volumes_is_rigid(v->surface[s].name);
        polygons += v->surface[s].polygons;
    }
    if (status == 0 && polygons == 0)
        status = volumes_no_polygons(o, e);
out:
    names_free(&seen);
    return status;
}

/* ---- from surfaces to volumes */

static int compare_links(const void *a, const void *b)
{
    const volumes_link *x = a, *y = b;
    if (x->surface != y->surface)
        return (x->surface > y->surface) - (x->surface < y->surface);
    return (x->volume > y->volume) - (x->volume < y->volume);
}

typedef struct joined {
    const volumes_link *link; /* by surface */
    const int64_t *start;     /* surfaces + 1: a surface's first link */
    int32_t *last;            /* volumes: the last group that each has, + 1 */
} joined;

static int join_group(volumes *v, int32_t group, const joined *j, bool marks, err *e)
{
    bool rigid = group_is_rigid(v, group);
    for (int64_t t = v->token_start[group]; t < v->token_start[group + 1]; t++) {
        int32_t s = v->token[t];
        if (marks && !rigid && volumes_is_rigid(v->surface[s].name))
            continue;
        for (int64_t l = j->start[s]; l < j->start[s + 1]; l++) {
            int32_t volume = j->link[l].volume;
            if (j->last[volume] == group + 1)
                continue;
            j->last[volume] = group + 1;
            if (mem_grow(&v->member, &v->capacity, v->members + 1, sizeof *v->member, "volumes", e))
                return -1;
            v->member[v->members++] = (volumes_member){group, volume, s};
        }
    }
    v->group_start[group + 1] = v->members;
    return 0;
}

/* A volume's surfaces as people read them. */
static int list_surfaces(volumes *v, const volumes_link *link, int64_t links, err *e)
{
    int64_t *length = mem_array(v->volumes, sizeof *length, "volumes", e);
    if (!length)
        return -1;
    for (int64_t i = 0; i < links; i++)
        length[link[i].volume] += (int64_t)strlen(v->surface[link[i].surface].name) + 1;
    for (int32_t i = 0; i < v->volumes; i++) {
        v->volume[i].surfaces = mem_array(length[i] + 1, 1, "volumes", e);
        if (!v->volume[i].surfaces) {
            free(length);
            return -1;
        }
        length[i] = 0;
    }
    for (int64_t i = 0; i < links; i++) {
        const char *name = v->surface[link[i].surface].name;
        int64_t *at = &length[link[i].volume];
        char *to = v->volume[link[i].volume].surfaces;
        if (*at)
            to[(*at)++] = ' ';
        for (; *name; name++)
            to[(*at)++] = *name;
    }
    free(length);
    return 0;
}

int volumes_join(volumes *v, const volumes_link *link, int64_t links, bool marks, err *e)
{
    int status = -1;
    volumes_link *sorted = mem_array(links, sizeof *sorted, "volumes", e);
    int64_t *start = mem_array((int64_t)v->surfaces + 1, sizeof *start, "volumes", e);
    int32_t *last = mem_array(v->volumes, sizeof *last, "volumes", e);
    v->group_start = mem_array((int64_t)v->groups + 1, sizeof *v->group_start, "volumes", e);
    if (!sorted || !start || !last || !v->group_start)
        goto out;
    memcpy(sorted, link, (size_t)links * sizeof *sorted);
    qsort(sorted, (size_t)links, sizeof *sorted, compare_links);
    for (int64_t i = 0; i < links; i++) {
        start[sorted[i].surface + 1]++;
        v->surface[sorted[i].surface].used = true;
    }
    for (int32_t s = 0; s < v->surfaces; s++)
        start[s + 1] += start[s];
    const joined j = {sorted, start, last};
    for (int32_t g = 0; g < v->groups; g++)
        if (join_group(v, g, &j, marks, e))
            goto out;
    status = list_surfaces(v, sorted, links, e);
out:
    free(sorted);
    free(start);
    free(last);
    return status;
}

/* ---- by names */

typedef enum part { PART_SKIN, PART_OTHER, PART_MUSCLE } part;

static part part_of(const char *name)
{
    if (volumes_begins(name, "muscle"))
        return PART_MUSCLE;
    return volumes_begins(name, "skin") || volumes_is_rigid(name) ? PART_SKIN : PART_OTHER;
}

static int32_t material_for(const model *m, const char *name, bool muscle)
{
    int32_t at = materials_find(m, name);
    if (at < 0 && muscle)
        at = materials_find(m, "muscle");
    return at < 0 ? 0 : at;
}

static int add_volume(volumes *v, const char *name, part p, int32_t level, int32_t priority, const model *m, err *e)
{
    char *copy = mem_text(name, e);
    if (!copy)
        return -1;
    bool muscle = p == PART_MUSCLE;
    v->volume[v->volumes++] = (volumes_volume){.name = copy,
                                               .level = level,
                                               .priority = priority,
                                               .material = material_for(m, name, muscle),
                                               .muscle = muscle};
    return 0;
}

/* Links every surface of one part: all to one volume, or each to one of its own. */
static int add_part(volumes *v, part p, int32_t level, int32_t priority, volumes_link *link, int64_t *links,
                    const model *m, err *e)
{
    int32_t first = -1, count = 0;
    for (int32_t s = 0; s < v->surfaces; s++) {
        if (v->surface[s].own == 0 || part_of(v->surface[s].name) != p)
            continue;
        bool new_volume = first < 0 || p == PART_MUSCLE;
        if (new_volume && add_volume(v, p == PART_SKIN ? "skin" : v->surface[s].name, p, level, priority + count, m, e))
            return -1;
        first = first < 0 ? v->volumes - 1 : first;
        link[(*links)++] = (volumes_link){s, v->volumes - 1};
        count++;
    }
    if (p != PART_OTHER || count < 2)
        return 0;
    free(v->volume[first].name);
    v->volume[first].name = mem_text("other", e);
    v->volume[first].material = material_for(m, "other", false);
    return v->volume[first].name ? 0 : -1;
}

int volumes_by_name(volumes *v, const obj *o, const model *m, err *e)
{
    *v = (volumes){0};
    if (volumes_surfaces(v, o, e))
        return -1;
    int64_t links = 0;
    int status = -1;
    volumes_link *link = mem_array(v->surfaces, sizeof *link, "volumes", e);
    v->volume = mem_array(v->surfaces, sizeof *v->volume, "volumes", e);
    if (link && v->volume && !add_part(v, PART_SKIN, 0, 0, link, &links, m, e) &&
        !add_part(v, PART_OTHER, 0, v->volumes, link, &links, m, e) &&
        !add_part(v, PART_MUSCLE, v->volumes > 0, 0, link, &links, m, e))
        status = volumes_join(v, link, links, true, e);
    free(link);
    return status;
}

/* ---- what may be a mistake */

/* Of a name such as "musle_zyg": the word that it all but begins with, NULL for none. */
static const char *almost(const char *name)
{
    static const char *const word[] = {"skin", "skull", "bone", "rigid", "muscle"};
    enum { WORDS = sizeof word / sizeof *word };
    char begin[16];
    size_t length = 0;
    for (; isalpha((unsigned char)name[length]); length++) {
        if (length + 1 >= sizeof begin)
            return NULL;
        begin[length] = (char)tolower((unsigned char)name[length]);
    }
    begin[length] = '\0';
    for (int i = 0; i < WORDS; i++)
        if (volumes_begins(name, word[i]))
            return NULL;
    int at = length > 2 ? near_name(begin, word, WORDS) : -1;
    return at < 0 ? NULL : word[at];
}

void volumes_notes(const volumes *v, bool by_name, notes *warnings)
{
    for (int32_t s = 0; s < v->surfaces; s++) {
        const char *name = v->surface[s].name, *word = by_name ? almost(name) : NULL;
        if (v->surface[s].polygons == 0)
            notes_add(warnings, "surface %s has no polygon", name);
        else if (word)
            notes_add(warnings,
                      "the name of surface %s begins with no known word; did you mean one that begins with %s?", name,
                      word);
    }
}

bool volumes_is_of_surface(const volumes *v, int32_t group, int32_t surface)
{
    for (int64_t t = v->token_start[group]; t < v->token_start[group + 1]; t++)
        if (v->token[t] == surface)
            return true;
    return false;
}

bool volumes_is_of_volume(const volumes *v, int32_t group, int32_t volume)
{
    for (int64_t m = v->group_start[group]; m < v->group_start[group + 1]; m++)
        if (v->member[m].volume == volume)
            return true;
    return false;
}
