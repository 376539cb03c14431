#include "tools/import_sets.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

int32_t import_sets_find(const import_sets *s, const char *name)
{
    for (int64_t i = 0; i < s->count; i++)
        if (!strcmp(s->set[i].name, name))
            return (int32_t)i;
    return -1;
}

int32_t import_sets_open(import_sets *s, const char *name, err *e)
{
    int32_t at = import_sets_find(s, name);
    if (at >= 0)
        return at;
    if (MEM_ROOM(&s->set, &s->room, s->count + 1, "sets", e))
        return -1;
    s->set[s->count] = (import_set){.name = mem_text(name, e)};
    return s->set[s->count].name ? (int32_t)s->count++ : -1;
}

static int need_room(import_set *set, err *e)
{
    if (set->range && set->count < set->room)
        return 0;
    return mem_grow(&set->range, &set->room, set->count + 1, sizeof *set->range, "sets", e);
}

int import_sets_range(import_sets *s, int32_t at, int32_t first, int32_t last, int32_t step, err *e)
{
    import_set *set = &s->set[at];
    import_range *before = set->count ? &set->range[set->count - 1] : NULL;
    if (before && before->first >= 0 && before->step == 1 && step == 1 && first == (int64_t)before->last + 1) {
        before->last = last;
        return 0;
    }
    if (need_room(set, e))
        return -1;
    set->range[set->count++] = (import_range){first, last, step};
    return 0;
}

int import_sets_include(import_sets *s, int32_t at, int32_t other, err *e)
{
    import_set *set = &s->set[at];
    if (need_room(set, e))
        return -1;
    set->range[set->count++] = (import_range){-1 - other, 0, 0};
    return 0;
}

static int go_range(const import_range *r, const import_ids *ids, import_sets_each *each, void *context)
{
    int64_t many = ((int64_t)r->last - r->first) / r->step + 1;
    int result = 0;
    if (many <= ids->count) {
        for (int64_t id = r->first; !result && id <= r->last; id += r->step) {
            int32_t index = import_ids_find(ids, id);
            result = index < 0 ? 0 : each(context, index);
        }
        return result;
    }
    for (int64_t i = 0; !result && i < ids->count; i++)
        if (ids->id[i] >= r->first && ids->id[i] <= r->last && (ids->id[i] - r->first) % r->step == 0)
            result = each(context, ids->index ? ids->index[i] : (int32_t)i);
    return result;
}

int import_sets_go(import_sets *s, int32_t at, const import_ids *ids, import_sets_each *each, void *context, err *e)
{
    int32_t *queue = mem_array(s->count, sizeof *queue, "sets", e);
    int64_t queued = 1;
    int result = queue ? 0 : -1;
    for (int64_t i = 0; i < s->count; i++)
        s->set[i].seen = i == at;
    if (queue)
        queue[0] = at;
    for (int64_t q = 0; !result && q < queued; q++) {
        const import_set *set = &s->set[queue[q]];
        for (int64_t i = 0; !result && i < set->count; i++) {
            int32_t other = -1 - set->range[i].first;
            if (other < 0)
                result = go_range(&set->range[i], ids, each, context);
            else if (!s->set[other].seen) {
                s->set[other].seen = true;
                queue[queued++] = other;
            }
        }
    }
    free(queue);
    return result;
}

void import_sets_free(import_sets *s)
{
    for (int64_t i = 0; i < s->count; i++) {
        free(s->set[i].name);
        free(s->set[i].range);
    }
    free(s->set);
    *s = (import_sets){.count = 0};
}
