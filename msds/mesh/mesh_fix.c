#include "msds/mesh/mesh_fix.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/near.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDES = 6, ALL_ROUND = 15, WORD = 400 };

static const char *const words[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax", "sides", "none"};

enum { WORDS = sizeof words / sizeof *words };

/* Where a node stands in the mesh, and between which places all of them do. */
typedef struct places {
    const int32_t *nodes, *lattice; /* of a box, or of a voxel model */
    int32_t low[3], high[3];
} places;

static int32_t place_of(const places *p, int64_t node, int axis)
{
    if (!p->nodes)
        return p->lattice[3 * node + axis];
    if (axis == 0)
        return (int32_t)(node % p->nodes[0]);
    node /= p->nodes[0];
    return (int32_t)(axis == 1 ? node % p->nodes[1] : node / p->nodes[1]);
}

static void find_ends(places *p, int64_t count)
{
    for (int a = 0; a < 3; a++) {
        p->low[a] = INT32_MAX;
        p->high[a] = INT32_MIN;
        for (int64_t n = 0; n < count; n++) {
            int32_t at = place_of(p, n, a);
            p->low[a] = at < p->low[a] ? at : p->low[a];
            p->high[a] = at > p->high[a] ? at : p->high[a];
        }
    }
}

/* sides: bits of the first six words. */
static int fix_sides(model *m, unsigned sides, const int32_t *nodes, uint8_t *rigid, err *e)
{
    places p = {.nodes = nodes};
    int64_t count = model_count(m, "node");
    if (!nodes) {
        const model_array *lattice = model_need(m, "node.lattice", e);
        if (!lattice)
            return -1;
        p.lattice = lattice->i32;
    }
    find_ends(&p, count);
    for (int64_t n = 0; n < count; n++)
        for (int s = 0; s < SIDES; s++)
            if (sides >> s & 1 && place_of(&p, n, s / 2) == (s % 2 ? p.high : p.low)[s / 2])
                rigid[n] = 1;
    return 0;
}

/* Fixes the nodes of a volume. False: there is none of that name. */
static bool fix_volume(const model *m, const char *name, uint8_t *rigid)
{
    const model_array *node = model_find(m, "element.node"), *of = model_find(m, "element.volume");
    const model_array *names = model_find(m, "volume.name");
    for (int64_t v = 0; names && of && v < names->rows; v++) {
        if (!chars_mean(name, names->str[v]))
            continue;
        for (int64_t n = 0; n < of->rows; n++)
            for (int c = 0; of->i32[n] == v && c < node->columns; c++)
                rigid[node->i32[n * node->columns + c]] = 1;
        return true;
    }
    return false;
}

static int unknown(const model *m, const char *word, err *e)
{
    const model_array *names = model_find(m, "volume.name");
    int64_t volumes = names ? names->rows : 0;
    const char **list = mem_array(WORDS + volumes, sizeof *list, "names", e);
    for (int64_t i = 0; list && i < WORDS + volumes; i++)
        list[i] = i < WORDS ? words[i] : names->str[i - WORDS];
    if (list)
        near_option(e, "--fix", "side or volume", word, list, (int)(WORDS + volumes));
    free(list);
    return -1;
}

static int find_word(const char *word)
{
    for (int i = 0; i < WORDS; i++)
        if (!strcmp(words[i], word))
            return i;
    return -1;
}

/* sides: becomes bits of the first six words. Fixes the volumes at once. */
static int take_words(model *m, const char *list, unsigned *sides, err *e)
{
    model_array *rigid = model_find(m, "node.rigid");
    *sides = 0;
    if (!rigid && !(rigid = model_add(m, "node.rigid", e)))
        return -1;
    for (const char *p = list, *comma; p; p = comma ? comma + 1 : NULL) {
        char word[WORD];
        comma = strchr(p, ',');
        snprintf(word, sizeof word, "%.*s", (int)strcspn(p, ","), p);
        int known = find_word(word);
        if (known < 0 && !fix_volume(m, word, rigid->u8))
            return unknown(m, word, e);
        if (known >= 0 && known < SIDES)
            *sides |= 1U << known;
        else if (known == SIDES)
            *sides |= ALL_ROUND;
    }
    return 0;
}

int mesh_fix(model *m, const char *list, const int32_t *nodes, err *e)
{
    unsigned sides;
    if (take_words(m, list, &sides, e))
        return -1;
    return sides ? fix_sides(m, sides, nodes, model_find(m, "node.rigid")->u8, e) : 0;
}

int mesh_fix_made(model *m, const char *list, const mesh_made *of, err *e)
{
    unsigned sides;
    if (take_words(m, list, &sides, e))
        return -1;
    return sides ? mesh_sides_mark(of, sides, model_find(m, "node.rigid")->u8, e) : 0;
}

int64_t mesh_fixed(const model *m)
{
    const model_array *rigid = model_find(m, "node.rigid");
    int64_t count = 0;
    for (int64_t n = 0; rigid && n < rigid->rows; n++)
        count += rigid->u8[n] != 0;
    return count;
}
