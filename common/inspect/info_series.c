#include "inspect/info_series.h"

#include "inspect/info_key.h"
#include "inspect/info_stats.h"

#include <inttypes.h>
#include <string.h>

/* A value's text, spaces made tabs. Returns how many values they are, or -1 with e filled. */
static int put_values(info_series *series, const source *s, const char *key, out *to, err *e)
{
    size_t size;
    int count = 1;
    out *text = out_memory(e);
    if (!text)
        return -1;
    if (info_key(s, &series->seen, key, text, e)) {
        out_discard(text);
        return -1;
    }
    const unsigned char *bytes = out_bytes(text, &size);
    out_text(to, "\t");
    for (size_t i = 0; i < size; i++) {
        count += bytes[i] == ' ';
        out_write(to, bytes[i] == ' ' ? (const unsigned char *)"\t" : bytes + i, 1);
    }
    out_discard(text);
    return count;
}

/* The key, its part and its unit: node.displacement.max/m, node.displacement.at.0,0,0.x/m, ... */
static void put_names(const char *key, const char *unit, int values, out *to)
{
    for (int i = 0; i < values; i++) {
        out_text(to, "\t");
        source_put_text(key, to);
        if (values == 3)
            out_format(to, ".%c", "xyz"[i]);
        else if (values > 1)
            out_format(to, ".%d", i);
        if (*unit && strcmp(unit, "1") != 0)
            out_format(to, "/%s", unit);
    }
}

/* How many values each key has; what has none is refused. */
static int put_heading(info_series *series, const source *s, const opt_list *keys, out *to, err *e)
{
    out *nothing = out_memory(e);
    if (!nothing)
        return -1;
    int failed = 0;
    out_text(to, "frame\ttime/s");
    for (int i = 0; i < keys->count && !failed; i++) {
        char british[INFO_KEY];
        const char *key = info_key_spelled(s, keys->value[i], british), *unit = info_key_unit(s, key, e);
        series->values[i] = unit ? put_values(series, s, key, nothing, e) : -1;
        if (series->values[i] > 0)
            put_names(key, unit, series->values[i], to);
        else
            failed = -1;
    }
    out_text(to, "\n");
    out_discard(nothing);
    return failed;
}

int info_series_row(info_series *series, const source *s, const opt_list *keys, out *to, err *e)
{
    if (s->frames == 1 && put_heading(series, s, keys, to, e))
        return -1;
    out_format(to, "%" PRId64 "\t", s->frame.index);
    info_put_number(s->frame.time, MODEL_F64, to);
    for (int i = 0; i < keys->count; i++) {
        char british[INFO_KEY];
        const char *key = info_key_spelled(s, keys->value[i], british);
        if (!info_key_unit(s, key, e))
            return -1;
        int values = put_values(series, s, key, to, e);
        if (values < 0)
            return -1;
        if (values != series->values[i])
            return err_set(e, source_name(s), 0, "frame %" PRId64 ": '%.80s' has %d values; expected %d, as before",
                           s->frame.index, key, values, series->values[i]);
    }
    out_text(to, "\n");
    out_flush(to);
    return out_failed(to, e);
}
