/* sinew-info: what a model holds, for people, as JSON, or one value at a time. */
#include "base/num.h"
#include "cli/tool.h"
#include "inspect/info_json.h"
#include "inspect/info_key.h"
#include "inspect/info_names.h"
#include "inspect/info_quality.h"
#include "inspect/info_series.h"
#include "inspect/info_stats.h"
#include "mesh/element_place.h"
#include "model/known.h"
#include "model/material_edit.h"
#include "model/source.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
    opt_common common;
    opt_list get, tsv;
    bool json, salvage, names;
};

#define TO(field) offsetof(struct options, field)
static const opt option_table[] = {
    {OPT_RESULT, 0, "get", "KEY", OPT_LIST, TO(get), 0, 0,
     "frames|frame.time|frame.index|muscle.name|surface.name|group.name|array.name|quality.folded|node.displacement."
     "max|@array.name",
     OPT_OUTPUT, "print one value or list, e.g. frames, muscle.name, node.displacement.max"},
    {OPT_RESULT, 0, "tsv", "KEY", OPT_LIST, TO(tsv), 0, 0,
     "node.displacement.max|node.velocity.max|quality.folded|quality.j.centre|quality.j.corner|quality.hourglass",
     OPT_OUTPUT, "print a value of each frame, a row a frame (TSV)"},
    {OPT_RESULT, 0, "json", NULL, OPT_FLAG, TO(json), 0, 0, NULL, OPT_OUTPUT, "print the summary as JSON"},
    {OPT_INPUT, 0, "salvage", NULL, OPT_FLAG, TO(salvage), 0, 0, NULL, OPT_OUTPUT,
     "use the complete frames of an incomplete stream"},
    {OPT_INPUT, 0, "names", NULL, OPT_FLAG, TO(names), 0, 0, NULL, OPT_OUTPUT | OPT_HIDDEN, "for completion"},
    {0}};

static const opt_tool table = {
    .name = "sinew-info",
    .command = "sinew info",
    .usage = "[options] model\n[options] < model",
    .purpose = "Prints what a model contains: materials, volumes, muscles, arrays and frames.",
    .example = "sinew info --get muscle.name face.sinew",
    .operands = "MODEL",
    .operands_max = 1,
    .options = option_table,
};

/* For people seven digits do; whole numbers are whole. */
static void put_short(double value, model_type from, out *to)
{
    if (isnan(value) || (from != MODEL_F32 && from != MODEL_F64))
        info_put_number(value, from, to);
    else
        out_format(to, "%.7g", value);
}

static void put_end(const model_array *a, const info_stats *s, bool max, out *to)
{
    if (a->type == MODEL_F32 || a->type == MODEL_F64)
        put_short(max ? s->max : s->min, a->type, to);
    else
        info_put_end(a, s, max, to);
}

/* Adds a cell of the text that is in a memory's out, and empties it. */
static void take_cell(text_table *t, out *text)
{
    size_t size;
    const char *bytes = (const char *)out_bytes(text, &size);
    text_table_cell(t, "%.*s", (int)size, bytes);
    out_discard(text);
}

static void add_range(text_table *t, const model_array *a, err *e)
{
    out *text = out_memory(e);
    if (!text)
        return;
    if (a->type == MODEL_STR || !a->rows) {
        out_text(text, "-");
        take_cell(t, text);
        return;
    }
    info_stats s = info_stats_of(a);
    out_text(text, info_is_vector(a) ? "norm " : "");
    put_end(a, &s, false, text);
    out_text(text, " to ");
    put_end(a, &s, true, text);
    if (s.nans)
        out_format(text, ", %" PRId64 " nan", s.nans);
    take_cell(t, text);
}

static int put_arrays(const model_arrays *list, bool meanings, out *to, err *e)
{
    const char *const heads[] = {
        "<array", "<type", ">columns", "<axis", "<unit", "<range", meanings ? "<meaning" : NULL, NULL};
    text_table *t = text_table_create(heads, e);
    for (int i = 0; t && i < list->count; i++) {
        const model_array *a = &list->v[i];
        const known *k = known_find(a->name);
        text_table_cell(t, "%s", a->name);
        text_table_cell(t, "%s", model_type_name(model_stored(a)));
        text_table_count(t, a->columns);
        text_table_cell(t, "%s", a->axis);
        text_table_cell(t, "%s", a->unit);
        add_range(t, a, e);
        if (meanings)
            text_table_cell(t, "%s", k ? k->meaning : "not one of Sinew's: passed on as it is");
    }
    return text_table_put(t, to, e);
}

static void put_line(const char *title, const char *key, const char *value, out *to)
{
    out_format(to, "%s  ", title);
    if (key)
        out_format(to, "%-22s ", key);
    source_put_text(value, to);
    out_text(to, "\n");
}

static void put_head(const source *s, out *to)
{
    const model *m = &s->body;
    out_format(to, "%s: %s encoding\n", source_name(s), s->text ? "text" : "binary");
    for (int i = 0; i < m->metas; i++)
        put_line(i ? "" : "metadata\n", m->meta[i].key, m->meta[i].value, to);
    for (int i = 0; i < m->provs; i++)
        put_line(i ? "" : "provenance\n", NULL, m->prov[i], to);
    for (int i = 0; i < m->axis_count; i++)
        out_format(to, "%s%-22s %" PRId64 "\n", i ? "  " : "axes\n  ", m->axes[i].name, m->axes[i].count);
}

static void put_extent(const model *m, out *to)
{
    const model_array *position = model_find(m, "node.position");
    if (!position || !position->rows)
        return;
    out_text(to, "extent (m)\n");
    for (int32_t c = 0; c < 3; c++) {
        info_stats s = info_column_of(position, c);
        out_format(to, "  %c ", "xyz"[c]);
        put_short(s.min, MODEL_F64, to);
        out_text(to, " to ");
        put_short(s.max, MODEL_F64, to);
        out_text(to, "\n");
    }
}

/* The number in a row of a volume's array, or "-" where the model lacks the array. */
static void add_number(text_table *t, const model *m, const char *array, int64_t row)
{
    const model_array *a = model_find(m, array);
    if (a)
        text_table_cell(t, "%.0f", source_value(a, row));
    else
        text_table_cell(t, "-");
}

static int put_volumes(const model *m, const int64_t *elements, out *to, err *e)
{
    static const char *const heads[] = {"<volume", ">elements", ">level", ">priority", "<material", NULL};
    const model_array *name = model_find(m, "volume.name"), *of = model_find(m, "volume.material");
    const model_array *called = model_find(m, "material.name");
    if (!name || !name->rows)
        return 0;
    text_table *t = text_table_create(heads, e);
    for (int64_t i = 0; t && i < name->rows; i++) {
        text_table_cell(t, "%s", name->str[i]);
        text_table_count(t, elements[i]);
        add_number(t, m, "volume.level", i);
        add_number(t, m, "volume.priority", i);
        text_table_cell(t, "%s", of && called ? called->str[of->i32[i]] : "-");
    }
    out_text(to, "volumes\n");
    return text_table_put(t, to, e);
}

static int put_materials(const model *m, out *to, err *e)
{
    static const char *const heads[] = {"<material", "<law", "<keys", NULL};
    const model_array *name = model_find(m, "material.name"), *law = model_find(m, "material.law");
    char keys[MATERIAL_EDIT_WORDS];
    if (!name || !name->rows)
        return 0;
    text_table *t = text_table_create(heads, e);
    for (int64_t i = 0; t && i < name->rows; i++) {
        material_edit_words(m, i, keys);
        text_table_cell(t, "%s", name->str[i]);
        text_table_cell(t, "%s", law ? law->str[i] : "-");
        text_table_cell(t, "%s", keys);
    }
    out_text(to, "materials\n");
    return text_table_put(t, to, e);
}

static int put_muscles(const model *m, const int64_t *elements, out *to, err *e)
{
    const model_array *volume = model_find(m, "muscle.volume"), *name = model_find(m, "volume.name");
    const model_array *centre = model_find(m, "muscle.centre"), *fibre = model_find(m, "muscle.fibre");
    const char *const heads[] = {"<muscle", ">elements", ">centre x\nm", ">y\nm", ">z\nm", fibre ? "<fibres" : NULL,
                                 NULL};
    if (!volume || !name || !volume->rows)
        return 0;
    const int decimals = centre ? text_table_decimals(info_stats_of(centre).max, 5) : 0;
    text_table *t = text_table_create(heads, e);
    for (int64_t i = 0; t && i < volume->rows; i++) {
        text_table_cell(t, "%s", name->str[volume->i32[i]]);
        text_table_count(t, elements[volume->i32[i]]);
        for (int a = 0; a < 3; a++)
            text_table_number(t, centre ? centre->f64[3 * i + a] : NAN, decimals);
        if (fibre)
            text_table_cell(t, "%s", fibre->str[i]);
    }
    out_text(to, "muscles\n");
    return text_table_put(t, to, e);
}

/* Where the nodes went furthest in the last frame. */
static void put_displacement(const source *s, out *to)
{
    const model_array *u = frame_find(&s->frame, "node.displacement");
    const model_array *position = model_find(&s->body, "node.position");
    info_stats of = {.at_max = -1};
    if (u)
        of = info_stats_of(u);
    if (of.at_max < 0)
        return;
    out_text(to, "  largest displacement ");
    put_short(of.max, MODEL_F64, to);
    out_format(to, " m, node %" PRId64, of.at_max);
    if (position) {
        out_text(to, " at ");
        source_put_row(position, of.at_max, true, to);
    }
    out_text(to, "\n");
}

/* What is folded in the last frame, where anything is. */
static void put_folded(const source *s, out *to)
{
    quality q;
    char where[ELEMENT_PLACE];
    if (!info_quality_look(s, &q) || !q.folded)
        return;
    element_place_text(&s->body, q.element, where);
    out_format(to, "  folded elements %" PRId64 ", the worst ", q.folded);
    source_put_text(where, to);
    out_text(to, ": J ");
    put_short(q.worst, MODEL_F64, to);
    out_text(to, " at a corner\n");
}

static int put_frames(const source *s, const double *times, bool meanings, out *to, err *e)
{
    if (!s->frames) {
        out_text(to, "frames  none\n");
        return 0;
    }
    out_format(to, "frames  %" PRId64 ", the last of index %" PRId64 "; times ", s->frames, s->frame.index);
    put_short(times[0], MODEL_F64, to);
    out_text(to, " to ");
    put_short(times[1], MODEL_F64, to);
    out_text(to, " s; in the last\n");
    if (put_arrays(&s->frame.arrays, meanings, to, e))
        return -1;
    put_displacement(s, to);
    put_folded(s, to);
    return 0;
}

static int put_summary(const source *s, const double *times, const int64_t *elements, bool meanings, out *to, err *e)
{
    const model *m = &s->body;
    put_head(s, to);
    if (m->arrays.count) {
        out_text(to, "arrays\n");
        if (put_arrays(&m->arrays, meanings, to, e))
            return -1;
    }
    for (int i = 0; i < m->block_count; i++)
        out_format(to, "%s%s %" PRIu64 " bytes\n", i ? "  " : "unknown blocks\n  ", m->blocks[i].type,
                   m->blocks[i].length);
    put_extent(m, to);
    if (put_materials(m, to, e) || put_volumes(m, elements, to, e) || put_muscles(m, elements, to, e))
        return -1;
    return put_frames(s, times, meanings, to, e);
}

/* Reads frames to the end of the stream; times: of the first and of the last. */
static int read_all(source *s, double *times, err *e)
{
    int got;
    while ((got = source_next(s, e)) > 0) {
        times[0] = s->frames == 1 ? s->frame.time : times[0];
        times[1] = s->frame.time;
    }
    return got;
}

/* A value is a line, a list of names as many as there are. */
static int put_key(const source *s, info_quality_seen *seen, const char *typed, out *to, err *e)
{
    char british[INFO_KEY];
    const char *key = info_key_spelled(s, typed, british);
    int other = info_names(s, key, to, e);
    if (other <= 0)
        return other;
    if (info_key(s, seen, key, to, e))
        return -1;
    out_text(to, "\n");
    return 0;
}

/* Nothing is written before all of it is known to be right. */
static int put(const source *s, const double *times, const struct options *o, out *to, err *e)
{
    info_quality_seen seen = {0};
    for (int i = 0; i < o->get.count; i++)
        if (put_key(s, &seen, o->get.value[i], to, e))
            return -1;
    if (o->get.count)
        return 0;
    int64_t *elements = info_volume_counts(&s->body, e);
    int rc = elements ? 0 : -1;
    if (!rc && o->json)
        info_json(s, times, elements, to);
    else if (!rc)
        rc = put_summary(s, times, elements, o->common.verbose, to, e);
    free(elements);
    return rc;
}

/* A row a frame, as frames come. */
static int put_series(source *s, const opt_list *keys, out *to, err *e)
{
    info_series series = {0};
    int got;
    while ((got = source_next(s, e)) > 0)
        if (info_series_row(&series, s, keys, to, e))
            return -1;
    if (!got && !s->frames)
        return source_no_frame(s, NULL, e);
    return got;
}

/* All else is said of the whole stream, once it is known to be right. */
static int put_whole(source *s, const struct options *o, out *text, out *to, err *e)
{
    double times[2] = {NAN, NAN};
    size_t size;
    if (read_all(s, times, e) || put(s, times, o, text, e))
        return -1;
    const unsigned char *bytes = out_bytes(text, &size);
    out_write(to, bytes, size);
    return 0;
}

/* For completion: the lists of names that there are, of a body that is not checked. */
static int put_names(const source *s, const opt_list *keys, out *to, err *e)
{
    for (int i = 0; i < keys->count; i++)
        if (info_names(s, keys->value[i], to, e) < 0)
            return -1;
    return 0;
}

static int put_asked(source *s, const struct options *o, out *text, out *to, err *e)
{
    if (o->names)
        return put_names(s, &o->get, to, e);
    return o->tsv.count ? put_series(s, &o->tsv, to, e) : put_whole(s, o, text, to, e);
}

static int run_tool(int argc, char **argv)
{
    struct options o = {0};
    err e = {0};
    tool t = {0};
    source s = {0};
    out *text = NULL, *to = NULL;

    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done)
        goto out;
    if (o.json + (o.get.count > 0) + (o.tsv.count > 0) > 1) {
        err_usage(&e, "--json, --get and --tsv exclude each other; expected one of them");
        goto out;
    }
    const char *path = t.operands ? argv[1] : NULL;
    if (o.names ? source_open_names(&s, path, &e) : source_open_part(&s, path, o.salvage, &e))
        goto out;
    text = out_memory(&e);
    to = text ? out_open(o.common.output, false, &e) : NULL;
    if (!to || put_asked(&s, &o, text, to, &e))
        goto out;
out:
    if (text)
        out_close(text, &e);
    out_end(to, e.status, &e);
    source_end(&s, &e);
    source_close(&s);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
