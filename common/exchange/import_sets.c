#include "exchange/import_sets.h"

#include "base/mem.h"

#include <stdlib.h>

int32_t import_sets_find(const import_sets *s, const char *name)
{
    return names_find(&s->names, name);
}

int32_t import_sets_open(import_sets *s, const char *name, err *e)
{
    const int32_t at = names_number(&s->names, name, e);
    if (at < s->count)
        return at;
    if (MEM_ROOM(&s->set, &s->room, s->count + 1, "sets", e))
        return -1;
    s->set[s->count++] = (import_set){.count = 0};
    return at;
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

static int see(import_sets *s, int32_t at, int64_t *queued, err *e)
{
    if (s->set[at].seen == s->goes)
        return 0;
    if (MEM_ROOM(&s->queue, &s->queue_room, *queued + 1, "sets", e))
        return -1;
    s->set[at].seen = s->goes;
    s->queue[(*queued)++] = at;
    return 0;
}

int import_sets_go(import_sets *s, int32_t at, const import_ids *ids, import_sets_each *each, void *context, err *e)
{
    int64_t queued = 0;
    s->goes++;
    int result = see(s, at, &queued, e);
    for (int64_t q = 0; !result && q < queued; q++) {
        const import_set *set = &s->set[s->queue[q]];
        for (int64_t i = 0; !result && i < set->count; i++) {
            const import_range *r = &set->range[i];
            result = r->first < 0 ? see(s, -1 - r->first, &queued, e) : go_range(r, ids, each, context);
        }
    }
    return result;
}

void import_sets_free(import_sets *s)
{
    for (int64_t i = 0; i < s->count; i++)
        free(s->set[i].range);
    free(s->set);
    free(s->queue);
    names_free(&s->names);
    *s = (import_sets){.count = 0};
}
