#include "inspect/info_key.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/near.h"
#include "base/num.h"
#include "cli/spelling.h"
#include "inspect/info_names.h"
#include "inspect/info_stats.h"
#include "model/known.h"
#include "model/rest_place.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NATURE "rows, columns, type, unit, axis, row.N, at.X,Y,Z (nodes, elements, vertices) and NAME (tables)"

int64_t info_table_rows(const model *m, const char *axis)
{
    size_t n = strlen(axis);
    for (int i = 0; i < m->arrays.count; i++) {
        const model_array *a = &m->arrays.v[i];
        if (!strcmp(a->axis, axis) && !strncmp(a->name, axis, n) && a->name[n] == '.')
            return a->rows;
    }
    return 0;
}

int64_t *info_volume_counts(const model *m, err *e)
{
    const model_array *of = model_find(m, "element.volume");
    int64_t volumes = info_table_rows(m, "volume");
    int64_t *count = mem_array(volumes, sizeof *count, "counts of elements", e);
    for (int64_t i = 0; count && of && i < of->rows; i++)
        if (of->i32[i] < volumes)
            count[of->i32[i]]++;
    return count;
}

/* Writes how many elements volume v has. */
static int put_volume_count(const model *m, int64_t v, out *to, err *e)
{
    int64_t *count = info_volume_counts(m, e);
    if (!count)
        return -1;
    out_format(to, "%" PRId64, count[v]);
    free(count);
    return 0;
}

/* The row of the table over `axis` that has the very name, or -1. A muscle has its volume's name. */
static int64_t exact_row(const model *m, const char *axis, const char *name)
{
    char names[MODEL_NAME + 16];
    snprintf(names, sizeof names, "%s.name", axis);
    const model_array *a = model_find(m, names), *of = NULL;
    if (!a && !strcmp(axis, "muscle")) {
        of = model_find(m, "muscle.volume");
        a = of ? model_find(m, "volume.name") : NULL;
    }
    if (!a || a->type != MODEL_STR || a->columns != 1)
        return -1;
    for (int64_t i = 0; i < (of ? of->rows : a->rows); i++)
        if (chars_mean(name, a->str[of ? of->i32[i] : i]))
            return i;
    return -1;
}

/* The same, where muscle_ of the name may be left out. */
static int64_t named_row(const model *m, const char *axis, const char *name)
{
    char whole[MODEL_NAME + 16];
    int64_t row = exact_row(m, axis, name);
    if (row >= 0 || (strcmp(axis, "volume") != 0 && strcmp(axis, "muscle") != 0) || strlen(name) >= MODEL_NAME)
        return row;
    snprintf(whole, sizeof whole, "muscle_%s", name);
    return exact_row(m, axis, whole);
}

/* A request: the array, and what of it. */
typedef struct query {
    const source *s;
    const model_array *a;
    const char *key, *what;
    out *to;
} query;

static int no_value(const query *q, err *e, const char *why)
{
    return err_set(e, source_name(q->s), 0, "no key '%s': %s", q->key, why);
}

static int put_at(const query *q, err *e)
{
    double to[3];
    if (!rest_place_of(q->what + 3, to))
        return no_value(q, e, "expected at.X,Y,Z, three lengths between commas (metres, or with a unit)");
    int64_t row = rest_place_row(&q->s->body, q->a->axis, to);
    if (row < 0)
        return no_value(q, e, "at.X,Y,Z is for arrays of nodes, elements and vertices, and there must be some");
    source_put_row(q->a, row, false, q->to);
    return 0;
}

static int put_row(const query *q, const char *number, err *e)
{
    int64_t row;
    char why[128];
    snprintf(why, sizeof why, "it has %" PRId64 " rows; expected a row from 0 on", q->a->rows);
    if (num_int(number, 0, q->a->rows - 1, &row))
        return no_value(q, e, why);
    source_put_row(q->a, row, false, q->to);
    return 0;
}

/* Sums and means are of columns for vectors, of all values else. */
static void put_sums(const query *q, const info_stats *s, double divisor)
{
    for (int c = 0; c < (info_is_vector(q->a) ? 3 : 1); c++) {
        out_text(q->to, c ? " " : "");
        info_put_number(s->sum[c] / divisor, MODEL_F64, q->to);
    }
}

static void put_range(const query *q, bool high)
{
    for (int32_t c = 0; c < q->a->columns; c++) {
        info_stats s = info_column_of(q->a, c);
        out_text(q->to, c ? " " : "");
        info_put_end(q->a, &s, high, q->to);
    }
}

/* What every array has. 1: it was none of these. */
static int put_nature(const query *q)
{
    if (!strcmp(q->what, "rows"))
        out_format(q->to, "%" PRId64, q->a->rows);
    else if (!strcmp(q->what, "columns"))
        out_format(q->to, "%d", (int)q->a->columns);
    else if (!strcmp(q->what, "type"))
        out_text(q->to, model_type_name(model_stored(q->a)));
    else if (!strcmp(q->what, "unit"))
        out_text(q->to, q->a->unit);
    else if (!strcmp(q->what, "axis"))
        out_text(q->to, q->a->axis);
    else
        return 1;
    return 0;
}

/* What arrays of numbers have. 1: it was none of these. */
static int put_numbers(const query *q)
{
    static const char *const names[] = {"min", "max", "sum", "mean", "nan", "low", "high"};
    int which = 0;
    while (which < 7 && strcmp(q->what, names[which]) != 0)
        which++;
    if (which == 7 || q->a->type == MODEL_STR)
        return 1;
    info_stats s = which < 5 ? info_stats_of(q->a) : (info_stats){0};
    if (which < 2)
        info_put_end(q->a, &s, which, q->to);
    else if (which < 4)
        put_sums(q, &s, which == 3 ? (double)s.count : 1);
    else if (which == 4)
        out_format(q->to, "%" PRId64, s.nans);
    else
        put_range(q, which == 6);
    return 0;
}

static int put_array(const query *q, err *e)
{
    if (!q->what && q->a->rows != 1)
        return no_value(q, e, "it has several rows or none; add .max, .row.N, .at.X,Y,Z or the like");
    if (!q->what)
        return put_row(q, "0", e);
    if (!strncmp(q->what, "at.", 3))
        return put_at(q, e);
    if (!strncmp(q->what, "row.", 4))
        return put_row(q, q->what + 4, e);
    if (!put_nature(q) || !put_numbers(q))
        return 0;
    int64_t row = named_row(&q->s->body, q->a->axis, q->what);
    if (row >= 0) {
        source_put_row(q->a, row, false, q->to);
        return 0;
    }
    if (q->a->type == MODEL_STR)
        return no_value(q, e, "an array of strings has " NATURE);
    return no_value(q, e, "an array of numbers has min, max, sum, mean, low, high, nan, " NATURE);
}

/* Takes the longest name of an array that the key is or begins with; false: none. */
static bool find_array(query *q)
{
    char name[MODEL_NAME];
    for (size_t n = strlen(q->key); n > 0; n--) {
        if ((q->key[n] && q->key[n] != '.') || n >= sizeof name)
            continue;
        snprintf(name, sizeof name, "%.*s", (int)n, q->key);
        q->a = source_find(q->s, name);
        q->what = q->key[n] ? q->key + n + 1 : NULL;
        if (q->a)
            return true;
    }
    return false;
}

/* An array's key put right, where as many parts of the key as the array's name has look like that name. */
static void note_array(notes *list, const char *name, const char *key)
{
    char head[MODEL_NAME];
    const char *end = key + strcspn(key, ".");
    for (const char *dot = strchr(name, '.'); dot && *end; dot = strchr(dot + 1, '.'))
        end += 1 + strcspn(end + 1, ".");
    snprintf(head, sizeof head, "%.*s", (int)(end - key), key);
    if (near_name(head, &name, 1) == 0)
        notes_add(list, "%s%s", name, end);
}

/* What the key could have meant. */
static void note_keys(const source *s, const char *key, notes *list)
{
    const model *m = &s->body;
    const model_array *names = model_find(m, "volume.name");
    notes_add(list, "frames");
    notes_add(list, "frame.time");
    notes_add(list, "frame.index");
    notes_add(list, "surface.name");
    notes_add(list, "group.name");
    notes_add(list, "array.name");
    if (model_find(m, "muscle.volume"))
        notes_add(list, INFO_NAMES_MUSCLES);
    if (model_find(m, "material.law"))
        notes_add(list, INFO_NAMES_KEYS);
    for (int i = 0; i < INFO_QUALITY_KEYS; i++)
        notes_add(list, "%s", info_quality_keys[i]);
    for (int i = 0; i < m->axis_count; i++)
        notes_add(list, "axis.%s", m->axes[i].name);
    for (int i = 0; i < m->metas; i++)
        notes_add(list, "meta.%s", m->meta[i].key);
    for (int64_t i = 0; names && i < names->rows; i++)
        notes_add(list, "volume.count.%s", names->str[i]);
    for (int i = 0; i < m->arrays.count; i++)
        note_array(list, m->arrays.v[i].name, key);
    for (int i = 0; s->frames && i < s->frame.arrays.count; i++)
        note_array(list, s->frame.arrays.v[i].name, key);
}

static void note_arrays(const source *s, notes *list)
{
    for (int i = 0; i < s->body.arrays.count; i++)
        notes_add(list, "%s", s->body.arrays.v[i].name);
    for (int i = 0; s->frames && i < s->frame.arrays.count; i++)
        notes_add(list, "%s", s->frame.arrays.v[i].name);
}

/* The longest known array that the key could mean, for saying who makes it. */
static const known *known_of(const char *key)
{
    char name[MODEL_NAME];
    for (size_t n = strlen(key); n > 0; n--) {
        if ((key[n] && key[n] != '.') || n >= sizeof name)
            continue;
        snprintf(name, sizeof name, "%.*s", (int)n, key);
        const known *k = known_find(name);
        if (k)
            return k;
    }
    return NULL;
}

/* A known array that the model lacks: who makes it. */
static int lacking(const source *s, const char *key, const known *k, err *e)
{
    if (!k->maker)
        return err_set(e, source_name(s), 0, "no key '%.80s': the model has no %s; the name is reserved", key, k->name);
    if (k->flags & KNOWN_FRAME && !s->frames)
        return err_set(e, source_name(s), 0, "no key '%.80s': the model has no frames; they come from %s", key,
                       k->maker);
    if (k->flags & KNOWN_FRAME)
        return err_set(e, source_name(s), 0, "no key '%.80s': the last frame has no %s; it comes from %s", key, k->name,
                       k->maker);
    return err_set(e, source_name(s), 0, "no key '%.80s': the model has no %s; it comes from %s", key, k->name,
                   k->maker);
}

static int unknown_key(const source *s, const char *key, err *e)
{
    char all[700];
    notes list = {0}, arrays = {0};
    const known *k = known_of(key);
    note_keys(s, key, &list);
    note_arrays(s, &arrays);
    int near = near_name(key, (const char *const *)list.line, list.count);
    if (!strcmp(key, INFO_NAMES_MUSCLES))
        lacking(s, key, known_find("muscle.volume"), e);
    else if (!strncmp(key, "frame.", 6) && !s->frames)
        err_set(e, source_name(s), 0, "no key '%.80s': the model has no frames; they come from tled-run", key);
    else if (k)
        lacking(s, key, k, e);
    else if (near >= 0)
        err_set(e, source_name(s), 0, "no key '%.80s'; did you mean '%s'?", key, list.line[near]);
    else if (!strncmp(key, "quality", 7) && (key[7] == '.' || !key[7])) {
        near_list(all, sizeof all, info_quality_keys, INFO_QUALITY_KEYS);
        err_set(e, source_name(s), 0, "no key '%.80s'; expected one of these: %s", key, all);
    } else {
        near_list(all, sizeof all, (const char *const *)arrays.line, arrays.count);
        err_set(e, source_name(s), 0,
                "no key '%.80s'; expected frames, frame.time, frame.index, axis.NAME, meta.KEY, volume.count.NAME, "
                "quality.KEY or "
                "ARRAY.VALUE with one of these arrays: %s",
                key, all);
    }
    notes_free(&list);
    notes_free(&arrays);
    return -1;
}

/* Keys that are of no array. 1: it was none of these; -1: e filled. */
static int put_plain(const source *s, info_quality_seen *seen, const char *key, out *to, err *e)
{
    if (!strcmp(key, "frames")) {
        out_format(to, "%" PRId64, s->frames);
    } else if (!strcmp(key, "frame.index") && s->frames) {
        out_format(to, "%" PRId64, s->frame.index);
    } else if (!strcmp(key, "frame.time") && s->frames) {
        info_put_number(s->frame.time, MODEL_F64, to);
    } else if (!strncmp(key, "axis.", 5) && model_count(&s->body, key + 5) >= 0) {
        out_format(to, "%" PRId64, model_count(&s->body, key + 5));
    } else if (!strncmp(key, "meta.", 5) && model_meta_of(&s->body, key + 5)) {
        out_text(to, model_meta_of(&s->body, key + 5));
    } else if (!strncmp(key, "volume.count.", 13)) {
        int64_t v = named_row(&s->body, "volume", key + 13);
        if (v < 0)
            return 1;
        return put_volume_count(&s->body, v, to, e);
    } else {
        return info_quality(s, seen, key, to, e);
    }
    return 0;
}

const char *info_key_spelled(const source *s, const char *key, char to[INFO_KEY])
{
    const size_t length = strlen(key);
    if (find_array(&(query){.s = s, .key = key}))
        return key;
    for (size_t n = length; n > 0; n--) {
        if ((key[n] && key[n] != '.') || !spelling_british(key, n, to, INFO_KEY) ||
            (!known_find(to) && !info_quality_unit(to)))
            continue;
        const size_t head = strlen(to);
        if (head + (length - n) >= INFO_KEY)
            return key;
        memcpy(to + head, key + n, length - n + 1);
        return to;
    }
    return key;
}

int info_key(const source *s, info_quality_seen *seen, const char *key, out *to, err *e)
{
    query q = {.s = s, .key = key, .to = to};
    int other = put_plain(s, seen, key, to, e);
    if (other <= 0)
        return other;
    if (!find_array(&q))
        return unknown_key(s, key, e);
    return put_array(&q, e);
}

const char *info_key_unit(const source *s, const char *key, err *e)
{
    static const char *const counts[] = {"rows", "columns", "nan"}, *const words[] = {"type", "unit", "axis"};
    query q = {.s = s, .key = key};
    if (info_quality_unit(key))
        return info_quality_unit(key);
    const bool found = find_array(&q);
    if (!found && strcmp(key, "frames") != 0 && strncmp(key, "axis.", 5) != 0 && strncmp(key, "meta.", 5) != 0 &&
        strncmp(key, "frame.", 6) != 0 && strncmp(key, "volume.count.", 13) != 0) {
        unknown_key(s, key, e);
        return NULL;
    }
    bool is_number = found && frame_find(&s->frame, q.a->name) == q.a && q.a->type != MODEL_STR;
    for (int i = 0; is_number && q.what && i < 3; i++)
        is_number = strcmp(q.what, words[i]) != 0;
    if (!is_number) {
        err_set(e, source_name(s), 0,
                "'%.80s' is not a number of a frame; expected one of a frame's array, as node.displacement.max", key);
        return NULL;
    }
    for (int i = 0; q.what && i < 3; i++)
        if (!strcmp(q.what, counts[i]))
            return "";
    return q.a->unit;
}
