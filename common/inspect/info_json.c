#include "inspect/info_json.h"

#include "base/num.h"
#include "inspect/info_key.h"
#include "inspect/info_quality.h"
#include "inspect/info_stats.h"
#include "model/known.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static void put_string(const char *text, out *to)
{
    out_text(to, "\"");
    for (const unsigned char *p = (const unsigned char *)text; *p; p++)
        if (*p == '"' || *p == '\\')
            out_format(to, "\\%c", *p);
        else if (*p < 0x20 || *p == 0x7f)
            out_format(to, "\\u%04x", *p);
        else
            out_write(to, p, 1);
    out_text(to, "\"");
}

static void put_number(double value, model_type from, out *to)
{
    if (isfinite(value))
        info_put_number(value, from, to);
    else
        out_text(to, "null");
}

static void put_value(const model_array *a, int64_t at, out *to)
{
    if (isfinite(source_value(a, at)))
        info_put_value(a, at, to);
    else
        out_text(to, "null");
}

static void put_end(const model_array *a, const info_stats *s, bool max, out *to)
{
    if (isfinite(max ? s->max : s->min))
        info_put_end(a, s, max, to);
    else
        out_text(to, "null");
}

/* ", " between members, nothing before the first. */
static void put_comma(bool first, out *to)
{
    out_text(to, first ? "" : ", ");
}

static void put_member(const char *name, const char *value, out *to)
{
    out_format(to, "\"%s\": ", name);
    put_string(value, to);
}

static void put_array(const model_array *a, out *to)
{
    const known *k = known_find(a->name);
    out_text(to, "    {");
    put_member("name", a->name, to);
    out_text(to, ", ");
    put_member("type", model_type_name(model_stored(a)), to);
    out_text(to, ", ");
    put_member("unit", a->unit, to);
    out_text(to, ", ");
    put_member("axis", a->axis, to);
    out_format(to, ", \"rows\": %" PRId64 ", \"columns\": %d", a->rows, (int)a->columns);
    if (a->type != MODEL_STR) {
        info_stats s = info_stats_of(a);
        out_text(to, ", \"min\": ");
        put_end(a, &s, false, to);
        out_text(to, ", \"max\": ");
        put_end(a, &s, true, to);
        out_format(to, ", \"nan\": %" PRId64, s.nans);
    }
    if (k) {
        out_text(to, ", ");
        put_member("meaning", k->meaning, to);
    }
    out_text(to, "}");
}

static void put_arrays(const model_arrays *list, out *to)
{
    out_text(to, "[");
    for (int i = 0; i < list->count; i++) {
        out_text(to, i ? ",\n" : "\n");
        put_array(&list->v[i], to);
    }
    out_text(to, list->count ? "\n  ]" : "]");
}

/* One row of a table as an object of its columns (their names less "axis."); of a volume, its elements too. */
static void put_row(const model *m, const char *axis, int64_t row, const int64_t *elements, out *to)
{
    size_t n = strlen(axis);
    bool first = true;
    for (int i = 0; i < m->arrays.count; i++) {
        const model_array *a = &m->arrays.v[i];
        if (strcmp(a->axis, axis) != 0 || strncmp(a->name, axis, n) != 0 || a->name[n] != '.')
            continue;
        put_comma(first, to);
        first = false;
        put_string(a->name + n + 1, to);
        out_text(to, a->columns == 1 ? ": " : ": [");
        for (int32_t c = 0; c < a->columns; c++) {
            put_comma(!c, to);
            if (a->type == MODEL_STR)
                put_string(a->str[row * a->columns + c], to);
            else
                put_value(a, row * a->columns + c, to);
        }
        out_text(to, a->columns == 1 ? "" : "]");
    }
    if (!strcmp(axis, "volume")) {
        put_comma(first, to);
        out_format(to, "\"elements\": %" PRId64, elements[row]);
    }
}

static void put_table(const model *m, const char *axis, const int64_t *elements, out *to)
{
    int64_t rows = info_table_rows(m, axis);
    out_format(to, "  \"%s\": [", axis);
    for (int64_t i = 0; i < rows; i++) {
        out_text(to, i ? ",\n    {" : "\n    {");
        put_row(m, axis, i, elements, to);
        out_text(to, "}");
    }
    out_text(to, rows > 0 ? "\n  ],\n" : "],\n");
}

static void put_head(const source *s, out *to)
{
    const model *m = &s->body;
    out_format(to, "  \"encoding\": \"%s\",\n  \"meta\": {", s->text ? "text" : "binary");
    for (int i = 0; i < m->metas; i++) {
        put_comma(!i, to);
        put_string(m->meta[i].key, to);
        out_text(to, ": ");
        put_string(m->meta[i].value, to);
    }
    out_text(to, "},\n  \"provenance\": [");
    for (int i = 0; i < m->provs; i++) {
        put_comma(!i, to);
        put_string(m->prov[i], to);
    }
    out_text(to, "],\n  \"axes\": {");
    for (int i = 0; i < m->axis_count; i++) {
        put_comma(!i, to);
        put_string(m->axes[i].name, to);
        out_format(to, ": %" PRId64, m->axes[i].count);
    }
    out_text(to, "},\n");
}

/* What is folded in the last frame, where anything is. */
static void put_folded(const source *s, out *to)
{
    quality q;
    if (!info_quality_look(s, &q) || !q.folded)
        return;
    out_format(to, ", \"quality\": {\"folded\": %" PRId64 ", \"element\": %" PRId64 ", \"j.centre\": ", q.folded,
               q.element);
    put_number(q.centre, MODEL_F64, to);
    out_text(to, ", \"j.corner\": ");
    put_number(q.corner, MODEL_F64, to);
    out_text(to, "}");
}

void info_json(const source *s, const double *times, const int64_t *elements, out *to)
{
    out_text(to, "{\n");
    put_head(s, to);
    out_text(to, "  \"arrays\": ");
    put_arrays(&s->body.arrays, to);
    out_text(to, ",\n");
    put_table(&s->body, "volume", elements, to);
    put_table(&s->body, "material", elements, to);
    put_table(&s->body, "muscle", elements, to);
    out_format(to, "  \"frames\": %" PRId64 ",\n  \"first\": ", s->frames);
    if (s->frames) {
        out_text(to, "{\"time\": ");
        put_number(times[0], MODEL_F64, to);
        out_format(to, "},\n  \"last\": {\"index\": %" PRId64 ", \"time\": ", s->frame.index);
        put_number(times[1], MODEL_F64, to);
        out_text(to, ", \"arrays\": ");
        put_arrays(&s->frame.arrays, to);
        put_folded(s, to);
        out_text(to, "}\n}\n");
    } else {
        out_text(to, "null,\n  \"last\": null\n}\n");
    }
}
