#include "tled/tiles/tile_parts.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

static bool has_node(const tiles *t, const tile *of, const uint8_t *is)
{
    for (int32_t k = of->node; k < of->node + of->nodes; k++)
        if (is[t->node[k]])
            return true;
    for (int32_t k = of->halo; k < of->halo + of->halos; k++)
        if (is[t->node[t->halo_node[k]]])
            return true;
    return false;
}

/* Takes those that have, or have not, such a node, with their lists, to `to` and on. Returns how many. */
static int64_t take_tiles(const tiles *t, const uint8_t *is, bool that_have, tile *to, int32_t *list)
{
    int64_t count = 0;
    for (int64_t i = 0; i < t->count; i++) {
        if (has_node(t, &t->tile[i], is) != that_have)
            continue;
        if (t->list)
            list[count] = t->list[i];
        to[count++] = t->tile[i];
    }
    return count;
}

int64_t tiles_part(tiles *t, const int32_t *node, int64_t count, err *e)
{
    int64_t last = -1;
    uint8_t *is = mem_array(t->nodes, sizeof *is, "the solver", e);
    tile *of = is ? mem_array(t->count, sizeof *of, "the solver", e) : NULL;
    int32_t *list = of ? mem_array(t->count, sizeof *list, "the solver", e) : NULL;
    if (list) {
        for (int64_t i = 0; i < count; i++)
            is[node[i]] = 1;
        const int64_t others = take_tiles(t, is, false, of, list);
        last = take_tiles(t, is, true, of + others, list + others);
        memcpy(t->tile, of, (size_t)t->count * sizeof *of);
        if (t->list)
            memcpy(t->list, list, (size_t)t->count * sizeof *list);
    }
    free(list);
    free(of);
    free(is);
    return last;
}
