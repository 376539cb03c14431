/* sinew-diff: where two models differ. Streaming: two bodies and one frame of each are in memory at a time. */
#include "base/num.h"
#include "cli/spelling.h"
#include "cli/tool.h"
#include "model/known.h"
#include "model/source.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

struct options {
    opt_common common;
    opt_list abs, rel, only;
};

#define TO(field) offsetof(struct options, field)
static const opt option_table[] = {
    {OPT_ACTION, 0, "abs", "[ARRAY=]A", OPT_LIST, TO(abs), 0, 0, "@array.name=|node.displacement=|node.velocity=", 0,
     "equal if |a - b| <= A, e.g. 1e-6 or 1um [default 0]"},
    {OPT_ACTION, 0, "rel", "[ARRAY=]R", OPT_LIST, TO(rel), 0, 0, "@array.name=|node.displacement=|node.velocity=", 0,
     "equal if |a - b| <= R max(|a|, |b|) [default 0]"},
    {OPT_ACTION, 0, "only", "ARRAY,...", OPT_LIST, TO(only), 0, 0, "@array.name|node.displacement|node.velocity", 0,
     "compare only these arrays"},
    {0}};

static const opt_tool table = {
    .name = "sinew-diff",
    .command = "sinew diff",
    .usage = "[options] A B",
    .purpose = "Compares two models. The exit status is 0 if they are equal, 1 if they differ,\nand 2 if they cannot "
               "be compared.",
    .example = "sinew diff --abs node.displacement=1um before.sinew after.sinew",
    .operands = "A B",
    .operands_min = 2,
    .operands_max = 2,
    .options = option_table,
};

enum { SAME = 0, DIFFERENT = 1, TROUBLE = 2, RULES = 64 };

/* "ARRAY=NUMBER" or "NUMBER" (name "": every array of floats; those that are lengths, where it has a unit), or a name
 * of --only. */
typedef struct rule {
    char name[MODEL_NAME], british[MODEL_NAME]; /* in British spelling, if an array is named so; else "" */
    num_length value;                           /* unit 0: in the array's */
    bool seen;                                  /* an array of this name was met */
} rule;

typedef struct rules {
    rule v[RULES];
    int count;
} rules;

typedef struct diff {
    rules abs, rel, only;
    source a, b;
    out *to;
    bool different;
    int64_t compared; /* arrays that both have, a frame's each time */
    int64_t frame;    /* 0: the body; else the number of the frame */
} diff;

/* What was found in one array. */
typedef struct finding {
    int64_t rows, first; /* rows that differ, and the first of them */
    double abs, rel;     /* the largest differences; nan where a value has no difference to another */
} finding;

static int add_rule(rules *r, const char *name, size_t length, num_length value, err *e)
{
    if (r->count == RULES || length >= MODEL_NAME)
        return err_usage(e, "too many arrays or too long a name; expected at most %d", RULES);
    rule *new = &r->v[r->count++];
    *new = (rule){.value = value};
    snprintf(new->name, sizeof new->name, "%.*s", (int)length, name);
    if (!spelling_british(name, length, new->british, sizeof new->british) || !known_find(new->british))
        new->british[0] = 0;
    return 0;
}

/* lengths: a unit is taken. */
static int read_tolerances(const opt_list *list, const char *option, bool lengths, rules *r, err *e)
{
    for (int i = 0; i < list->count; i++) {
        const char *text = list->value[i], *equals = strrchr(text, '='), *number = equals ? equals + 1 : text;
        num_length value = {0};
        if ((lengths ? num_length_of(number, &value) : num_double(number, &value.value)) || value.value < 0 ||
            equals == text)
            return err_usage(e, "%s '%s': expected a number from 0 on%s, or ARRAY=NUMBER", option, text,
                             lengths ? ", which may have a unit of length" : "");
        if (add_rule(r, text, equals ? (size_t)(equals - text) : 0, value, e))
            return -1;
    }
    return 0;
}

static int read_only(const opt_list *list, rules *r, err *e)
{
    for (int i = 0; i < list->count; i++)
        for (const char *p = list->value[i]; p;) {
            size_t n = strcspn(p, ",");
            if (!n)
                return err_usage(e, "--only '%s': expected names of arrays between commas", list->value[i]);
            if (add_rule(r, p, n, (num_length){0}, e))
                return -1;
            p = p[n] ? p + n + 1 : NULL;
        }
    return 0;
}

/* The rule for the array: its own, else (tolerances) the last one for all that its unit allows. NULL: none. */
static const rule *rule_for(rules *r, const model_array *a)
{
    const rule *general = NULL;
    for (int i = r->count; i-- > 0;) {
        if (!strcmp(r->v[i].name, a->name) || !strcmp(r->v[i].british, a->name)) {
            r->v[i].seen = true;
            return &r->v[i];
        }
        if (!r->v[i].name[0] && !general && (!r->v[i].value.unit || num_unit_of(a->unit)))
            general = &r->v[i];
    }
    return general;
}

/* The tolerance in the array's unit; 0 without a rule. -1: e filled. */
static int tolerance(const rule *r, const model_array *a, double *to, err *e)
{
    const num_unit own = num_unit_of(a->unit);
    *to = 0;
    if (r && r->value.unit && !own)
        return err_usage(e, "--abs '%s=%g%s': its unit is %s, not a length; expected a number in that unit", a->name,
                         r->value.value, num_unit_name(r->value.unit), a->unit);
    if (r)
        *to = r->value.unit ? num_length_in(r->value, own, own) : r->value.value;
    return 0;
}

/* Begins a line of the report. */
static void say_place(diff *d)
{
    d->different = true;
    if (d->frame)
        out_format(d->to, "frame %" PRId64 ": ", d->frame);
}

/* "a: VALUE, b: VALUE"; NULL: it has none. */
static void say_texts(diff *d, const char *kind, const char *name, const char *a, const char *b)
{
    say_place(d);
    if (a && b) {
        out_format(d->to, "%s %s: '", kind, name);
        source_put_text(a, d->to);
        out_text(d->to, "' and '");
        source_put_text(b, d->to);
        out_text(d->to, "'\n");
    } else
        out_format(d->to, "%s %s: only in %s\n", kind, name, source_name(a ? &d->a : &d->b));
}

static void compare_meta(diff *d)
{
    const model *a = &d->a.body, *b = &d->b.body;
    for (int i = 0; i < a->metas; i++) {
        const char *other = model_meta_of(b, a->meta[i].key);
        if (!other || strcmp(a->meta[i].value, other) != 0)
            say_texts(d, "meta", a->meta[i].key, a->meta[i].value, other);
    }
    for (int i = 0; i < b->metas; i++)
        if (!model_meta_of(a, b->meta[i].key))
            say_texts(d, "meta", b->meta[i].key, NULL, b->meta[i].value);
}

static void compare_axes(diff *d)
{
    const model *a = &d->a.body, *b = &d->b.body;
    for (int i = 0; i < a->axis_count; i++) {
        int64_t other = model_count(b, a->axes[i].name);
        if (other == a->axes[i].count)
            continue;
        if (other < 0) {
            say_texts(d, "axis", a->axes[i].name, "", NULL);
            continue;
        }
        say_place(d);
        out_format(d->to, "axis %s: %" PRId64 " and %" PRId64 "\n", a->axes[i].name, a->axes[i].count, other);
    }
    for (int i = 0; i < b->axis_count; i++)
        if (model_count(a, b->axes[i].name) < 0)
            say_texts(d, "axis", b->axes[i].name, NULL, "");
}

static void compare_blocks(diff *d)
{
    const model *a = &d->a.body, *b = &d->b.body;
    bool same = a->block_count == b->block_count;
    for (int i = 0; same && i < a->block_count; i++) {
        const model_block *p = &a->blocks[i], *q = &b->blocks[i];
        same = !strcmp(p->type, q->type) && p->flags == q->flags && p->length == q->length &&
               !memcmp(p->payload, q->payload, p->length);
    }
    if (!same) {
        say_place(d);
        out_text(d->to, "blocks of unknown types differ\n");
    }
}

static bool equal_floats(double a, double b, double most_abs, double most_rel)
{
    if (a == b || (isnan(a) && isnan(b)))
        return true;
    double off = fabs(a - b);
    return isfinite(off) && (off <= most_abs || off <= most_rel * fmax(fabs(a), fabs(b)));
}

static bool equal_values(const model_array *a, const model_array *b, int64_t at, double most_abs, double most_rel)
{
    switch (a->type) {
    case MODEL_STR:
        return !strcmp(a->str[at], b->str[at]);
    case MODEL_I64:
        return a->i64[at] == b->i64[at];
    case MODEL_I32:
    case MODEL_U8:
        return source_value(a, at) == source_value(b, at);
    default:
        return equal_floats(source_value(a, at), source_value(b, at), most_abs, most_rel);
    }
}

/* How far apart two values are: nan or inf where one is not finite. */
static void measure(finding *f, double a, double b)
{
    double off = fabs(a - b), size = fmax(fabs(a), fabs(b));
    if (a == b || (isnan(a) && isnan(b)))
        return;
    const double share = isinf(off) ? INFINITY : off / size;
    f->abs = isnan(off) || isnan(f->abs) ? NAN : fmax(f->abs, off);
    f->rel = isnan(off) || isnan(f->rel) ? NAN : fmax(f->rel, share);
}

static finding compare_rows(const model_array *a, const model_array *b, double most_abs, double most_rel)
{
    finding f = {.first = -1};
    for (int64_t i = 0; i < a->rows; i++) {
        bool same = true;
        for (int64_t at = i * a->columns; at < (i + 1) * a->columns; at++) {
            same = same && equal_values(a, b, at, most_abs, most_rel);
            if (a->type != MODEL_STR)
                measure(&f, source_value(a, at), source_value(b, at));
        }
        if (!same && !f.rows++)
            f.first = i;
    }
    return f;
}

static void say_finding(diff *d, const model_array *a, const model_array *b, const finding *f)
{
    char most_abs[NUM_TEXT], most_rel[NUM_TEXT];
    say_place(d);
    out_format(d->to, "%s: %" PRId64 " of %" PRId64 " rows differ, the first row %" PRId64 ": ", a->name, f->rows,
               a->rows, f->first);
    source_put_row(a, f->first, true, d->to);
    out_text(d->to, " and ");
    source_put_row(b, f->first, true, d->to);
    if (a->type != MODEL_STR) {
        num_text(f->abs, true, most_abs);
        num_text(f->rel, true, most_rel);
        out_format(d->to, "; largest difference %s, relative %s", most_abs, most_rel);
    }
    out_text(d->to, "\n");
}

/* Whether the two can be compared value by value; says so where they cannot. What is stored as f32 is compared with f64
 * where a tolerance is given. */
static bool alike(diff *d, const model_array *a, const model_array *b, bool roughly)
{
    if (a->type == b->type && (roughly || a->narrow == b->narrow) && a->columns == b->columns && a->rows == b->rows &&
        !strcmp(a->unit, b->unit) && !strcmp(a->axis, b->axis))
        return true;
    say_place(d);
    out_format(d->to, "%s: %s %s %s %d, %" PRId64 " rows and %s %s %s %d, %" PRId64 " rows\n", a->name,
               model_type_name(model_stored(a)), a->unit, a->axis, (int)a->columns, a->rows,
               model_type_name(model_stored(b)), b->unit, b->axis, (int)b->columns, b->rows);
    return false;
}

/* Either may be NULL. -1: a tolerance was given by name for an array that has none. */
static int compare_array(diff *d, const model_array *a, const model_array *b, err *e)
{
    const model_array *one = a ? a : b;
    double most_abs, most_rel;
    if (d->only.count && !rule_for(&d->only, one))
        return 0;
    const rule *by_abs = rule_for(&d->abs, one), *by_rel = rule_for(&d->rel, one);
    bool floats = one->type == MODEL_F32 || one->type == MODEL_F64;
    if (!floats && ((by_abs && by_abs->name[0]) || (by_rel && by_rel->name[0])))
        return err_set(e, NULL, 0, "%s is of type %s: a tolerance is for f32 and f64", one->name,
                       model_type_name(one->type));
    if (tolerance(by_abs, one, &most_abs, e) || tolerance(by_rel, one, &most_rel, e))
        return -1;
    if (!a || !b) {
        const char *left = a ? "" : NULL;
        say_texts(d, "array", one->name, left, b ? "" : NULL);
        return 0;
    }
    if (!alike(d, a, b, most_abs > 0 || most_rel > 0))
        return 0;
    d->compared++;
    finding f = compare_rows(a, b, most_abs, most_rel);
    if (f.rows)
        say_finding(d, a, b, &f);
    return 0;
}

static int compare_arrays(diff *d, const model_arrays *a, const model_arrays *b, err *e)
{
    for (int i = 0; i < a->count; i++)
        if (compare_array(d, &a->v[i], model_arrays_find(b, a->v[i].name), e))
            return -1;
    for (int i = 0; i < b->count; i++)
        if (!model_arrays_find(a, b->v[i].name) && compare_array(d, NULL, &b->v[i], e))
            return -1;
    return 0;
}

static void compare_times(diff *d)
{
    char a[NUM_TEXT], b[NUM_TEXT];
    if (d->a.frame.index != d->b.frame.index) {
        say_place(d);
        out_format(d->to, "index %" PRId64 " and %" PRId64 "\n", d->a.frame.index, d->b.frame.index);
    }
    if (d->a.frame.time != d->b.frame.time && !(isnan(d->a.frame.time) && isnan(d->b.frame.time))) {
        num_text(d->a.frame.time, false, a);
        num_text(d->b.frame.time, false, b);
        say_place(d);
        out_format(d->to, "time %s and %s s\n", a, b);
    }
}

/* Whether a frame that only one model has counts: always, or where it has one of the arrays asked for. */
static bool counts(diff *d, const frame *f)
{
    bool any = !d->only.count;
    for (int i = 0; i < f->arrays.count; i++)
        any = rule_for(&d->only, &f->arrays.v[i]) || any;
    return any;
}

/* Both streams are read to their ends, since a stream may end with a failure. */
static int compare_frames(diff *d, err *e)
{
    int64_t extra[2] = {0, 0};
    bool more[2] = {true, true};
    while (more[0] || more[1]) {
        for (int i = 0; i < 2; i++)
            if (more[i]) {
                int got = source_next(i ? &d->b : &d->a, e);
                if (got < 0)
                    return -1;
                more[i] = got;
            }
        d->frame++;
        if (more[0] && more[1]) {
            if (!d->only.count)
                compare_times(d);
            if (compare_arrays(d, &d->a.frame.arrays, &d->b.frame.arrays, e))
                return -1;
        } else {
            extra[0] += more[0] && counts(d, &d->a.frame);
            extra[1] += more[1] && counts(d, &d->b.frame);
        }
    }
    if (extra[0] || extra[1]) {
        d->different = true;
        out_format(d->to, "frames: %" PRId64 " and %" PRId64 "\n", d->a.frames, d->b.frames);
    }
    return 0;
}

/* A name that neither model has is a slip, and a comparison that passes for it would be worth nothing. */
static int check_seen(const diff *d, const rules *r, const char *option, err *e)
{
    for (int i = 0; i < r->count; i++)
        if (r->v[i].name[0] && !r->v[i].seen)
            return err_set(e, NULL, 0, "%s %s: neither %s nor %s has such an array", option, r->v[i].name,
                           source_name(&d->a), source_name(&d->b));
    return 0;
}

static int compare(diff *d, err *e)
{
    if (!d->only.count) {
        compare_meta(d);
        compare_axes(d);
        compare_blocks(d);
    }
    return compare_arrays(d, &d->a.body.arrays, &d->b.body.arrays, e) || compare_frames(d, e) ||
                   check_seen(d, &d->only, "--only", e) || check_seen(d, &d->abs, "--abs", e) ||
                   check_seen(d, &d->rel, "--rel", e)
               ? -1
               : 0;
}

static int open_both(diff *d, char *const *path, err *e)
{
    if (!strcmp(path[0], "-") && !strcmp(path[1], "-"))
        return err_usage(e, "both operands are standard input; expected one file at least");
    return source_open(&d->a, path[0], e) || source_open(&d->b, path[1], e) ? -1 : 0;
}

static int run_tool(int argc, char **argv)
{
    struct options o = {0};
    err e = {0};
    tool t = {0};
    diff d = {0};
    out *report = NULL;
    size_t size;

    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done)
        goto out;
    if (read_tolerances(&o.abs, "--abs", true, &d.abs, &e) || read_tolerances(&o.rel, "--rel", false, &d.rel, &e) ||
        read_only(&o.only, &d.only, &e))
        goto out;
    if (open_both(&d, argv + 1, &e) || !(d.to = out_memory(&e)) || compare(&d, &e))
        goto out;
    tool_detail(&t, "%" PRId64 " arrays compared; frames: %" PRId64 " and %" PRId64, d.compared, d.a.frames,
                d.b.frames);
    report = out_open(o.common.output, false, &e);
    if (!report)
        goto out;
    const unsigned char *bytes = out_bytes(d.to, &size);
    if (!o.common.quiet)
        out_write(report, bytes, size);
out:
    if (d.to)
        out_close(d.to, &e);
    if (e.status)
        out_discard(report);
    else if (report)
        out_close(report, &e);
    source_close(&d.a);
    source_close(&d.b);
    int status = tool_end(&t, &e);
    if (status)
        return TROUBLE;
    return d.different ? DIFFERENT : SAME;
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
