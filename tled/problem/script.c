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
        activation_free(&s->curve[i].active);
    }
    free(s->curve);
    free(s->time);
    free(s->value);
    free(s->node);
    free(s->corner);
    free(s->part);
    free(s->file);
    free(s->track);
    free(s->term);
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
        } else if (c->is_smooth) {
            value[a] = a ? 0 : script_smooth(s, c, low, time);
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
    script_muscle_values(s, time, value);
}

double script_end(const script *s)
{
    double end = 0;
    for (int64_t i = 0; i < s->curves; i++)
        end = fmax(end, fmax(s->curve[i].end, activation_end(&s->curve[i].active)));
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
    for (int64_t i = 0; i < s->terms; i++) {
        s->term[i].contract -= s->term[i].contract > curve;
        s->term[i].express -= s->term[i].express > curve;
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
    for (int64_t i = 0; i < s->curves; i++)
        if (s->curve[i].verb == SCRIPT_CONTRACT) {
            s->curve[i].active.nodes = 0;
            script_follow(s, i, now->from, &(err){0}); /* where there is no memory it stays at 0 */
        }
}

static int add_still(script *s, const model *m, const script_curve *c, err *e)
{
    static const script_now now = {0, 0, NULL};
    static const double none[3] = {0};
    if (script_find(s, c) >= 0)
        return 0;
    const int64_t at =
        c->verb == SCRIPT_GRAVITY ? script_add(s, c, e) : script_add_levels(s, m, c, c->verb == SCRIPT_CONTRACT, e);
    return at < 0 || script_hold(s, at, &now, none, none, e) ? -1 : 0;
}

static int add_expressions(script *s, const model *m, err *e)
{
    const expressions *x = s->expressions;
    for (int32_t i = 0; x && i < x->count; i++)
        if (add_still(s, m, &(script_curve){.verb = SCRIPT_EXPRESS, .volume = i, .target = x->list[i].name}, e))
            return -1;
    for (int64_t i = 0; i < s->curves; i++)
        if (s->curve[i].verb == SCRIPT_CONTRACT && script_follow(s, i, -INFINITY, e))
            return -1;
    return 0;
}

int script_add_idle(script *s, const model *m, err *e)
{
    const model_array *name = model_find(m, "volume.name"), *muscle = model_find(m, "volume.muscle");
    const model_array *material = model_find(m, "volume.material"), *peak = model_find(m, "material.peak");
    char gravity[] = "gravity";
    if (add_still(s, m, &(script_curve){.verb = SCRIPT_GRAVITY, .volume = -1, .target = gravity}, e))
        return -1;
    for (int64_t i = 0; name && muscle && material && peak && i < name->rows; i++)
        if (muscle->u8[i] && peak->f64[material->i32[i]] > 0 &&
            add_still(s, m, &(script_curve){.verb = SCRIPT_CONTRACT, .volume = (int32_t)i, .target = name->str[i]}, e))
            return -1;
    return add_expressions(s, m, e);
}

int script_ramp(script *s, int64_t curve, double ramp, const double *value, err *e)
{
    if (script_reserve(s, 2, e))
        return -1;
    script_curve *of = &s->curve[curve];
    of->key_first = (int32_t)s->keys;
    of->key_count = ramp > 0 ? 2 : 1;
    of->end = ramp;
    for (int i = 0; i < of->key_count; i++, s->keys++) {
        bool last = i + 1 == of->key_count;
        s->time[s->keys] = last ? ramp : 0;
        for (int a = 0; a < 3; a++)
            s->value[3 * s->keys + a] = last ? value[a] : 0;
    }
    return 0;
}

int script_add_gravity(script *s, const double *g, double ramp, err *e)
{
    char target[] = "gravity";
    script_curve c = {.verb = SCRIPT_GRAVITY, .volume = -1, .target = target};
    int64_t other = script_find(s, &c);
    if (other >= 0)
        return err_option(e, "-g", "gravity is set by line %" PRId64 " of the script too; expected one",
                          s->curve[other].line);
    const int64_t at = script_add(s, &c, e);
    return at < 0 ? -1 : script_ramp(s, at, ramp, g, e);
}
