/* The reader of --volumes files: see volumes.h. */
#include "voxelise/volumes.h"

#include "base/keyfile.h"
#include "base/mem.h"
#include "base/near.h"
#include "base/num.h"
#include "model/materials.h"
#include "surface/names.h"
#include "surface/surface.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { KEY_LEVEL, KEY_PRIORITY, KEY_MATERIAL, KEY_SURFACES, KEY_MUSCLE, KEYS };

static const char *const key_name[KEYS] = {"level", "priority", "material", "surfaces", "muscle"};

enum { HIGHEST = 1000000 }; /* level and priority */

typedef struct reader {
    keyfile k;
    volumes *v;
    const model *materials;
    const char **surface; /* names of v's surfaces, borrowed */
    names surfaces;       /* the same in lower case */
    names volumes;        /* names of v's volumes, in lower case */
    names ranks;          /* "LEVEL PRIORITY" of v's volumes */
    int64_t *line;        /* of each volume */
    volumes_link *link;
    int64_t volume_capacity, line_capacity, links, link_capacity;
} reader;

/* A count from 0 on. */
static int take_number(reader *r, int key, const char *value, int32_t *to, err *e)
{
    int64_t number;
    if (num_int(value, 0, HIGHEST, &number))
        return keyfile_error(&r->k, e, "%s=%s; expected a whole number from 0 to %d", key_name[key], value, HIGHEST);
    *to = (int32_t)number;
    return 0;
}

static int take_muscle(reader *r, const char *value, bool *to, err *e)
{
    *to = strcasecmp(value, "yes") == 0;
    if (!*to && strcasecmp(value, "no") != 0)
        return keyfile_error(&r->k, e, "muscle=%s; expected yes or no", value);
    return 0;
}

/* Where the name is in a set of names in lower case: -1 where it is not, -2 on no memory. */
static int32_t find_lower(const names *set, const char *name, err *e)
{
    char *lower = volumes_lower(name, strlen(name), e);
    int32_t at = lower ? names_find(set, lower) : -2;
    free(lower);
    return at;
}

static int add_lower(names *set, const char *name, err *e)
{
    char *lower = volumes_lower(name, strlen(name), e);
    int status = lower && names_number(set, lower, e) >= 0 ? 0 : -1;
    free(lower);
    return status;
}

/* Whether it can mean the surface of that very name only: no *, and nothing that may stand for other bytes. */
static bool is_plain(const char *pattern)
{
    while (*pattern > ' ' && *pattern < 0x7f && *pattern != '*' && *pattern != '\\')
        pattern++;
    return !*pattern;
}

/* Links the surfaces that one pattern matches to the volume that is being read. */
static int take_pattern(reader *r, const char *pattern, err *e)
{
    int64_t polygons = 0, matched = 0;
    int32_t only = is_plain(pattern) ? find_lower(&r->surfaces, pattern, e) : -1;
    if (only < -1)
        return -1;
    const int32_t end = only < 0 ? r->v->surfaces : only + 1;
    for (int32_t s = only < 0 ? 0 : only; s < end; s++) {
        if (!surface_in_group(r->surface[s], pattern))
            continue;
        if (mem_grow(&r->link, &r->link_capacity, r->links + 1, sizeof *r->link, "volumes", e))
            return -1;
        r->link[r->links++] = (volumes_link){s, r->v->volumes};
        polygons += r->v->surface[s].polygons;
        matched++;
    }
    if (!matched)
        return near_unknown(e, r->k.name, r->k.line, "surface", pattern, r->surface, r->v->surfaces);
    if (!polygons)
        return keyfile_error(&r->k, e, "surface '%s' has no polygons; expected faces of 3 corners and more", pattern);
    return 0;
}

static int take_surfaces(reader *r, char *value, err *e)
{
    for (char *p = value; p;) {
        char *comma = strchr(p, ',');
        if (comma)
            *comma = '\0';
        if (!*p)
            return keyfile_error(&r->k, e, "an empty name among the surfaces; expected names between commas");
        if (take_pattern(r, p, e))
            return -1;
        p = comma ? comma + 1 : NULL;
    }
    return 0;
}

static int take_pair(reader *r, volumes_volume *to, int key, char *value, err *e)
{
    switch (key) {
    case KEY_LEVEL:
        return take_number(r, key, value, &to->level, e);
    case KEY_PRIORITY:
        return take_number(r, key, value, &to->priority, e);
    case KEY_MATERIAL:
        to->material = materials_find(r->materials, value);
        return to->material < 0 ? materials_unknown(r->materials, value, r->k.name, r->k.line, e) : 0;
    case KEY_SURFACES:
        return take_surfaces(r, value, e);
    default:
        return take_muscle(r, value, &to->muscle, e);
    }
}

/* Against the volumes of the lines before: of that name, and of that level and priority. */
static int check_new(reader *r, const volumes_volume *new_one, err *e)
{
    char rank[32];
    snprintf(rank, sizeof rank, "%d %d", new_one->level, new_one->priority);
    int32_t same = find_lower(&r->volumes, new_one->name, e), level = names_find(&r->ranks, rank);
    if (same < -1)
        return -1;
    if (same >= 0 && (level < 0 || same <= level))
        return keyfile_error(&r->k, e, "volume '%s' was given on line %lld; expected another name", new_one->name,
                             (long long)r->line[same]);
    if (level >= 0)
        return keyfile_error(&r->k, e,
                             "'%s' has level %d and priority %d, as '%s' on line %lld has; expected "
                             "another priority, to say which keeps a voxel of both",
                             new_one->name, new_one->level, new_one->priority, r->v->volume[level].name,
                             (long long)r->line[level]);
    return add_lower(&r->volumes, new_one->name, e) || names_number(&r->ranks, rank, e) < 0 ? -1 : 0;
}

static int take_line(reader *r, err *e)
{
    volumes *v = r->v;
    char *name = r->k.word[0];
    if (strchr(name, '='))
        return keyfile_error(&r->k, e,
                             "'%s' where a volume's name should be; expected NAME level=0 priority=0 "
                             "material=MATERIAL surfaces=NAME,NAME",
                             name);
    if (mem_grow(&v->volume, &r->volume_capacity, v->volumes + 1, sizeof *v->volume, "volumes", e) ||
        mem_grow(&r->line, &r->line_capacity, v->volumes + 1, sizeof *r->line, "volumes", e))
        return -1;
    volumes_volume new_one = {.muscle = volumes_begins(name, "muscle")};
    uint64_t seen = 0;
    for (int i = 1; i < r->k.count; i++) {
        char *value;
        int key = keyfile_pair(&r->k, i, key_name, KEYS, &seen, &value, e);
        if (key < 0 || take_pair(r, &new_one, key, value, e))
            return -1;
    }
    if (!(seen & 1u << KEY_SURFACES))
        return keyfile_error(&r->k, e, "volume '%s' has no surfaces; expected surfaces=NAME,NAME", name);
    new_one.name = name;
    if (check_new(r, &new_one, e))
        return -1;
    new_one.name = mem_text(name, e);
    if (!new_one.name)
        return -1;
    r->line[v->volumes] = r->k.line;
    v->volume[v->volumes++] = new_one;
    return 0;
}

/* A volume, and which one it is in the file. */
typedef struct place {
    volumes_volume volume;
    int64_t line;
    int32_t was;
} place;

/* No two volumes have one level and one priority. */
static int by_rank(const void *a, const void *b)
{
    const volumes_volume *p = &((const place *)a)->volume, *q = &((const place *)b)->volume;
    if (p->level != q->level)
        return p->level < q->level ? -1 : 1;
    return (p->priority > q->priority) - (p->priority < q->priority);
}

/* Sorts the volumes by level and priority; their lines and links go along. */
static int sort_volumes(reader *r, err *e)
{
    volumes *v = r->v;
    int32_t *rank = mem_array(v->volumes, sizeof *rank, "volumes", e);
    place *sorted = mem_array(v->volumes, sizeof *sorted, "volumes", e);
    int status = rank && sorted ? 0 : -1;
    for (int32_t i = 0; !status && i < v->volumes; i++)
        sorted[i] = (place){v->volume[i], r->line[i], i};
    if (!status)
        qsort(sorted, (size_t)v->volumes, sizeof *sorted, by_rank);
    for (int32_t i = 0; !status && i < v->volumes; i++) {
        v->volume[i] = sorted[i].volume;
        r->line[i] = sorted[i].line;
        rank[sorted[i].was] = i;
    }
    for (int64_t i = 0; !status && i < r->links; i++)
        r->link[i].volume = rank[r->link[i].volume];
    free(rank);
    free(sorted);
    return status;
}

/* Nothing climbs to a level above one that has no volume. */
static int check_levels(const reader *r, err *e)
{
    int32_t below = -1;
    for (int32_t i = 0; i < r->v->volumes; i++) {
        const volumes_volume *a = &r->v->volume[i];
        if (a->level > below + 1)
            return err_set(e, r->k.name, r->line[i],
                           "volume '%s' is on level %d, and no volume is on level %d below it; "
                           "levels begin at 0 and leave none out",
                           a->name, a->level, below + 1);
        below = a->level;
    }
    return 0;
}

static void note_unused(const volumes *v, const char *file, notes *warnings)
{
    for (int32_t s = 0; s < v->surfaces; s++)
        if (!v->surface[s].used && v->surface[s].polygons > 0 && !volumes_is_rigid(v->surface[s].name))
            notes_add(warnings, "%s: surface '%s' is in no volume", file, v->surface[s].name);
}

int volumes_read(volumes *v, in *file, const obj *o, const model *materials, notes *warnings, err *e)
{
    *v = (volumes){0};
    reader r = {.v = v, .materials = materials};
    int status = -1, got = 0;
    keyfile_open(&r.k, file);
    if (volumes_surfaces(v, o, e))
        return -1;
    r.surface = mem_array(v->surfaces, sizeof *r.surface, "surfaces", e);
    if (!r.surface)
        goto out;
    for (int32_t s = 0; s < v->surfaces; s++) {
        r.surface[s] = v->surface[s].name;
        if (add_lower(&r.surfaces, v->surface[s].name, e))
            goto out;
    }
    while ((got = keyfile_next(&r.k, e)) > 0)
        if (take_line(&r, e))
            goto out;
    if (got < 0)
        goto out;
    if (v->volumes == 0) {
        err_set(e, in_name(file), 0, "no volumes; expected lines of NAME level=0 priority=0 surfaces=NAME,NAME");
        goto out;
    }
    if (sort_volumes(&r, e) || check_levels(&r, e) || volumes_join(v, r.link, r.links, false, e))
        goto out;
    note_unused(v, in_name(file), warnings);
    status = 0;
out:
    free(r.surface);
    names_free(&r.surfaces);
    names_free(&r.volumes);
    names_free(&r.ranks);
    free(r.line);
    free(r.link);
    return status;
}
