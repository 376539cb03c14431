#include "base/mem.h"
#include "base/near.h"
#include "base/num.h"
#include "surface/surface_region.h"
#include "tled/problem/script_reader.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef script_reader reader;
typedef script_entry entry;

/* Lines of a file */

int script_reader_lengths(const reader *r, const char *text, int count, double *value, const char *expected, err *e)
{
    num_length list[6];
    num_unit metre = num_unit_of("m");
    int n = num_lengths_of(text, list, count);
    for (int i = 0; i < n; i++)
        if (!isfinite(value[i] = num_length_in(list[i], metre, metre)))
            n = -1;
    return n == count ? 0 : keyfile_error(&r->k, e, "'%.200s'; expected %s", text, expected);
}

static int take_numbers(reader *r, int at, double *value, const char *expected, err *e)
{
    return num_list(r->k.word[at], value, 3) == 3
               ? 0
               : keyfile_error(&r->k, e, "'%.200s'; expected %s", r->k.word[at], expected);
}

/* "UX,UY,UZ" where '-' leaves a component free. */
static int take_displacement(reader *r, int at, double *value, uint32_t *mask, err *e)
{
    static const char expected[] = "UX,UY,UZ: lengths in metres or with suffixes, '-' for a free component";
    num_unit metre = num_unit_of("m");
    char item[64];
    const char *p = r->k.word[at];
    *mask = 0;
    for (int a = 0; a < 3; a++, p++) {
        size_t n = strcspn(p, ",");
        num_length length = {0};
        if (n >= sizeof item || p[n] != (a < 2 ? ',' : '\0'))
            return keyfile_error(&r->k, e, "'%.200s'; expected %s", r->k.word[at], expected);
        memcpy(item, p, n);
        item[n] = '\0';
        bool is_free = !strcmp(item, "-");
        if (!is_free && num_length_of(item, &length))
            return keyfile_error(&r->k, e, "'%.200s'; expected %s", r->k.word[at], expected);
        value[a] = num_length_in(length, metre, metre);
        if (!isfinite(value[a]))
            return keyfile_error(&r->k, e, "'%.200s' is too large; expected %s", item, expected);
        *mask |= is_free ? 0 : 1u << a;
        p += n;
    }
    if (!*mask)
        return keyfile_error(&r->k, e, "'%.200s' leaves all components free; expected one at least to be given",
                             r->k.word[at]);
    return 0;
}

int64_t script_reader_curve(reader *r, const script_curve *c, bool *fresh, err *e)
{
    int64_t at = script_find(r->s, c);
    *fresh = at < 0;
    if (at >= 0 && at < r->first)
        return keyfile_error(&r->k, e, "'%.200s' is set on the command line too; expected one of them", c->target);
    return at < 0 ? script_add(r->s, c, e) : at;
}

/* What a target is displaced by now, the components that a new one leaves free too. */
static void displaced_now(const reader *r, int64_t at, double was[3])
{
    const script_curve *c = &r->s->curve[at];
    if (c->key_count) {
        script_value(r->s, c, r->now->from, was);
        return;
    }
    const bool nodes = c->node_count && r->s->node[c->node_first] < model_count(r->m, "node"); /* and no films */
    for (int a = 0; a < 3; a++) {
        was[a] = 0;
        for (int32_t i = 0; r->now->displacement && nodes && i < c->node_count; i++)
            was[a] += r->now->displacement[3 * (int64_t)r->s->node[c->node_first + i] + a] / c->node_count;
    }
}

static int hold_now(const reader *r, int64_t at, const double *value, err *e)
{
    double was[3] = {value[0], value[1], value[2]};
    if (r->s->curve[at].verb == SCRIPT_DISPLACE)
        displaced_now(r, at, was);
    return script_hold(r->s, at, r->now, was, value, e);
}

int script_reader_key(reader *r, int64_t at, double time, const double *value, err *e)
{
    if (r->now)
        return hold_now(r, at, value, e);
    script_curve *c = &r->s->curve[at];
    if (c->key_count && time < c->end)
        return keyfile_error(&r->k, e, "time %g s comes after %g s for the same target; expected times in order", time,
                             c->end);
    if (r->count == INT32_MAX)
        return keyfile_error(&r->k, e, "more than %d lines", INT32_MAX);
    if (mem_grow(&r->entries, &r->capacity, r->count + 1, sizeof *r->entries, "the script", e))
        return -1;
    entry *n = &r->entries[r->count++];
    *n = (entry){.curve = at, .time = time, .value = {value[0], value[1], value[2]}};
    c->end = time;
    c->key_count++;
    return 0;
}

static int line_gravity(reader *r, double time, err *e)
{
    double value[3];
    char target[] = "gravity";
    script_curve c = {.verb = SCRIPT_GRAVITY, .volume = -1, .line = r->k.line, .target = target};
    if (take_numbers(r, 2, value, "X,Y,Z in m/s2", e))
        return -1;
    bool fresh;
    int64_t at = script_reader_curve(r, &c, &fresh, e);
    return at < 0 ? -1 : script_reader_key(r, at, time, value, e);
}

static int line_force(reader *r, double time, err *e)
{
    double value[3];
    script_curve c = {.verb = SCRIPT_FORCE, .volume = -1, .line = r->k.line, .target = r->k.word[2]};
    if (script_reader_lengths(r, r->k.word[2], 3, c.box, "X,Y,Z: a point, in metres or with suffixes", e) ||
        script_reader_lengths(r, r->k.word[3], 1, c.box + 3, "a radius, in metres or with a suffix", e) ||
        take_numbers(r, 4, value, "FX,FY,FZ in N", e))
        return -1;
    if (c.box[3] <= 0)
        return keyfile_error(&r->k, e, "radius '%.200s'; expected more than 0", r->k.word[3]);
    bool fresh;
    int64_t at = script_reader_curve(r, &c, &fresh, e);
    if (at < 0 || (fresh && script_nodes_in_ball(r->s, r->m, &r->k, r->near, &c, e)))
        return -1;
    return script_reader_key(r, at, time, value, e);
}

static int take_box(reader *r, const char *text, double *box, err *e)
{
    if (script_reader_lengths(r, text, 6, box, "X0,Y0,Z0,X1,Y1,Z1: a box, in metres or with suffixes", e))
        return -1;
    for (int a = 0; a < 3; a++)
        if (box[a] > box[a + 3])
            return keyfile_error(&r->k, e, "box %.200s is empty: %g > %g; expected the low corner first", text, box[a],
                                 box[a + 3]);
    return 0;
}

static int take_nodes(const reader *r, const script_curve *c, bool box, err *e)
{
    return box ? script_nodes_in_box(r->s, r->m, &r->k, r->near, c, e)
               : script_nodes_of_surface(r->s, r->m, &r->k, c, e);
}

static int line_displace(reader *r, double time, err *e)
{
    double value[3];
    script_curve c = {.verb = SCRIPT_DISPLACE, .volume = -1, .line = r->k.line, .target = r->k.word[2]};
    bool box = strchr(c.target, ',') != NULL, fresh;
    if ((box && take_box(r, c.target, c.box, e)) || take_displacement(r, 3, value, &c.mask, e))
        return -1;
    int64_t at = script_reader_curve(r, &c, &fresh, e);
    if (at < 0 || (fresh && take_nodes(r, &c, box, e)))
        return -1;
    if (r->s->curve[at].mask != c.mask)
        return keyfile_error(&r->k, e,
                             "'%.200s' frees other components than line %" PRId64
                             " does; expected the same in all lines of a target",
                             r->k.word[3], r->s->curve[at].line);
    return script_reader_key(r, at, time, value, e);
}

/* On a bound surface or a region of it. */
static int add_to_surface(reader *r, script_verb verb, double time, const double *value, err *e)
{
    char name[MODEL_NAME];
    script_curve c = {.verb = verb, .volume = -1, .line = r->k.line, .target = r->k.word[2]};
    const char *region = script_region(&c);
    if (script_take_surface(&c, r->m, &r->k, name, e) ||
        (region && surface_region_is_box(region) && take_box(r, region, c.box, e)))
        return -1;
    c.is_region = region != NULL;
    bool fresh;
    int64_t at = script_reader_curve(r, &c, &fresh, e);
    if (at < 0 || (fresh && script_take_triangles(r->s, r->m, &r->k, e)))
        return -1;
    return script_reader_key(r, at, time, value, e);
}

static int line_pressure(reader *r, double time, err *e)
{
    double value[3] = {0};
    if (num_double(r->k.word[3], &value[0]) || !isfinite(value[0]))
        return keyfile_error(&r->k, e, "pressure '%.200s'; expected a number in Pa", r->k.word[3]);
    return add_to_surface(r, SCRIPT_PRESSURE, time, value, e);
}

static int line_traction(reader *r, double time, err *e)
{
    double value[3];
    return take_numbers(r, 3, value, "X,Y,Z in Pa", e) ? -1 : add_to_surface(r, SCRIPT_TRACTION, time, value, e);
}

/* Keys of a pull and of its spring, which is the curve after it. */
static int keys_add(reader *r, int64_t at, double time, double spring, const double *place, err *e)
{
    const double *from = r->s->curve[at].box, factor[3] = {spring, spring, spring};
    double value[3];
    for (int a = 0; a < 3; a++)
        value[a] = spring * (place[a] - from[a]);
    return script_reader_key(r, at, time, value, e) || script_reader_key(r, at + 1, time, factor, e) ? -1 : 0;
}

/* The same live: the target goes there in a straight line from where it is, if it pulls. */
static int pull_now(const reader *r, int64_t at, const double *place, err *e)
{
    static const double factor[3] = {1, 1, 1};
    double was[3], spring[3] = {0}, value[3];
    if (r->s->curve[at].key_count) {
        script_value(r->s, &r->s->curve[at], r->now->from, was);
        script_value(r->s, &r->s->curve[at + 1], r->now->from, spring);
    }
    for (int a = 0; a < 3; a++)
        value[a] = place[a] - r->s->curve[at].box[a];
    return script_hold(r->s, at, r->now, spring[0] > 0 ? was : value, value, e) ||
                   script_hold(r->s, at + 1, r->now, factor, factor, e)
               ? -1
               : 0;
}

static int64_t add_pull(reader *r, const script_curve *c, err *e)
{
    script_curve spring = *c;
    const int64_t at = script_add(r->s, c, e);
    if (at < 0 || script_nodes_in_ball(r->s, r->m, &r->k, r->near, c, e))
        return -1;
    spring.verb = SCRIPT_SPRING;
    return script_add(r->s, &spring, e) < 0 ? -1 : at;
}

static bool is_same_spring(const script_curve *a, const script_curve *b)
{
    return !memcmp(a->box, b->box, sizeof a->box) && a->stiffness == b->stiffness;
}

static int take_pull(reader *r, script_curve *c, double *to, err *e)
{
    const keyfile *k = &r->k;
    if (script_reader_lengths(r, k->word[3], 3, c->box, "X,Y,Z: a point, in metres or with suffixes", e) ||
        script_reader_lengths(r, k->word[4], 1, c->box + 3, "a radius, in metres or with a suffix", e) ||
        script_reader_lengths(r, k->word[5], 3, to, "TX,TY,TZ: a point, in metres or with suffixes", e))
        return -1;
    if (c->box[3] <= 0)
        return keyfile_error(k, e, "radius '%.200s'; expected more than 0", k->word[4]);
    if (num_double(k->word[6], &c->stiffness) || !isfinite(c->stiffness) || c->stiffness <= 0)
        return keyfile_error(k, e, "stiffness '%.200s'; expected a number above 0, in N/m", k->word[6]);
    return 0;
}

static int line_pull(reader *r, double time, err *e)
{
    double to[3] = {0};
    script_curve c = {.verb = SCRIPT_PULL, .volume = -1, .line = r->k.line, .target = r->k.word[2]};
    if (take_pull(r, &c, to, e))
        return -1;
    int64_t at = script_find(r->s, &c);
    const bool differs = at >= 0 && !is_same_spring(&r->s->curve[at], &c);
    if (differs && r->now && r->s->curve[at].is_live) {
        r->gone = at;
        at = -1;
    } else if (differs)
        return keyfile_error(&r->k, e,
                             "'%.200s' pulls at another place, or with another stiffness, since line %" PRId64
                             "; expected the same, or another ID",
                             c.target, r->s->curve[at].line);
    if (at < 0 && (at = add_pull(r, &c, e)) < 0)
        return -1;
    if (!r->now && r->s->curve[at].is_released && keys_add(r, at, time, 0, to, e))
        return -1;
    r->s->curve[at].is_released = false;
    return r->now ? pull_now(r, at, to, e) : keys_add(r, at, time, 1, to, e);
}

/* The end of a pull's spring, as said last. */
static const double *last_value(const reader *r, int64_t curve)
{
    int64_t i = r->count - 1;
    while (r->entries[i].curve != curve)
        i--;
    return r->entries[i].value;
}

static int line_release(reader *r, double time, err *e)
{
    const keyfile *k = &r->k;
    const script_curve c = {.verb = SCRIPT_PULL, .volume = -1, .target = k->word[2]};
    const int64_t at = script_find(r->s, &c);
    double to[3];
    if (at < 0 || r->s->curve[at].is_released)
        return keyfile_error(k, e, "nothing is pulled as '%.200s'; expected the ID of a pull before", k->word[2]);
    r->s->curve[at].is_released = true;
    if (r->now)
        return keys_add(r, at, time, 0, r->s->curve[at].box, e);
    for (int a = 0; a < 3; a++)
        to[a] = r->s->curve[at].box[a] + last_value(r, at)[a];
    return keys_add(r, at, time, 1, to, e) || keys_add(r, at, time, 0, to, e) ? -1 : 0;
}

static const struct verb {
    int words, more; /* more: how many may follow, all or none */
    int (*take)(reader *r, double time, err *e);
    const char *expected;
} verbs[] = {
    {4, 0, script_line_contract, "contract MUSCLE LEVEL"},
    {3, 0, line_gravity, "gravity X,Y,Z"},
    {5, 0, line_force, "force X,Y,Z RADIUS FX,FY,FZ"},
    {4, 0, line_displace, "displace SURFACE|X0,Y0,Z0,X1,Y1,Z1 UX,UY,UZ"},
    {4, 0, line_pressure, "pressure SURFACE[:GROUP|:X0,Y0,Z0,X1,Y1,Z1|:FILE.obj] PA"},
    {4, 0, line_traction, "traction SURFACE[:GROUP|:X0,Y0,Z0,X1,Y1,Z1|:FILE.obj] X,Y,Z"},
    {7, 0, line_pull, "pull ID X,Y,Z RADIUS TX,TY,TZ NEWTONS_PER_METRE"},
    {3, 0, line_release, "release ID"},
    {5, 2, script_line_move, "move BODY X,Y,Z QX,QY,QZ,QW [about X,Y,Z]"},
};

static const char *const verb_names[] = {"contract", "gravity", "force",   "displace", "pressure",
                                         "traction", "pull",    "release", "move"};

enum { VERBS = sizeof verbs / sizeof *verbs };

/* The verb that a line's second word is, or -1 with e filled; `when`: the word that is to be before it. */
static int verb_of(const keyfile *k, const char *when, err *e)
{
    int v = 0;
    while (v < VERBS && strcmp(verb_names[v], k->word[1]))
        v++;
    if (v == VERBS)
        return near_unknown(e, k->name, k->line, "verb", k->word[1], verb_names, VERBS);
    if (k->count != verbs[v].words && (!verbs[v].more || k->count != verbs[v].words + verbs[v].more))
        return keyfile_error(k, e, "%d words; expected %s%s", k->count, when, verbs[v].expected);
    return v;
}

static int take_line(reader *r, err *e)
{
    const keyfile *k = &r->k;
    double time;
    if (num_double(k->word[0], &time) || time < 0)
        return keyfile_error(k, e, "'%.200s' is not a time; expected TIME VERB ..., TIME in seconds from 0",
                             k->word[0]);
    if (k->count == 1)
        return keyfile_error(k, e, "a time alone; expected TIME VERB ..., such as TIME %s", verbs[0].expected);
    const int v = verb_of(k, "TIME ", e);
    return v < 0 ? -1 : verbs[v].take(r, time, e);
}

/* Brings the keys of each curve together, in the order of the curves. */
static int gather_keys(reader *r, err *e)
{
    script *s = r->s;
    if (script_reserve(s, r->count, e))
        return -1;
    for (int64_t i = r->first; i < s->curves; i++) {
        s->curve[i].key_first = (int32_t)s->keys;
        s->keys += s->curve[i].key_count;
        s->curve[i].key_count = 0;
    }
    for (int64_t i = 0; i < r->count; i++) {
        const entry *n = &r->entries[i];
        script_curve *c = &s->curve[n->curve];
        int64_t to = c->key_first + c->key_count++;
        s->time[to] = n->time;
        memcpy(s->value + 3 * to, n->value, sizeof n->value);
    }
    return 0;
}

/* Says which lines both displace a component of a node. */
static int refuse_conflicts(reader *r, err *e)
{
    const script *s = r->s;
    const int64_t nodes = model_count(r->m, "node"), films = model_count(r->m, "bone");
    int32_t *owner = mem_array(3 * ((nodes < 0 ? 0 : nodes) + (films < 0 ? 0 : films)), sizeof *owner,
                               "the script's nodes", e); /* curve + 1 */
    int status = owner ? 0 : -1;
    for (int64_t i = 0; i < s->curves && !status; i++) {
        const script_curve *c = &s->curve[i];
        const bool prescribes = c->verb == SCRIPT_DISPLACE || c->verb == SCRIPT_MOVE;
        for (int64_t j = 0; prescribes && j < c->node_count && !status; j++)
            for (int a = 0; a < 3 && !status; a++) {
                int32_t node = s->node[c->node_first + j], *to = &owner[3 * (int64_t)node + a];
                if (!(c->mask >> a & 1))
                    continue;
                if (*to)
                    status = err_set(e, r->k.name, c->line,
                                     "component %c of node %d is displaced by line %" PRId64
                                     " too; expected targets apart, or '-' in one",
                                     'x' + a, node, s->curve[*to - 1].line);
                *to = (int32_t)(i + 1);
            }
    }
    free(owner);
    return status;
}

/* All lines of a file. nothing: the message where it has none. */
static int read_lines(reader *r, in *source, int (*take)(reader *r, err *e), const char *nothing, err *e)
{
    int more;
    keyfile_open(&r->k, source);
    while ((more = keyfile_next(&r->k, e)) > 0)
        if (take(r, e))
            return -1;
    if (more < 0)
        return -1;
    if (!r->count)
        return err_set(e, in_name(source), 0, "nothing in it; expected lines %s", nothing);
    return gather_keys(r, e) || refuse_conflicts(r, e) ? -1 : 0;
}

int script_read(script *s, in *source, const model *m, err *e)
{
    reader r = {.s = s, .m = m, .first = s->curves};
    if (!s->file && !(s->file = mem_text(in_name(source), e)))
        return -1;
    script_near(m, r.near);
    const int status = read_lines(&r, source, take_line, "TIME VERB ..., such as 0 gravity 0,0,-9.81", e);
    free(r.entries);
    return status;
}

int script_read_poses(script *s, in *source, const model *m, const pose *place, err *e)
{
    reader r = {.s = s, .m = m, .first = s->curves, .place = place};
    const int status =
        read_lines(&r, source, script_line_pose, "BODY time tx ty tz qx qy qz qw, such as jaw 0 0 0 0 0 0 0 1", e);
    free(r.entries);
    return status;
}

/* ---- Live */

enum { LIVE_CURVES = 1000 }; /* the most that there may be */

/* A line that begins with its verb, as one that begins with the word now, which is the caller's. */
static keyfile with_now(const keyfile *k, char *now)
{
    keyfile with = *k;
    if (!strcmp(k->word[0], now) || k->count == KEYFILE_WORDS)
        return with;
    memmove(with.word + 1, k->word, (size_t)k->count * sizeof *k->word);
    with.word[0] = now;
    with.count++;
    return with;
}

bool script_is_now(const keyfile *k)
{
    const char *word = k->word[0];
    return !strcmp(word, "now") || !strcmp(word, "pull") || !strcmp(word, "release");
}

/* Takes back what was added past the counts of before. */
static void take_back(script *s, const script *before)
{
    for (int64_t i = before->curves; i < s->curves; i++) {
        free(s->curve[i].target);
        free(s->curve[i].surface);
        activation_free(&s->curve[i].active);
    }
    s->curves = before->curves;
    s->keys = before->keys;
    s->nodes = before->nodes;
    s->triangles = before->triangles;
}

/* Whether a curve that a live line made does nothing any more. */
static bool is_over(const script *s, const script_curve *c)
{
    if (!c->is_live)
        return false;
    if (c->verb == SCRIPT_PULL)
        return c->is_released;
    if (c->verb != SCRIPT_FORCE && c->verb != SCRIPT_TRACTION && c->verb != SCRIPT_PRESSURE)
        return false;
    const double *last = s->value + 3 * (int64_t)c->own;
    return last[0] == 0 && last[1] == 0 && last[2] == 0;
}

static void drop_with_spring(script *s, int64_t curve)
{
    if (s->curve[curve].verb == SCRIPT_PULL)
        script_drop(s, curve + 1);
    script_drop(s, curve);
}

/* All curves before `added` that are over, and the one that the line replaced. */
static void drop_old(script *s, int64_t added, int64_t replaced)
{
    for (int64_t i = added - 1; i >= 0; i--)
        if (i == replaced || is_over(s, &s->curve[i]))
            drop_with_spring(s, i);
}

static int take_verb(reader *r, err *e)
{
    const int64_t before = r->s->curves;
    const keyfile *k = &r->k;
    if (k->count < 2)
        return keyfile_error(k, e, "'now' alone; expected now VERB ..., such as now %s", verbs[0].expected);
    const int v = verb_of(k, "now ", e);
    if (v < 0 || verbs[v].take(r, r->now->from, e))
        return -1;
    if (r->s->curves == before)
        return 0;
    if (r->s->curves > LIVE_CURVES)
        return keyfile_error(k, e, "more than %d targets; expected pulls to be released, or forces of 0", LIVE_CURVES);
    const script_verb verb = r->s->curve[before].verb;
    return verb == SCRIPT_DISPLACE || verb == SCRIPT_MOVE ? refuse_conflicts(r, e) : 0;
}

int script_take_now(script *s, const model *m, const keyfile *k, const script_now *now, bool *anew, err *e)
{
    char word[] = "now";
    reader r = {.s = s, .m = m, .k = with_now(k, word), .now = now, .gone = -1};
    const script before = *s;
    script_near(m, r.near);
    if (take_verb(&r, e)) {
        take_back(s, &before);
        return -1;
    }
    if (s->curves == before.curves)
        return 0;
    *anew = true;
    for (int64_t i = before.curves; i < s->curves; i++)
        s->curve[i].is_live = true;
    drop_old(s, before.curves, r.gone);
    return 0;
}
