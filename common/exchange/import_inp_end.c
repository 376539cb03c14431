#include "base/mem.h"
#include "base/near.h"
#include "exchange/import_inp_parts.h"

#include <stdlib.h>
#include <string.h>

/* Goes with import_sets_go: what the members of a set get. */
typedef struct giving {
    inp_reader *r;
    int32_t volume;
    int64_t line; /* 0: those that have a volume keep it */
    uint8_t *mask, bits;
} giving;

static int give_volume(void *context, int32_t element)
{
    const giving *g = context;
    import_mesh *m = g->r->m;
    if (m->volume[element] >= 0 && m->volume[element] != g->volume && g->line)
        return err_set(g->r->e, m->name, g->line, "element %d has a section already, %.200s; expected one for each",
                       import_ids_of(&g->r->element_id, element), m->volumes[m->volume[element]].name);
    if (m->volume[element] < 0)
        m->volume[element] = g->volume;
    return 0;
}

static int give_hold(void *context, int32_t node)
{
    const giving *g = context;
    g->mask[node] |= g->bits;
    return 0;
}

static int make_volumes(inp_reader *r)
{
    for (int64_t i = 0; i < (r->section_count ? r->section_count : r->elements.count); i++) {
        const inp_section *s = r->section_count ? &r->sections[i] : NULL;
        const int32_t set = s ? s->set : (int32_t)i;
        giving g = {.r = r, .line = s ? s->line : 0};
        g.volume = import_add_volume(r->m, r->elements.names.name[set], r->e);
        if (g.volume < 0)
            return -1;
        if (s)
            r->m->volumes[g.volume].material = s->material;
        if (import_sets_go(&r->elements, set, &r->element_id, give_volume, &g, r->e))
            return -1;
    }
    return 0;
}

/* sinew export puts V_ and M_ before names: they go again, where that leaves each its own. */
static int strip(char **name, size_t stride, int64_t count, const char *prefix, err *e)
{
    names all = {0};
    int bad = 0;
    for (int64_t i = 0; !bad && i < count; i++)
        bad = names_number(&all, *(char **)((char *)name + (size_t)i * stride), e) < 0;
    for (int64_t i = 0; !bad && i < count; i++) {
        char *own = *(char **)((char *)name + (size_t)i * stride);
        if (strncmp(own, prefix, 2) != 0 || !own[2] || names_find(&all, own + 2) >= 0)
            continue;
        memmove(own, own + 2, strlen(own + 2) + 1);
        bad = names_number(&all, own, e) < 0;
    }
    names_free(&all);
    return bad ? -1 : 0;
}

/* A volume without elements is none: sets that sections do not name are not volumes. */
static int drop_empty(import_mesh *m, err *e)
{
    int32_t *place = mem_array(m->volume_count, sizeof *place, "volumes", e), kept = 0;
    if (!place)
        return -1;
    for (int64_t i = 0; i < m->elements; i++)
        if (m->volume[i] >= 0)
            place[m->volume[i]] = 1;
    for (int64_t v = 0; v < m->volume_count; v++)
        if (place[v]) {
            place[v] = kept;
            m->volumes[kept++] = m->volumes[v];
        } else
            free(m->volumes[v].name);
    m->volume_count = kept;
    for (int64_t i = 0; i < m->elements; i++)
        m->volume[i] = m->volume[i] < 0 ? -1 : place[m->volume[i]];
    free(place);
    return 0;
}

static int unknown_set(const inp_reader *r, const char *name)
{
    const int32_t count = r->nodes.names.count < 1000 ? r->nodes.names.count : 1000;
    return near_option(r->e, "--rigid", "node set", name, (const char *const *)r->nodes.names.name, count);
}

static int hold_named(inp_reader *r, const import_wishes *w, giving *g)
{
    for (int i = 0; i < w->rigids; i++) {
        char *copy = mem_text(w->rigid[i], r->e);
        int32_t set = copy ? import_sets_find(&r->nodes, import_inp_name(copy)) : -1;
        free(copy);
        if (!copy)
            return -1;
        if (set < 0)
            return unknown_set(r, w->rigid[i]);
        if (import_sets_go(&r->nodes, set, &r->m->node_id, give_hold, g, r->e))
            return -1;
    }
    return 0;
}

static int make_rigid(inp_reader *r, const import_wishes *w)
{
    import_mesh *m = r->m;
    giving g = {.r = r, .bits = 7};
    int64_t part = 0;
    if (!r->hold_count && !w->rigids)
        return 0;
    if (import_need_rigid(m, r->e))
        return -1;
    g.mask = m->rigid;
    if (hold_named(r, w, &g))
        return -1;
    for (int64_t i = 0; i < r->hold_count; i++) {
        const inp_held *h = &r->holds[i];
        int32_t node = h->node < 0 ? -1 : import_ids_find(&m->node_id, h->node);
        g.bits = h->mask;
        if (h->set >= 0 && import_sets_go(&r->nodes, h->set, &m->node_id, give_hold, &g, r->e))
            return -1;
        if (node >= 0)
            m->rigid[node] |= h->mask;
    }
    for (int64_t n = 0; n < m->nodes; n++) {
        part += m->rigid[n] && m->rigid[n] != 7;
        m->rigid[n] = m->rigid[n] == 7;
    }
    if (part)
        notes_add(r->warnings, "%lld node%s held in one or two components only: not rigid", (long long)part,
                  part == 1 ? " is" : "s are");
    return 0;
}

int import_inp_finish(inp_reader *r, const import_wishes *w)
{
    import_mesh *m = r->m;
    if (import_ids_close(&m->node_id, "node", m->name, r->e) ||
        import_ids_close(&r->element_id, "element", m->name, r->e) || import_resolve(m, r->e) || make_volumes(r) ||
        drop_empty(m, r->e) || make_rigid(r, w))
        return -1;
    names_free(&m->volume_names); /* they are others now */
    names_free(&m->material_names);
    if (m->volume_count && strip(&m->volumes[0].name, sizeof *m->volumes, m->volume_count, "v_", r->e))
        return -1;
    return m->materials ? strip(&m->material[0].name, sizeof *m->material, m->materials, "m_", r->e) : 0;
}
