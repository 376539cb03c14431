#include "tled/muscle/muscles.h"
#include "tled/problem/script_reader.h"

#include "base/mem.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *script_place(const script *s, const script_curve *c)
{
    static const char option[] = "-c";
    if (c->from == SCRIPT_OF_OPTION)
        return option;
    return c->from == SCRIPT_OF_FILE ? s->file : s->track;
}

/* ---- Curves of muscles and of expressions */

static int add_term(script *s, int64_t contract, int64_t express, double factor, err *e)
{
    if (mem_grow(&s->term, &s->term_capacity, s->terms + 1, sizeof *s->term, "the script's expressions", e))
        return -1;
    s->term[s->terms] = (script_term){contract, express, factor, s->curve[contract].term};
    s->curve[contract].term = ++s->terms;
    return 0;
}

/* The muscles of an expression whose curve is there. A muscle without a curve gets one that has no keys. */
static int add_terms(script *s, const model *m, int64_t express, bool all, err *e)
{
    const expression *x = &s->expressions->list[s->curve[express].volume];
    for (int64_t i = x->first; i < x->first + x->count; i++) {
        const expression_part *part = &s->expressions->part[i];
        const script_curve muscle = {.verb = SCRIPT_CONTRACT,
                                     .volume = part->volume,
                                     .line = s->curve[express].line,
                                     .from = s->curve[express].from,
                                     .target = model_find(m, "volume.name")->str[part->volume]};
        int64_t at = script_find(s, &muscle);
        if (at < 0 && !all)
            continue;
        if (at < 0)
            at = script_add(s, &muscle, e);
        if (at < 0 || add_term(s, at, express, part->level, e))
            return -1;
    }
    return 0;
}

int64_t script_add_levels(script *s, const model *m, const script_curve *c, bool all, err *e)
{
    const int64_t there = script_find(s, c), at = there < 0 ? script_add(s, c, e) : there;
    if (at < 0 || there >= 0 || c->verb != SCRIPT_EXPRESS)
        return at;
    return add_terms(s, m, at, all, e) ? -1 : at;
}

/* ---- Levels */

/* The slope (1/s) of a smooth curve at its key i: Fritsch and Butland's mean of those beside it, with which it rises
 * and falls only as its keys do; flat at its ends. */
static double slope_at(const script *s, const script_curve *c, int32_t i)
{
    const double *t = s->time + c->key_first + i, *v = s->value + 3 * ((int64_t)c->key_first + i);
    if (i == 0 || i == c->key_count - 1)
        return 0;
    const double before = t[0] - t[-1], after = t[1] - t[0];
    const double fell = (v[0] - v[-3]) / before, rose = (v[3] - v[0]) / after;
    if (!(fell * rose > 0))
        return 0;
    const double w = 2 * after + before, u = after + 2 * before;
    return (w + u) / (w / fell + u / rose);
}

/* Between keys low - 1 and low: c[0] + c[1] s + ..., s since the first of them. */
static void smooth_cubic(const script *s, const script_curve *of, int32_t low, double c[4])
{
    const double *t = s->time + of->key_first + low, *v = s->value + 3 * ((int64_t)of->key_first + low);
    const double h = t[0] - t[-1], rise = (v[0] - v[-3]) / h;
    const double from = slope_at(s, of, low - 1), to = slope_at(s, of, low);
    c[0] = v[-3];
    c[1] = from;
    c[2] = (3 * rise - 2 * from - to) / h;
    c[3] = (from + to - 2 * rise) / (h * h);
}

double script_smooth(const script *s, const script_curve *c, int32_t low, double time)
{
    const double *v = s->value + 3 * ((int64_t)c->key_first + low);
    const double since = time - s->time[c->key_first + low - 1];
    double k[4];
    smooth_cubic(s, c, low, k);
    const double value = k[0] + since * (k[1] + since * (k[2] + since * k[3]));
    return fmin(fmax(value, fmin(v[-3], v[0])), fmax(v[-3], v[0]));
}

void script_add_span(const script *s, const script_curve *c, double factor, activation_span *span)
{
    const int32_t low = script_keys(s, c, span->from);
    const double *t = s->time + c->key_first, *v = s->value + 3 * (int64_t)c->key_first;
    double k[4] = {0};
    if (low == 0)
        return;
    const double since = span->from - t[low - 1];
    if (low == c->key_count) {
        k[0] = v[3 * (low - 1)];
    } else if (c->is_smooth) {
        smooth_cubic(s, c, low, k);
    } else {
        k[0] = v[3 * (low - 1)];
        k[1] = (v[3 * low] - v[3 * (low - 1)]) / (t[low] - t[low - 1]);
    }
    /* The same about the span's beginning. */
    span->c[0] += factor * (k[0] + since * (k[1] + since * (k[2] + since * k[3])));
    span->c[1] += factor * (k[1] + since * (2 * k[2] + since * 3 * k[3]));
    span->c[2] += factor * (k[2] + since * 3 * k[3]);
    span->c[3] += factor * k[3];
}

static double sum_at(const script *s, int64_t curve, double time)
{
    double value[3], more[3];
    script_value(s, &s->curve[curve], time, value);
    for (int64_t i = s->curve[curve].term; i; i = s->term[i - 1].next) {
        script_value(s, &s->curve[s->term[i - 1].express], time, more);
        value[0] += s->term[i - 1].factor * more[0];
    }
    return value[0];
}

double script_level_at(const script *s, int64_t curve, double time)
{
    return fmin(sum_at(s, curve, time), 1);
}

void script_muscle_values(const script *s, double time, double *value)
{
    const bool follows = s->times.rise > 0;
    for (int64_t i = 0; i < s->terms && !follows; i++)
        value[3 * s->term[i].contract] += s->term[i].factor * value[3 * s->term[i].express];
    for (int64_t i = 0; i < s->curves && (follows || s->terms); i++)
        if (s->curve[i].verb == SCRIPT_CONTRACT)
            value[3 * i] = follows ? activation_at(&s->curve[i].active, time) : fmin(value[3 * i], 1);
}

/* ---- Activations */

/* What a muscle's level is the sum of: its own curve first. */
typedef struct parts {
    const script_curve **curve; /* owned */
    double *factor;             /* owned */
    int64_t count;
} parts;

static void free_parts(parts *p)
{
    free(p->curve);
    free(p->factor);
}

static int find_parts(parts *p, const script *s, int64_t curve, err *e)
{
    int64_t most = 1;
    *p = (parts){.count = 1};
    for (int64_t i = s->curve[curve].term; i; i = s->term[i - 1].next)
        most++;
    p->curve = mem_array(most, sizeof(const script_curve *), "activations", e);
    p->factor = p->curve ? mem_array(most, sizeof *p->factor, "activations", e) : NULL;
    if (!p->factor) {
        free_parts(p);
        return -1;
    }
    p->curve[0] = &s->curve[curve];
    p->factor[0] = 1;
    for (int64_t i = s->curve[curve].term; i; i = s->term[i - 1].next) {
        p->curve[p->count] = &s->curve[s->term[i - 1].express];
        p->factor[p->count++] = s->term[i - 1].factor;
    }
    return 0;
}

/* The first key after a time, of any; INFINITY: there is none. */
static double next_key(const script *s, const parts *p, double time)
{
    double next = INFINITY;
    for (int64_t i = 0; i < p->count; i++) {
        const script_curve *c = p->curve[i];
        const int32_t low = script_keys(s, c, time);
        if (low < c->key_count)
            next = fmin(next, s->time[c->key_first + low]);
    }
    return next;
}

/* From key to key, and to the end. */
static int follow(const script *s, const parts *p, double from, activation *a, err *e)
{
    for (;;) {
        activation_span span = {.from = from, .until = next_key(s, p, from)};
        for (int64_t i = 0; i < p->count; i++)
            script_add_span(s, p->curve[i], p->factor[i], &span);
        if (!isfinite(span.until))
            return activation_settle(a, &s->times, fmin(span.c[0], 1), e);
        if (activation_follow(a, &s->times, &span, e))
            return -1;
        from = span.until;
    }
}

int script_follow(script *s, int64_t curve, double from, err *e)
{
    parts p;
    if (!(s->times.rise > 0))
        return 0;
    if (find_parts(&p, s, curve, e))
        return -1;
    activation *a = &s->curve[curve].active;
    const bool anew = !isfinite(from);
    double begins = anew ? next_key(s, &p, -INFINITY) : from;
    begins = isfinite(begins) ? begins : 0;
    const double value = anew ? 0 : activation_at(a, from); /* 0 where it was forgotten */
    const int failed = activation_begin(a, begins, value, e) || follow(s, &p, begins, a, e);
    free_parts(&p);
    return failed ? -1 : 0;
}

/* ---- Lines and options */

/* What a word of a line or an option stands for: muscles, or an expression. */
typedef struct target {
    script_verb verb;
    muscle_list named; /* or, of an expression, its index alone */
} target;

static int read_target(target *t, const script *s, const model *m, const char *word, const char *place, int64_t line,
                       err *e)
{
    t->verb = *word == '@' ? SCRIPT_EXPRESS : SCRIPT_CONTRACT;
    if (t->verb == SCRIPT_CONTRACT)
        return muscles_named(&t->named, m, word, place, line, e);
    const int32_t at = expressions_find(s->expressions, word + 1, place, line, e);
    if (at < 0 || MEM_ROOM(&t->named.volume, &t->named.room, 1, "muscles", e))
        return -1;
    t->named.volume[0] = at;
    t->named.count = 1;
    return 0;
}

/* The activations of the muscles of a curve, from now on. */
static int follow_now(script *s, int64_t curve, double from, err *e)
{
    if (s->curve[curve].verb == SCRIPT_CONTRACT)
        return script_follow(s, curve, from, e);
    for (int64_t i = 0; i < s->terms; i++)
        if (s->term[i].express == curve && script_follow(s, s->term[i].contract, from, e))
            return -1;
    return 0;
}

static int add_key(script_reader *r, const script_curve *c, double time, const double *value, err *e)
{
    const int64_t there = script_find(r->s, c);
    if (there >= 0 && !r->now && (there < r->first || r->s->curve[there].from != SCRIPT_OF_FILE))
        return keyfile_error(&r->k, e, "'%.200s' is set on the command line too; expected one of them", c->target);
    const int64_t at = script_add_levels(r->s, r->m, c, true, e);
    if (at < 0)
        return -1;
    if (r->s->curve[at].key_count == 0)
        r->s->curve[at].line = c->line;
    if (script_reader_key(r, at, time, value, e))
        return -1;
    return r->now ? follow_now(r->s, at, r->now->from, e) : 0;
}

/* Live: whether all have curves, of which script_add_idle made one for each that can contract. */
static int check_idle(const script_reader *r, const target *t, err *e)
{
    for (int32_t i = 0; r->now && i < t->named.count; i++)
        if (script_find(r->s, &(script_curve){.verb = t->verb, .volume = t->named.volume[i], .target = r->k.word[2]}) <
            0)
            return keyfile_error(&r->k, e, "'%.200s' has a material without a peak stress; expected a muscle with one",
                                 r->k.word[2]);
    return 0;
}

int script_line_contract(script_reader *r, double time, err *e)
{
    const keyfile *k = &r->k;
    double value[3] = {0};
    target t = {0};
    int failed = read_target(&t, r->s, r->m, k->word[2], k->name, k->line, e);
    if (!failed && muscles_level(k->word[3], &value[0]))
        failed = keyfile_error(k, e, "level '%.200s'; expected a number from 0 to 1", k->word[3]);
    if (!failed)
        failed = check_idle(r, &t, e);
    for (int32_t i = 0; !failed && i < t.named.count; i++)
        failed = add_key(r,
                         &(script_curve){.verb = t.verb,
                                         .volume = t.named.volume[i],
                                         .line = k->line,
                                         .from = SCRIPT_OF_FILE,
                                         .target = k->word[2]},
                         time, value, e);
    muscles_free(&t.named);
    return failed ? -1 : 0;
}

static int add_ramp(script *s, const model *m, const script_curve *c, double ramp, const double *value, err *e)
{
    const int64_t there = script_find(s, c);
    const char *what = c->verb == SCRIPT_EXPRESS ? "expression" : "muscle";
    if (there >= 0 && s->curve[there].key_count && s->curve[there].from == SCRIPT_OF_FILE)
        return err_option(e, "-c", "%s '%.200s' is contracted by line %" PRId64 " of the script too; expected one",
                          what, c->target, s->curve[there].line);
    if (there >= 0 && s->curve[there].key_count && s->curve[there].from == SCRIPT_OF_TRACK)
        return err_option(e, "-c", "%s '%.200s' is contracted by %.300s too; expected one", what, c->target, s->track);
    if (there >= 0 && s->curve[there].key_count)
        return err_option(e, "-c", "%s '%.200s' is given twice; expected once", what, c->target);
    const int64_t at = script_add_levels(s, m, c, true, e);
    return at < 0 ? -1 : script_ramp(s, at, ramp, value, e);
}

/* "MUSCLE=LEVEL", cut in place. */
static int add_level(script *s, const model *m, char *item, double ramp, err *e)
{
    double value[3] = {0};
    target t = {0};
    char *equals = strrchr(item, '=');
    if (!equals || equals == item)
        return err_option(e, "-c", "'%.200s'; expected MUSCLE=LEVEL, such as zyg_left=0.4", item);
    *equals = '\0';
    if (muscles_level(equals + 1, &value[0]))
        return err_option(e, "-c", "level '%.200s' of %.200s; expected a number from 0 to 1", equals + 1, item);
    int failed = read_target(&t, s, m, item, "-c", 0, e);
    for (int32_t i = 0; !failed && i < t.named.count; i++) {
        char *name = t.named.count > 1 ? model_find(m, "volume.name")->str[t.named.volume[i]] : item;
        failed = add_ramp(s, m, &(script_curve){.verb = t.verb, .volume = t.named.volume[i], .target = name}, ramp,
                          value, e);
    }
    muscles_free(&t.named);
    return failed ? -1 : 0;
}

int script_add_contract(script *s, const model *m, const char *list, double ramp, err *e)
{
    char *text = mem_text(list, e);
    int status = text ? 0 : -1;
    for (char *item = text, *next; !status && item; item = next) {
        next = strchr(item, ',');
        if (next)
            *next++ = '\0';
        status = add_level(s, m, item, ramp, e);
    }
    free(text);
    return status;
}

/* ---- The whole */

/* A muscle that two of -c, the script and a track drive. */
static int check_origins(const script *s, const model *m, const script_curve *c, err *e)
{
    const script_curve *first = c->key_count ? c : NULL;
    for (int64_t i = c->term; i; i = s->term[i - 1].next) {
        const script_curve *by = &s->curve[s->term[i - 1].express];
        if (first && first->from != by->from)
            return err_set(e, NULL, 0,
                           "muscle '%.200s' is driven by %.300s, as '%.100s', and by %.300s, as '%.100s'; expected one "
                           "of them",
                           model_find(m, "volume.name")->str[c->volume], script_place(s, by), by->target,
                           script_place(s, first), first->target);
        first = by;
    }
    return 0;
}

int32_t script_over(const script *s, double time, double *sum)
{
    for (int64_t i = 0; i < s->curves && s->terms; i++) {
        *sum = s->curve[i].term ? sum_at(s, i, time) : 0;
        if (*sum > 1 + 1e-12)
            return s->curve[i].volume;
    }
    return -1;
}

/* The first key of `by` at which the levels of a muscle add up to more than 1, or NULL. */
static const double *find_over(const script *s, int64_t muscle, const script_curve *by)
{
    for (int32_t k = 0; k < by->key_count; k++)
        if (sum_at(s, muscle, s->time[by->key_first + k]) > 1 + 1e-12)
            return &s->time[by->key_first + k];
    return NULL;
}

/* Where the levels of a muscle add up to more than 1, at a key. */
static const double *look_over(const script *s, int64_t muscle)
{
    const double *at = find_over(s, muscle, &s->curve[muscle]);
    for (int64_t i = s->curve[muscle].term; i && !at; i = s->term[i - 1].next)
        at = find_over(s, muscle, &s->curve[s->term[i - 1].express]);
    return at;
}

static void warn_over(const script *s, const model *m, notes *warnings)
{
    for (int64_t i = 0; i < s->curves; i++) {
        const double *at = s->curve[i].term ? look_over(s, i) : NULL;
        if (!at)
            continue;
        notes_add(warnings, "at %.6g s the levels of %.200s add up to %.4g; what is above 1 counts as 1", *at,
                  model_find(m, "volume.name")->str[s->curve[i].volume], sum_at(s, i, *at));
        return;
    }
}

int script_check_levels(script *s, const model *m, notes *warnings, err *e)
{
    for (int64_t i = 0; i < s->curves; i++)
        if (check_origins(s, m, &s->curve[i], e))
            return -1;
    warn_over(s, m, warnings);
    for (int64_t i = 0; i < s->curves; i++)
        if (s->curve[i].verb == SCRIPT_CONTRACT && script_follow(s, i, -INFINITY, e))
            return -1;
    return 0;
}
