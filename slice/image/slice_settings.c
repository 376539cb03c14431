#include "slice/image/slice_settings.h"

#include "base/near.h"

#include <stdio.h>
#include <string.h>

typedef struct setting {
    const char *key;
    int (*take)(slice_session *s, const char *key, const char *value, err *e);
    int (*apply)(slice_session *s, err *e);        /* NULL: nothing is to be made anew */
    void (*text)(const slice_session *s, out *to); /* its value, as a line would set it */
} setting;

/* ---- taking */

static int take_option(slice_session *s, const char *key, const char *value, err *e)
{
    return opt_set(&slice_table, key, value, &s->o, e) || slice_options_values(&s->o, e) ? -1 : 0;
}

/* Of an option whose value is a text: the session keeps it. */
static int keep_text(const char *key, const char *value, char to[SLICE_WORD], err *e)
{
    if (strlen(value) >= SLICE_WORD)
        return err_usage(e, "--%s %.60s...; expected fewer than %d bytes", key, value, SLICE_WORD);
    strcpy(to, value);
    return 0;
}

static int take_probe(slice_session *s, const char *key, const char *value, err *e)
{
    return keep_text(key, value, s->probe, e);
}

/* 0: one slice. */
static int take_thickness(slice_session *s, const char *key, const char *value, err *e)
{
    s->o.thickness = strcmp(value, "0") != 0 ? s->thickness : NULL;
    return keep_text(key, value, s->thickness, e);
}

/* 0: the array's. */
static int take_width(slice_session *s, const char *key, const char *value, err *e)
{
    s->o.width.count = 0;
    return strcmp(value, "0") != 0 ? take_option(s, key, value, e) : 0;
}

static int take_coupling(slice_session *s, const char *key, const char *value, err *e)
{
    if (s->o.rigid && strcmp(value, "0") != 0)
        return err_usage(e, "--%s %.60s with --rigid: there is no tissue that the face could touch", key, value);
    return take_option(s, key, value, e);
}

static int take_switch(const char *key, const char *value, bool *to, err *e)
{
    *to = !strcmp(value, "on");
    return *to || !strcmp(value, "off") ? 0 : err_usage(e, "--%s '%.60s': expected on or off", key, value);
}

static int take_labels(slice_session *s, const char *key, const char *value, err *e)
{
    if (!s->o.labels)
        return err_usage(e, "--%s %.60s without a label image; expected --labels FILE on the command line", key, value);
    return take_switch(key, value, &s->labels, e);
}

static int take_freeze(slice_session *s, const char *key, const char *value, err *e)
{
    return take_switch(key, value, &s->frozen, e);
}

/* What the overlay saw last is not shown. */
static int apply_labels(slice_session *s, err *e)
{
    (void)e;
    if (!s->labels)
        memset(s->overlay.seen, 0, (size_t)s->view.size.columns * (size_t)s->view.size.rows);
    return 0;
}

/* ---- telling */

static void put_number(double value, out *to)
{
    char text[NUM_TEXT];
    num_text(value, false, text);
    out_text(to, text);
}

static void put_numbers(const opt_numbers *list, out *to)
{
    for (int i = 0; i < list->count; i++) {
        out_text(to, i ? "," : "");
        put_number(list->value[i], to);
    }
}

static void put_gain(const slice_session *s, out *to)
{
    put_number(s->o.gain, to);
}

static void put_tgc(const slice_session *s, out *to)
{
    put_numbers(&s->o.tgc, to);
    out_text(to, s->o.tgc.count ? "" : "0");
}

static void put_range(const slice_session *s, out *to)
{
    put_numbers(&s->o.range, to);
    out_text(to, s->o.range.count ? "" : "60,60");
}

static void put_depth(const slice_session *s, out *to)
{
    put_number(slice_options_metres(&s->o.depth, SLICE_DEPTH), to);
}

static void put_width(const slice_session *s, out *to)
{
    put_number(slice_options_metres(&s->o.width, 0), to);
}

static void put_thickness(const slice_session *s, out *to)
{
    out_text(to, s->o.thickness ? s->o.thickness : "0");
}

static void put_coupling(const slice_session *s, out *to)
{
    put_number(slice_options_metres(&s->o.coupling, 0), to);
}

static void put_probe(const slice_session *s, out *to)
{
    out_text(to, s->probe);
}

static void put_switch(bool on, out *to)
{
    out_text(to, on ? "on" : "off");
}

static void put_labels(const slice_session *s, out *to)
{
    put_switch(s->labels, to);
}

static void put_freeze(const slice_session *s, out *to)
{
    put_switch(s->frozen, to);
}

/* ---- the table */

static const setting settings[] = {
    {"probe", take_probe, slice_session_set_view, put_probe},
    {"depth", take_option, slice_session_set_view, put_depth},
    {"width", take_width, slice_session_set_view, put_width},
    {"thickness", take_thickness, slice_session_set_thickness, put_thickness},
    {"coupling", take_coupling, slice_session_set_grey, put_coupling},
    {"gain", take_option, slice_session_set_grey, put_gain},
    {"tgc", take_option, slice_session_set_grey, put_tgc},
    {"dynamic-range", take_option, slice_session_set_grey, put_range},
    {"labels", take_labels, apply_labels, put_labels},
    {"freeze", take_freeze, NULL, put_freeze},
};

enum { SETTINGS = sizeof settings / sizeof *settings };

/* NULL with e filled. */
static const setting *find(const keyfile *k, err *e)
{
    const char *names[SETTINGS];
    for (int i = 0; i < SETTINGS; i++) {
        names[i] = settings[i].key;
        if (!strcmp(k->word[1], names[i]))
            return &settings[i];
    }
    near_unknown(e, k->name, k->line, "setting", k->word[1], names, SETTINGS);
    return NULL;
}

/* What the values of a session's settings are, to go back to. */
typedef struct values {
    slice_options o;
    char probe[SLICE_WORD], thickness[SLICE_WORD];
    bool labels, frozen;
} values;

static values values_of(const slice_session *s)
{
    values v = {.o = s->o, .labels = s->labels, .frozen = s->frozen};
    memcpy(v.probe, s->probe, sizeof v.probe);
    memcpy(v.thickness, s->thickness, sizeof v.thickness);
    return v;
}

static void go_back(slice_session *s, const values *v)
{
    s->o = v->o;
    s->labels = v->labels;
    s->frozen = v->frozen;
    memcpy(s->probe, v->probe, sizeof v->probe);
    memcpy(s->thickness, v->thickness, sizeof v->thickness);
}

int slice_settings_take(slice_session *s, const keyfile *k, err *e)
{
    err wrong = {0};
    if (strcmp(k->word[0], "set") != 0 || k->count != 3)
        return keyfile_error(k, e, "'%.60s' with %d words; expected set KEY VALUE", k->word[0], k->count - 1);
    const setting *is = find(k, e);
    if (!is)
        return -1;
    const values before = values_of(s);
    if (!is->take(s, is->key, k->word[2], &wrong) && (!is->apply || !is->apply(s, &wrong)))
        return 0;
    go_back(s, &before);
    /* Options' errors begin with the dashes of one. */
    return err_set_as(e, wrong.form, k->name, k->line, wrong.text + (strncmp(wrong.text, "--", 2) ? 0 : 2));
}

void slice_settings_record(const slice_session *s, record *r)
{
    for (int i = 0; i < SETTINGS; i++) {
        err ignored = {0};
        size_t size;
        const bool none =
            (settings[i].take == take_labels && !s->o.labels) || (settings[i].take == take_coupling && s->o.rigid);
        out *text = none ? NULL : out_memory(&ignored);
        if (!text)
            continue;
        settings[i].text(s, text);
        const unsigned char *bytes = out_bytes(text, &size);
        record_setting(r, "set %s %.*s", settings[i].key, (int)size, (const char *)bytes);
        out_discard(text);
    }
}
