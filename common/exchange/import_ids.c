#include "exchange/import_ids.h"

#include "base/mem.h"

#include <stdlib.h>

typedef struct pair {
    int32_t id, index;
} pair;

int import_ids_add(import_ids *s, int32_t id, err *e)
{
    if (MEM_ROOM(&s->id, &s->room, s->count + 1, "numbers", e))
        return -1;
    s->falls |= s->count && id <= s->id[s->count - 1];
    s->id[s->count++] = id;
    return 0;
}

static int by_id(const void *a, const void *b)
{
    const pair *p = a, *q = b;
    return (p->id > q->id) - (p->id < q->id);
}

int import_ids_close(import_ids *s, const char *what, const char *place, err *e)
{
    if (!s->falls)
        return 0;
    pair *list = mem_array(s->count, sizeof *list, "numbers", e);
    s->index = list ? mem_array(s->count, sizeof *s->index, "numbers", e) : NULL;
    int bad = s->index ? 0 : -1;
    for (int64_t i = 0; !bad && i < s->count; i++)
        list[i] = (pair){s->id[i], (int32_t)i};
    if (!bad)
        qsort(list, (size_t)s->count, sizeof *list, by_id);
    for (int64_t i = 0; !bad && i < s->count; i++) {
        s->id[i] = list[i].id;
        s->index[i] = list[i].index;
        if (i && list[i].id == list[i - 1].id)
            bad = err_set(e, place, 0, "%s %d is given twice; expected a different number for each", what, list[i].id);
    }
    free(list);
    return bad;
}

int32_t import_ids_find(const import_ids *s, int64_t id)
{
    int64_t low = 0, high = s->count;
    if (s->count && !s->index && id >= s->id[0] && id - s->id[0] < s->count && s->id[id - s->id[0]] == id)
        return (int32_t)(id - s->id[0]); /* as most files number them */
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (s->id[middle] < id)
            low = middle + 1;
        else
            high = middle;
    }
    if (low == s->count || s->id[low] != id)
        return -1;
    return s->index ? s->index[low] : (int32_t)low;
}

int32_t import_ids_of(const import_ids *s, int32_t index)
{
    int64_t at = s->index ? 0 : index;
    while (s->index && at + 1 < s->count && s->index[at] != index)
        at++;
    return s->id[at];
}

void import_ids_free(import_ids *s)
{
    free(s->id);
    free(s->index);
    *s = (import_ids){.count = 0};
}
