#include "tled/problem/script.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/near.h"
#include "base/num.h"
#include "base/path.h"
#include "surface/surface_region.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

void script_free(script *s)
{
    for (int64_t i = 0; i < s->curves; i++) {
        free(s->curve[i].target);
        free(s->curve[i].surface);
    }
    free(s->curve);
    free(s->time);
    free(s->value);
    free(s->node);
    free(s->corner);
    free(s->part);
    free(s->file);
    *s = (script){0};
}

int32_t script_keys(const script *s, const script_curve *c, double time)
{
    const double *times = s->time + c->key_first;
    int32_t low = 0, high = c->key_count;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (times[middle] <= time)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

void script_value(const script *s, const script_curve *c, double time, double *value)
{
    const double *times = s->time + c->key_first, *values = s->value + 3 * (int64_t)c->key_first;
    const int32_t low = script_keys(s, c, time);
    for (int a = 0; a < 3; a++) {
        if (low == 0) {
            value[a] = 0;
        } else if (low == c->key_count) {
            value[a] = values[3 * (low - 1) + a];
        } else {
            double from = values[3 * (low - 1) + a], to = values[3 * low + a];
            double share = (time - times[low - 1]) / (times[low] - times[low - 1]);
            value[a] = from * (1 - share) + to * share;
        }
    }
}

void script_values(const script *s, double time, double *value)
{
    for (int64_t i = 0; i < s->curves; i++) {
        if (s->curve[i].verb == SCRIPT_MOVE)
            script_move_values(s, &s->curve[i], time, value + 3 * i);
        else if (s->curve[i].verb != SCRIPT_TURN)
            script_value(s, &s->curve[i], time, value + 3 * i);
    }
}

double script_end(const script *s)
{
    double end = 0;
    for (int64_t i = 0; i < s->curves; i++)
        end = s->curve[i].end > end ? s->curve[i].end : end;
    return end;
}

/* Curves */

static bool by_box(const script_curve *c)
{
    return strchr(c->target, ',') != NULL;
}

const char *script_region(const script_curve *c)
{
    const char *colon = strchr(c->target, ':');
    return colon ? colon + 1 : NULL;
}

/* Of one surface; boxes are known to be the same. */
static bool same_region(const script_curve *a, const script_curve *b)
{
    const char *of_a = script_region(a), *of_b = script_region(b);
    if (strcmp(a->surface, b->surface) != 0 || !of_a != !of_b)
        return false;
    if (!of_a || (surface_region_is_box(of_a) && surface_region_is_box(of_b)))
        return true;
    return path_is_obj(of_a) ? !strcmp(of_a, of_b) : !strcasecmp(of_a, of_b);
}

static bool same_target(const script_curve *a, const script_curve *b)
{
    if (a->verb != b->verb || a->volume != b->volume)
        return false;
    if (a->verb == SCRIPT_PULL || a->verb == SCRIPT_MOVE)
        return !strcmp(a->target, b->target);
    for (int i = 0; i < 6; i++)
        if (a->box[i] != b->box[i])
            return false;
    if (a->surface)
        return same_region(a, b);
    return a->verb != SCRIPT_DISPLACE || (by_box(a) && by_box(b)) || !strcasecmp(a->target, b->target);
}

int64_t script_find(const script *s, const script_curve *like)
{
    for (int64_t i = 0; i < s->curves; i++)
        if (same_target(&s->curve[i], like))
            return i;
    return -1;
}

int64_t script_add(script *s, const script_curve *c, err *e)
{
    if (mem_grow(&s->curve, &s->curve_capacity, s->curves + 1, sizeof *s->curve, "the script's curves", e))
        return -1;
    script_curve *added = &s->curve[s->curves];
    *added = *c;
    added->node_first = (int32_t)s->nodes;
    added->triangle_first = (int32_t)s->triangles;
    added->target = mem_text(c->target, e);
    added->surface = c->surface ? mem_text(c->surface, e) : NULL;
    s->curves++;
    return added->target && (!c->surface || added->surface) ? s->curves - 1 : -1;
}

int script_reserve(script *s, int64_t more, err *e)
{
    int64_t need = s->keys + more;
    if (need > INT32_MAX)
        return err_set(e, NULL, 0, "the script has more than %d keys", INT32_MAX);
    return mem_grow(&s->time, &s->time_capacity, need, sizeof *s->time, "the script's keys", e) ||
                   mem_grow(&s->value, &s->value_capacity, need, 3 * sizeof *s->value, "the script's keys", e)
               ? -1
               : 0;
}

/* Of a tick: what computes times in another way, to the last digits, is at its beginning all the same. */
static const double early = 1e-6;

int script_hold(script *s, int64_t curve, const script_now *now, const double *was, const double *value, err *e)
{
    if (!s->curve[curve].own && script_reserve(s, 2, e))
        return -1;
    script_curve *c = &s->curve[curve];
    if (!c->own) {
        c->own = (int32_t)s->keys + 1;
        s->keys += 2;
    }
    c->key_first = c->own - 1;
    c->key_count = 2;
    c->end = now->until;
    s->time[c->key_first] = now->from - early * (now->until - now->from);
    s->time[c->own] = now->until;
    memcpy(s->value + 3 * (int64_t)c->key_first, was, 3 * sizeof *was);
    memcpy(s->value + 3 * (int64_t)c->own, value, 3 * sizeof *value);
    return 0;
}

/* Takes `count` of `all` things out of an array, from `first` on. */
static void cut(void *array, size_t size, int64_t first, int64_t count, int64_t all)
{
    if (!count)
        return;
    char *to = (char *)array + (size_t)first * size;
    memmove(to, to + (size_t)count * size, (size_t)(all - first - count) * size);
}

static void cut_keys(script *s, const script_curve *c)
{
    const int32_t first = c->own - 1;
    if (!c->own)
        return;
    cut(s->time, sizeof *s->time, first, 2, s->keys);
    cut(s->value, 3 * sizeof *s->value, first, 2, s->keys);
    s->keys -= 2;
    for (int64_t i = 0; i < s->curves; i++) {
        s->curve[i].key_first -= s->curve[i].key_first > first ? 2 : 0;
        s->curve[i].own -= s->curve[i].own > c->own ? 2 : 0;
    }
}

void script_drop(script *s, int64_t curve)
{
    const script_curve c = s->curve[curve];
    cut_keys(s, &c);
    cut(s->node, sizeof *s->node, c.node_first, c.node_count, s->nodes);
    cut(s->corner, 3 * sizeof *s->corner, c.triangle_first, c.triangle_count, s->triangles);
    cut(s->part, sizeof *s->part, c.triangle_first, c.triangle_count, s->triangles);
    s->nodes -= c.node_count;
    s->triangles -= c.triangle_count;
    cut(s->curve, sizeof *s->curve, curve, 1, s->curves);
    s->curves--;
    for (int64_t i = curve; i < s->curves; i++) {
        s->curve[i].node_first -= c.node_count;
        s->curve[i].triangle_first -= c.triangle_count;
    }
    free(c.target);
    free(c.surface);
}

int64_t script_release_all(script *s, const script_now *now)
{
    static const double none[3] = {0};
    int64_t count = 0;
    for (int64_t i = 0; i < s->curves; i++) {
        const script_verb verb = s->curve[i].verb;
        double here[3];
        if (verb == SCRIPT_MOVE && s->curve[i].own)
            script_move_stop(s, i, now, false);
        if (verb == SCRIPT_MOVE || verb == SCRIPT_TURN)
            continue;
        script_value(s, &s->curve[i], now->from, here);
        err full = {0}; /* of keys that are not its own yet: then it stays */
        if (verb == SCRIPT_DISPLACE && s->curve[i].own)
            script_hold(s, i, now, here, here, &full);
        if ((verb != SCRIPT_PULL && verb != SCRIPT_SPRING) || script_hold(s, i, now, none, none, &full))
            continue;
        count += verb == SCRIPT_PULL && !s->curve[i].is_released;
        s->curve[i].is_released = true;
    }
    return count;
}

void script_forget_all(script *s, const script_now *now)
{
    static const double none[3] = {0};
    for (int64_t i = 0; i < s->curves; i++) {
        const script_verb verb = s->curve[i].verb;
        if (s->curve[i].own && verb == SCRIPT_MOVE)
            script_move_stop(s, i, now, true);
        else if (s->curve[i].own && verb != SCRIPT_TURN)
            script_hold(s, i, now, none, none, &(err){0}); /* it has room of its own: nothing can fail */
    }
}

static int add_still(script *s, const script_curve *c, err *e)
{
    static const script_now now = {0, 0, NULL};
    static const double none[3] = {0};
    if (script_find(s, c) >= 0)
        return 0;
    const int64_t at = script_add(s, c, e);
    return at < 0 || script_hold(s, at, &now, none, none, e) ? -1 : 0;
}

int script_add_idle(script *s, const model *m, err *e)
{
    const model_array *name = model_find(m, "volume.name"), *muscle = model_find(m, "volume.muscle");
    const model_array *material = model_find(m, "volume.material"), *peak = model_find(m, "material.peak");
    char gravity[] = "gravity";
    if (add_still(s, &(script_curve){.verb = SCRIPT_GRAVITY, .volume = -1, .target = gravity}, e))
        return -1;
    for (int64_t i = 0; name && muscle && material && peak && i < name->rows; i++)
        if (muscle->u8[i] && peak->f64[material->i32[i]] > 0 &&
            add_still(s, &(script_curve){.verb = SCRIPT_CONTRACT, .volume = (int32_t)i, .target = name->str[i]}, e))
            return -1;
    return 0;
}

/* Adds a curve from 0 at time 0 to value at `ramp`; for the command line. */
static int curve_add_ramp(script *s, const script_curve *c, double ramp, const double *value, err *e)
{
    int64_t at = script_reserve(s, 2, e) ? -1 : script_add(s, c, e);
    if (at < 0)
        return -1;
    script_curve *added = &s->curve[at];
    added->key_first = (int32_t)s->keys;
    added->key_count = ramp > 0 ? 2 : 1;
    added->end = ramp;
    for (int i = 0; i < added->key_count; i++, s->keys++) {
        bool last = i + 1 == added->key_count;
        s->time[s->keys] = last ? ramp : 0;
        for (int a = 0; a < 3; a++)
            s->value[3 * s->keys + a] = last ? value[a] : 0;
    }
    return 0;
}

/* Muscles */

static const char prefix[] = "muscle_";

/* The name past "muscle_", where it begins so (any case); else the name. */
static const char *short_name(const char *name)
{
    size_t n = sizeof prefix - 1;
    return !strncasecmp(name, prefix, n) && name[n] ? name + n : name;
}

static int unknown_muscle(const model_array *names, const model_array *muscle, const char *name, const char *place,
                          int64_t line, err *e)
{
    const char **list = mem_array(names->rows, sizeof *list, "names", e);
    if (!list)
        return -1;
    int count = 0;
    bool whole = short_name(name) != name;
    for (int64_t i = 0; i < names->rows && count < INT32_MAX; i++)
        if (muscle->u8[i])
            list[count++] = whole ? names->str[i] : short_name(names->str[i]);
    if (line)
        near_unknown(e, place, line, "muscle", name, list, count);
    else
        near_option(e, place, "muscle", name, list, count);
    free(list);
    return -1;
}

int32_t script_muscle(const model *m, const char *name, const char *place, int64_t line, err *e)
{
    const model_array *names = model_need(m, "volume.name", e), *muscle = model_need(m, "volume.muscle", e);
    if (!names || !muscle)
        return -1;
    for (int64_t i = 0; i < names->rows; i++)
        if (muscle->u8[i] && chars_mean(name, names->str[i]))
            return (int32_t)i;
    for (int64_t i = 0; i < names->rows; i++)
        if (muscle->u8[i] && chars_mean(name, short_name(names->str[i])))
            return (int32_t)i;
    return unknown_muscle(names, muscle, name, place, line, e);
}

/* What of a muscle's elements makes it contract. */
typedef struct fitness {
    int64_t elements, fibres, moving; /* of it; those with a fibre; of these, those with a node that is not rigid */
} fitness;

static bool can_move(const model_array *node, const model_array *rigid, int64_t element)
{
    const int32_t *of = node->i32 + node->columns * element;
    for (int i = 0; i < node->columns; i++)
        if (!rigid || !rigid->u8[of[i]])
            return true;
    return false;
}

/* Adds up, for each volume, the elements that `which` says are of it. */
static void count_fit(fitness *of, const model *m, const char *which, const char *fibre_of)
{
    const model_array *volume = model_find(m, which), *fibre = model_find(m, fibre_of);
    const model_array *node = model_find(m, "element.node"), *rigid = model_find(m, "node.rigid");
    for (int64_t i = 0; volume && i < volume->rows; i++) {
        if (volume->i32[i] < 0)
            continue;
        fitness *f = &of[volume->i32[i]];
        const float *along = fibre ? fibre->f32 + 3 * i : NULL;
        bool has = along && (along[0] != 0 || along[1] != 0 || along[2] != 0);
        f->elements++;
        f->fibres += has;
        f->moving += has && (!node || can_move(node, rigid, i));
    }
}

/* Why a muscle cannot contract, and what would help. */
static void say_why(const model *m, const fitness *f, char *to, size_t size)
{
    if (!f->elements)
        snprintf(to, size, "it has no elements; smaller voxels (voxelise -s) may give it some");
    else if (f->fibres)
        snprintf(to, size,
                 "all nodes of its elements with a fibre (%" PRId64 ") are rigid; smaller voxels or a lower attach "
                 "--strictness may leave some free",
                 f->fibres);
    else if (!model_find(m, "element.lattice"))
        snprintf(to, size, "its elements (%" PRId64 ") have no fibre; expected directions in element.fibre",
                 f->elements);
    else if (!model_find(m, "element.fibre"))
        snprintf(to, size, "the model has no fibres (element.fibre); run attach, which gives muscles theirs");
    else
        snprintf(to, size,
                 "its elements (%" PRId64 ") have no fibre; attach --fibre field gives fibres also to a muscle that "
                 "touches no bone",
                 f->elements);
}

/* Whether it is of a muscle whose level is above 0 at any time. */
static bool contracts(const script *s, const script_curve *c)
{
    bool any = false;
    for (int32_t i = 0; c->verb == SCRIPT_CONTRACT && i < c->key_count; i++)
        any |= s->value[3 * ((int64_t)c->key_first + i)] > 0;
    return any;
}

static bool is_idle(const script *s, const script_curve *c, const fitness *of)
{
    return contracts(s, c) && !of[c->volume].moving;
}

/* Warns of the muscles that cannot contract, or refuses where none can. */
static int weigh(const script *s, const model *m, const fitness *of, notes *warnings, err *e)
{
    int64_t muscles = 0, idle = 0;
    char why[300];
    for (int64_t i = 0; i < s->curves; i++) {
        muscles += contracts(s, &s->curve[i]);
        idle += is_idle(s, &s->curve[i], of);
    }
    for (int64_t i = 0; i < s->curves; i++) {
        if (!is_idle(s, &s->curve[i], of))
            continue;
        const int32_t volume = s->curve[i].volume;
        const int64_t line = s->curve[i].line; /* 0: of the command line */
        const char *place = line ? s->file : "-c";
        const char *name = model_find(m, "volume.name")->str[volume];
        say_why(m, &of[volume], why, sizeof why);
        if (idle == muscles && muscles == 1)
            return err_set(e, place, line, "%.200s cannot contract: %s", name, why);
        if (idle == muscles)
            return err_set(e, place, line, "none of the %" PRId64 " muscles can contract; %.200s: %s", muscles, name,
                           why);
        if (line)
            notes_add(warnings, "%s:%" PRId64 ": %.200s will not contract: %s", place, line, name, why);
        else
            notes_add(warnings, "%s: %.200s will not contract: %s", place, name, why);
    }
    return 0;
}

int script_check_muscles(const script *s, const model *m, notes *warnings, err *e)
{
    bool any = false;
    for (int64_t i = 0; i < s->curves; i++)
        any |= contracts(s, &s->curve[i]);
    if (!any)
        return 0;
    fitness *of = mem_array(model_count(m, "volume"), sizeof *of, "the muscles", e);
    if (!of)
        return -1;
    count_fit(of, m, "element.volume", "element.fibre");
    count_fit(of, m, "element.mix", "element.mixfibre");
    int status = weigh(s, m, of, warnings, e);
    free(of);
    return status;
}

int script_level(const char *text, double *level)
{
    return num_double(text, level) || *level < 0 || *level > 1 ? -1 : 0;
}

/* "MUSCLE=LEVEL", cut in place. */
static int add_level(script *s, const model *m, char *item, double ramp, err *e)
{
    double value[3] = {0};
    char *equals = strrchr(item, '=');
    if (!equals || equals == item)
        return err_option(e, "-c", "'%.200s'; expected MUSCLE=LEVEL, such as zyg_left=0.4", item);
    *equals = '\0';
    if (script_level(equals + 1, &value[0]))
        return err_option(e, "-c", "level '%.200s' of %.200s; expected a number from 0 to 1", equals + 1, item);
    script_curve c = {.verb = SCRIPT_CONTRACT, .volume = script_muscle(m, item, "-c", 0, e), .target = item};
    if (c.volume < 0)
        return -1;
    int64_t other = script_find(s, &c);
    if (other >= 0 && s->curve[other].line)
        return err_option(e, "-c", "muscle '%.200s' is contracted by line %" PRId64 " of the script too; expected one",
                          item, s->curve[other].line);
    if (other >= 0)
        return err_option(e, "-c", "muscle '%.200s' is given twice; expected once", item);
    return curve_add_ramp(s, &c, ramp, value, e);
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

int script_add_gravity(script *s, const double *g, double ramp, err *e)
{
    char target[] = "gravity";
    script_curve c = {.verb = SCRIPT_GRAVITY, .volume = -1, .target = target};
    int64_t other = script_find(s, &c);
    if (other >= 0)
        return err_option(e, "-g", "gravity is set by line %" PRId64 " of the script too; expected one",
                          s->curve[other].line);
    return curve_add_ramp(s, &c, ramp, g, e);
}
