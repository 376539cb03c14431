#include "exchange/import_msh.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/near.h"
#include "base/num.h"
#include "exchange/import_tokens.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { GROUPS_MOST = 100000, CORNERS_MOST = 64 };

/* A physical group. */
typedef struct group {
    int32_t dimension, tag;
    char *name;     /* or NULL */
    int32_t volume; /* of three dimensions: once an element is of it; else -1 */
    bool rigid, wanted;
} group;

/* Which group an entity of the geometry is in (4.1): the first. */
typedef struct entity {
    int32_t dimension, tag, group;
} entity;

typedef struct reader {
    import_mesh *m;
    const import_wishes *w;
    err *e;
    tokens t;
    int version; /* 2 or 4 */
    group *groups;
    int64_t group_count, group_room;
    names keys;   /* of groups, in their order: DIMENSION TAG */
    int32_t last; /* group that was asked for */
    entity *entities;
    int64_t entity_count, entity_room;
    int32_t *held; /* numbers of nodes of rigid groups */
    int64_t held_count, held_room;
    int64_t elements; /* passed so far, for messages in binary */
} reader;

/* An element's type, as Gmsh numbers it. */
typedef struct type {
    int corners, dimension;
    const char *refused; /* what it is, where it is not read */
} type;

static type type_of(int64_t number)
{
    static const type known[] = {{0, 0, NULL},
                                 {2, 1, NULL},
                                 {3, 2, NULL},
                                 {4, 2, NULL},
                                 {4, 3, NULL},
                                 {8, 3, NULL},
                                 {6, 3, "a wedge"},
                                 {5, 3, "a pyramid"},
                                 {3, 1, NULL},
                                 {6, 2, NULL},
                                 {9, 2, NULL},
                                 {10, 3, "a tetrahedron of second order"},
                                 {27, 3, "a hexahedron of second order"},
                                 {18, 3, "a wedge of second order"},
                                 {14, 3, "a pyramid of second order"},
                                 {1, 0, NULL},
                                 {8, 2, NULL},
                                 {20, 3, "a hexahedron of second order"},
                                 {15, 3, "a wedge of second order"},
                                 {13, 3, "a pyramid of second order"}};
    const type higher = {0, 3, "an element of higher order"};
    return number >= 1 && number <= 19 ? known[number] : higher;
}

static int wrong(reader *r, const char *what, const char *expected)
{
    return tokens_wrong(&r->t, r->e, what, expected);
}

static int whole(reader *r, int size, int64_t low, int64_t high, int64_t *value)
{
    return tokens_int(&r->t, size, low, high, value, r->e);
}

/* The line of a section that says how many it has. */
static int read_count(reader *r, int64_t most, const char *none, int64_t *count)
{
    char *line;
    int got = tokens_line(&r->t, &line, r->e);
    if (!got && !num_int(line, 0, most, count))
        return 0;
    if (got >= -1)
        wrong(r, none, "one");
    return -1;
}

/* ---- groups */

static int32_t group_of(reader *r, int64_t dimension, int64_t tag)
{
    char key[48];
    if (r->group_count && r->groups[r->last].dimension == dimension && r->groups[r->last].tag == tag)
        return r->last;
    snprintf(key, sizeof key, "%lld %lld", (long long)dimension, (long long)tag);
    const int32_t at = names_find(&r->keys, key);
    if (at >= 0)
        return r->last = at;
    if (r->group_count == GROUPS_MOST)
        return (int32_t)wrong(r, "too many physical groups", "at most 100000");
    if (MEM_ROOM(&r->groups, &r->group_room, r->group_count + 1, "groups", r->e) ||
        names_number(&r->keys, key, r->e) < 0)
        return -1;
    r->groups[r->group_count] = (group){(int32_t)dimension, (int32_t)tag, NULL, -1, false, false};
    return (int32_t)r->group_count++;
}

/* DIMENSION TAG "NAME", which are text in binary files too. */
static int read_name(reader *r, char *line)
{
    int dimension, at = 0, tag;
    char *open = strchr(line, '"'), *close = open ? strrchr(line, '"') : NULL;
    if (sscanf(line, "%3d %9d %n", &dimension, &tag, &at) < 2 || dimension < 0 || dimension > 3 || !open ||
        close == open)
        return wrong(r, "a line of $PhysicalNames", "DIMENSION TAG \"NAME\"");
    *close = '\0';
    chars_mend(open + 1);
    int32_t g = group_of(r, dimension, tag);
    if (g < 0)
        return -1;
    free(r->groups[g].name);
    r->groups[g].name = mem_text(open + 1, r->e);
    if (!r->groups[g].name)
        return -1;
    r->groups[g].rigid = dimension < 3 && !strcasecmp(open + 1, "rigid");
    for (int i = 0; i < r->w->rigids; i++)
        if (!strcmp(r->w->rigid[i], open + 1))
            r->groups[g].rigid = r->groups[g].wanted = true;
    return 0;
}

static int read_names(reader *r)
{
    char *line;
    int64_t count;
    if (read_count(r, GROUPS_MOST, "no count of physical names", &count))
        return -1;
    for (; count > 0; count--) {
        int got = tokens_line(&r->t, &line, r->e);
        if (got || read_name(r, line))
            return got < -1 || !got ? -1 : wrong(r, "the file ends in $PhysicalNames", "more names");
    }
    return 0;
}

/* Every name of --rigid must be one of a group. */
static int check_rigid(reader *r)
{
    const char **named = mem_array(r->group_count, sizeof *named, "groups", r->e);
    int count = 0, bad = named ? 0 : -1;
    for (int64_t i = 0; named && i < r->group_count; i++)
        if (r->groups[i].name)
            named[count++] = r->groups[i].name;
    for (int i = 0; !bad && i < r->w->rigids; i++) {
        bool found = false;
        for (int k = 0; k < count; k++)
            found |= !strcmp(named[k], r->w->rigid[i]);
        if (!found)
            bad = near_option(r->e, "--rigid", "physical group", r->w->rigid[i], named, count);
    }
    free(named);
    return bad;
}

/* 4.1's $Entities, for which group each is in. */
static int read_entity(reader *r, int dimension)
{
    int64_t tag, count, physical, bounds;
    if (whole(r, 4, -INT32_MAX, INT32_MAX, &tag) || tokens_skip(&r->t, dimension ? 6 : 3, 8, r->e) ||
        whole(r, 8, 0, INT32_MAX, &count))
        return -1;
    for (int64_t i = 0; i < count; i++) {
        if (whole(r, 4, -INT32_MAX, INT32_MAX, &physical))
            return -1;
        if (i)
            continue;
        int32_t g = group_of(r, dimension, physical < 0 ? -physical : physical);
        if (g < 0 || MEM_ROOM(&r->entities, &r->entity_room, r->entity_count + 1, "entities", r->e))
            return -1;
        r->entities[r->entity_count++] = (entity){dimension, (int32_t)tag, g};
    }
    if (!dimension)
        return 0;
    return whole(r, 8, 0, INT32_MAX, &bounds) || tokens_skip(&r->t, bounds, 4, r->e) ? -1 : 0;
}

static int by_entity(const void *a, const void *b)
{
    const entity *p = a, *q = b;
    if (p->dimension != q->dimension)
        return p->dimension < q->dimension ? -1 : 1;
    return (p->tag > q->tag) - (p->tag < q->tag);
}

static int read_entities(reader *r)
{
    int64_t count[4];
    for (int d = 0; d < 4; d++)
        if (whole(r, 8, 0, INT32_MAX, &count[d]))
            return -1;
    for (int d = 0; d < 4; d++)
        for (int64_t i = 0; i < count[d]; i++)
            if (read_entity(r, d))
                return -1;
    if (r->entity_count)
        qsort(r->entities, (size_t)r->entity_count, sizeof *r->entities, by_entity);
    return 0;
}

/* The group of an entity, or -1. */
static int32_t group_of_entity(const reader *r, int64_t dimension, int64_t tag)
{
    const entity key = {(int32_t)dimension, (int32_t)tag, 0};
    const entity *found =
        r->entity_count ? bsearch(&key, r->entities, (size_t)r->entity_count, sizeof key, by_entity) : NULL;
    return found ? found->group : -1;
}

/* ---- nodes */

static int read_node(reader *r, int64_t tag)
{
    double at[3];
    for (int a = 0; a < 3; a++)
        if (tokens_real(&r->t, &at[a], r->e))
            return -1;
    return import_ids_add(&r->m->node_id, (int32_t)tag, r->e) || import_add_node(r->m, at, r->e) ? -1 : 0;
}

static int read_nodes_2(reader *r)
{
    int64_t count, tag;
    if (read_count(r, INT32_MAX, "no count of nodes", &count))
        return -1;
    for (int64_t i = 0; i < count; i++)
        if (whole(r, 4, 1, INT32_MAX, &tag) || read_node(r, tag))
            return -1;
    return 0;
}

/* A block has all its numbers first, then all places: numbers are kept as they come. */
static int read_node_block(reader *r)
{
    int64_t dimension, entity_tag, parametric, count, tag;
    double parameter;
    if (whole(r, 4, 0, 3, &dimension) || whole(r, 4, -INT32_MAX, INT32_MAX, &entity_tag) ||
        whole(r, 4, 0, 1, &parametric) || whole(r, 8, 0, INT32_MAX, &count))
        return -1;
    for (int64_t i = 0; i < count; i++)
        if (whole(r, 8, 1, INT32_MAX, &tag) || import_ids_add(&r->m->node_id, (int32_t)tag, r->e))
            return -1;
    for (int64_t i = 0; i < count; i++) {
        double at[3];
        for (int a = 0; a < 3; a++)
            if (tokens_real(&r->t, &at[a], r->e))
                return -1;
        for (int64_t k = 0; parametric && k < dimension; k++)
            if (tokens_real(&r->t, &parameter, r->e))
                return -1;
        if (import_add_node(r->m, at, r->e))
            return -1;
    }
    return 0;
}

/* The heading of 4.1's $Nodes and $Elements: blocks, how many in all, the least and the largest number. */
static int read_heading(reader *r, int64_t *blocks)
{
    int64_t rest;
    for (int i = 0; i < 4; i++)
        if (whole(r, 8, 0, INT64_MAX, i ? &rest : blocks))
            return -1;
    return 0;
}

static int read_nodes_4(reader *r)
{
    int64_t blocks;
    if (read_heading(r, &blocks))
        return -1;
    for (; blocks > 0; blocks--)
        if (read_node_block(r))
            return -1;
    return 0;
}

/* ---- elements */

/* The volume of a group, by its name. */
static int32_t volume_of(reader *r, int32_t g)
{
    char text[32];
    if (g < 0)
        return -1;
    group *own = &r->groups[g];
    if (own->volume < 0) {
        snprintf(text, sizeof text, "volume%d", own->tag);
        own->volume = import_add_volume(r->m, own->name && *own->name ? own->name : text, r->e);
    }
    return own->volume < 0 ? -2 : own->volume;
}

static int hold(reader *r, const int64_t *corner, int count)
{
    if (MEM_ROOM(&r->held, &r->held_room, r->held_count + count, "rigid nodes", r->e))
        return -1;
    for (int i = 0; i < count; i++)
        r->held[r->held_count++] = (int32_t)corner[i];
    return 0;
}

/* The corners of an element of this type, in group g (or -1). size: of a number of binary. */
static int read_corners(reader *r, const type *t, int32_t g, int size)
{
    int64_t corner[CORNERS_MOST];
    int32_t own[8];
    for (int c = 0; c < t->corners; c++)
        if (whole(r, size, 1, INT32_MAX, &corner[c]))
            return -1;
    r->elements++;
    if (g >= 0 && r->groups[g].rigid && hold(r, corner, t->corners))
        return -1;
    if (t->dimension < 3)
        return 0;
    for (int c = 0; c < t->corners; c++)
        own[c] = (int32_t)corner[c];
    int32_t volume = volume_of(r, g);
    return volume < -1 ? -1
                       : import_add_element(r->m, own, t->corners, volume, r->t.binary ? 0 : in_lines(r->t.s), r->e);
}

static int take_type(reader *r, type *t)
{
    int64_t number;
    char text[100];
    if (whole(r, 4, 1, 10000, &number))
        return -1;
    *t = type_of(number);
    if (!t->refused)
        return 0;
    snprintf(text, sizeof text, "%s (type %d)", t->refused, (int)number);
    return wrong(r, text, "hexahedra of 8 nodes (5) or tetrahedra of 4 (4)");
}

/* The tags of an element of 2.2: the first is its physical group. */
static int read_tags(reader *r, int64_t tags, int dimension, int32_t *g)
{
    int64_t tag;
    *g = -1;
    for (int64_t i = 0; i < tags; i++) {
        if (whole(r, 4, -INT32_MAX, INT32_MAX, &tag))
            return -1;
        if (i || !tag)
            continue;
        *g = group_of(r, dimension, tag < 0 ? -tag : tag);
        if (*g < 0)
            return -1;
    }
    return 0;
}

static int read_elements_2(reader *r)
{
    int64_t count, id, tags = 0, alike = 1;
    type t = {0};
    int32_t g;
    if (read_count(r, INT32_MAX, "no count of elements", &count))
        return -1;
    while (count > 0) {
        if (r->t.binary && (take_type(r, &t) || whole(r, 4, 1, count, &alike) || whole(r, 4, 0, 1000, &tags)))
            return -1;
        for (int64_t i = 0; i < alike; i++) {
            if (whole(r, 4, 0, INT32_MAX, &id) || (!r->t.binary && (take_type(r, &t) || whole(r, 4, 0, 1000, &tags))) ||
                read_tags(r, tags, t.dimension, &g) || read_corners(r, &t, g, 4))
                return -1;
        }
        count -= alike;
    }
    return 0;
}

static int read_element_block(reader *r)
{
    int64_t dimension, entity_tag, count, id;
    type t;
    if (whole(r, 4, 0, 3, &dimension) || whole(r, 4, -INT32_MAX, INT32_MAX, &entity_tag) || take_type(r, &t) ||
        whole(r, 8, 0, INT32_MAX, &count))
        return -1;
    const int32_t g = group_of_entity(r, dimension, entity_tag);
    for (int64_t i = 0; i < count; i++)
        if (whole(r, 8, 0, INT64_MAX, &id) || read_corners(r, &t, g, 8))
            return -1;
    return 0;
}

static int read_elements_4(reader *r)
{
    int64_t blocks;
    if (read_heading(r, &blocks))
        return -1;
    for (; blocks > 0; blocks--)
        if (read_element_block(r))
            return -1;
    return 0;
}

/* ---- sections */

static int read_format(reader *r)
{
    char *line;
    double version;
    int kind = 0, size = 0, one;
    int got = tokens_line(&r->t, &line, r->e);
    if (got < -1)
        return -1;
    if (got || sscanf(line, "%lf %9d %9d", &version, &kind, &size) != 3)
        return wrong(r, "no version", "$MeshFormat VERSION 0 8");
    r->version = 0;
    if (version > 2.15 && version < 2.25)
        r->version = 2;
    else if (version > 4.05 && version < 4.15)
        r->version = 4;
    if (!r->version)
        return wrong(r, "another version of MSH", "2.2 or 4.1");
    if (size != 8 || kind < 0 || kind > 1)
        return wrong(r, "another kind of MSH", "ASCII (0) or binary (1), of numbers of 8 bytes");
    if (!kind)
        return 0;
    r->t.binary = true;
    unsigned char bytes[4];
    int64_t n = in_read(r->t.s, bytes, 4, r->e);
    if (n < 0)
        return -1;
    one = n == 4 && bytes[0] == 1 && !bytes[1] && !bytes[2] && !bytes[3];
    return one ? 0 : wrong(r, "binary of another order of bytes", "little-endian");
}

/* On to the section's end, which what is not read must have too. */
static int skip_section(reader *r, const char *name)
{
    char end[80], *line;
    int got;
    snprintf(end, sizeof end, "$End%.60s", name + 1);
    while (!(got = tokens_line(&r->t, &line, r->e)))
        if (!strcmp(line, end))
            return 0;
    return got < -1 ? -1 : err_set(r->e, r->m->name, 0, "the file ends without %s", end);
}

static int end_section(reader *r, const char *name)
{
    char end[80], *line;
    snprintf(end, sizeof end, "$End%.60s", name + 1);
    int got = tokens_line(&r->t, &line, r->e);
    if (got < -1)
        return -1;
    return got || strcmp(line, end) ? wrong(r, "more in a section than it said", end) : 0;
}

typedef int section_reader(reader *r);

/* 1: the rest of the file does not matter. */
static int read_section(reader *r, const char *line)
{
    const struct {
        const char *name;
        section_reader *reads[2];
    } sections[] = {{"$MeshFormat", {read_format, read_format}},
                    {"$PhysicalNames", {read_names, read_names}},
                    {"$Entities", {NULL, read_entities}},
                    {"$Nodes", {read_nodes_2, read_nodes_4}},
                    {"$Elements", {read_elements_2, read_elements_4}}};
    char name[64];
    snprintf(name, sizeof name, "%.60s", line);
    snprintf(r->t.section, sizeof r->t.section, "%s", name);
    int at = 0;
    while (at < 5 && strcmp(sections[at].name, name) != 0)
        at++;
    if (*name != '$')
        return wrong(r, name, "a section, such as $Nodes");
    if (!r->version && at)
        return wrong(r, name, "$MeshFormat first");
    section_reader *reads = at < 5 ? sections[at].reads[r->version == 4] : NULL;
    if (!reads && r->t.binary && r->elements)
        return 1; /* where its binary ends only its readers know, and what is wanted has been read */
    int bad = 0;
    if (!reads)
        bad = skip_section(r, name);
    else if (reads(r) || end_section(r, name))
        bad = -1;
    *r->t.section = '\0';
    return bad;
}

static int finish(reader *r)
{
    import_mesh *m = r->m;
    if (check_rigid(r) || import_ids_close(&m->node_id, "node", m->name, r->e) || import_resolve(m, r->e))
        return -1;
    if (r->held_count && import_need_rigid(m, r->e))
        return -1;
    for (int64_t i = 0; i < r->held_count; i++) {
        int32_t node = import_ids_find(&m->node_id, r->held[i]);
        if (node < 0)
            return err_set(r->e, m->name, 0, "no node has the number %d; expected one that is given", r->held[i]);
        m->rigid[node] = 1;
    }
    return 0;
}

int import_msh(import_mesh *m, in *s, const import_wishes *wishes, notes *warnings, err *e)
{
    reader r = {.m = m, .w = wishes, .e = e, .t = {.s = s, .name = m->name}};
    char *line;
    int got = 0, bad = 0;
    (void)warnings;
    while (!bad && !(got = tokens_line(&r.t, &line, e)))
        bad = read_section(&r, line);
    bad = bad < 0 || (!bad && got < -1) || finish(&r) ? -1 : 0;
    for (int64_t i = 0; i < r.group_count; i++)
        free(r.groups[i].name);
    free(r.groups);
    names_free(&r.keys);
    free(r.entities);
    free(r.held);
    return bad;
}
