#include "base/mem.h"
#include "base/near.h"
#include "base/num.h"
#include "mesh/lattice.h"
#include "surface/surface.h"
#include "tled/problem/script.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One line of a file, until the keys of each curve are brought together. */
typedef struct entry {
    int64_t curve;
    double time, value[3];
} entry;

typedef struct reader {
    script *s;
    const model *m;
    keyfile k;
    entry *entries;
    int64_t count, capacity;
    int64_t first;  /* curves before these came from the command line */
    double near[3]; /* m: how far past a box a node may be that counts as on its face, along each axis */
} reader;

/* Nodes of a target: appended to s->node as those of the curve added last. */

static int node_add(script *s, int64_t node, err *e)
{
    if (s->nodes >= INT32_MAX)
        return err_set(e, NULL, 0, "the script's targets have more than %d nodes in all", INT32_MAX);
    if (mem_grow(&s->node, &s->node_capacity, s->nodes + 1, sizeof *s->node, "the script's nodes", e))
        return -1;
    s->node[s->nodes++] = (int32_t)node;
    s->curve[s->curves - 1].node_count++;
    return 0;
}

static int nodes_in_ball(reader *r, const script_curve *c, err *e)
{
    const model_array *position = model_need(r->m, "node.position", e);
    if (!position)
        return -1;
    double nearest = INFINITY, *p = position->f64;
    int64_t found = 0;
    for (int64_t i = 0; i < position->rows; i++, p += 3) {
        double away = hypot(hypot(p[0] - c->box[0], p[1] - c->box[1]), p[2] - c->box[2]);
        nearest = away < nearest ? away : nearest;
        if (away > c->box[3] + fmax(r->near[0], fmax(r->near[1], r->near[2])))
            continue;
        if (node_add(r->s, i, e))
            return -1;
        found++;
    }
    if (!found)
        return keyfile_error(&r->k, e, "no node lies within %g m of %g,%g,%g; the nearest is %g m away", c->box[3],
                             c->box[0], c->box[1], c->box[2], nearest);
    return 0;
}

static int nodes_in_box(reader *r, const script_curve *c, err *e)
{
    const model_array *position = model_need(r->m, "node.position", e);
    int64_t found = 0;
    for (int64_t i = 0; position && i < position->rows; i++) {
        const double *p = position->f64 + 3 * i, *low = c->box, *high = c->box + 3;
        bool outside = false;
        for (int a = 0; a < 3; a++)
            outside |= p[a] < low[a] - r->near[a] || p[a] > high[a] + r->near[a];
        if (outside)
            continue;
        if (node_add(r->s, i, e))
            return -1;
        found++;
    }
    if (position && !found)
        return keyfile_error(&r->k, e,
                             "no node lies in the box %s; expected X0,Y0,Z0,X1,Y1,Z1 around some, in metres "
                             "or with suffixes",
                             c->target);
    return position ? 0 : -1;
}

static int nodes_of_surface(reader *r, const script_curve *c, err *e)
{
    const model_array *anchor = model_need(r->m, "node.anchor", e), *names = model_need(r->m, "anchor.name", e);
    if (!anchor || !names)
        return -1;
    bool known = false;
    for (int64_t i = 0; i < names->rows; i++)
        known = known || surface_in_group(names->str[i], c->target);
    if (!known)
        return near_unknown(e, r->k.name, r->k.line, "rigid surface", c->target, (const char *const *)names->str,
                            names->rows < INT32_MAX ? (int)names->rows : INT32_MAX);
    int64_t found = 0;
    for (int64_t i = 0; i < anchor->rows; i++) {
        int32_t a = anchor->i32[i];
        if (a < 0 || !surface_in_group(names->str[a], c->target))
            continue;
        if (node_add(r->s, i, e))
            return -1;
        found++;
    }
    return found
               ? 0
               : keyfile_error(&r->k, e, "no node is held by '%.200s'; expected a surface that holds some", c->target);
}

/* Lines of a file */

/* Numbers in metres, with suffixes or without; exactly count. */
static int take_lengths(reader *r, const char *text, int count, double *value, const char *expected, err *e)
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

/* The curve for this line: the one that an earlier line began, or a new one (*fresh). -1 with e filled. */
static int64_t curve_of(reader *r, const script_curve *c, bool *fresh, err *e)
{
    int64_t at = script_find(r->s, c);
    *fresh = at < 0;
    if (at >= 0 && at < r->first)
        return keyfile_error(&r->k, e, "'%.200s' is set on the command line too; expected one of them", c->target);
    return at < 0 ? script_add(r->s, c, e) : at;
}

static int key_add(reader *r, int64_t at, double time, const double *value, err *e)
{
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

static int line_contract(reader *r, double time, err *e)
{
    const keyfile *k = &r->k;
    double value[3] = {0};
    script_curve c = {.verb = SCRIPT_CONTRACT, .line = k->line, .target = k->word[2]};
    c.volume = script_muscle(r->m, k->word[2], k->name, k->line, e);
    if (c.volume < 0)
        return -1;
    if (script_level(k->word[3], &value[0]))
        return keyfile_error(k, e, "level '%.200s'; expected a number from 0 to 1", k->word[3]);
    bool fresh;
    int64_t at = curve_of(r, &c, &fresh, e);
    return at < 0 ? -1 : key_add(r, at, time, value, e);
}

static int line_gravity(reader *r, double time, err *e)
{
    double value[3];
    char target[] = "gravity";
    script_curve c = {.verb = SCRIPT_GRAVITY, .volume = -1, .line = r->k.line, .target = target};
    if (take_numbers(r, 2, value, "X,Y,Z in m/s2", e))
        return -1;
    bool fresh;
    int64_t at = curve_of(r, &c, &fresh, e);
    return at < 0 ? -1 : key_add(r, at, time, value, e);
}

static int line_force(reader *r, double time, err *e)
{
    double value[3];
    script_curve c = {.verb = SCRIPT_FORCE, .volume = -1, .line = r->k.line, .target = r->k.word[2]};
    if (take_lengths(r, r->k.word[2], 3, c.box, "X,Y,Z: a point, in metres or with suffixes", e) ||
        take_lengths(r, r->k.word[3], 1, c.box + 3, "a radius, in metres or with a suffix", e) ||
        take_numbers(r, 4, value, "FX,FY,FZ in N", e))
        return -1;
    if (c.box[3] <= 0)
        return keyfile_error(&r->k, e, "radius '%.200s'; expected more than 0", r->k.word[3]);
    bool fresh;
    int64_t at = curve_of(r, &c, &fresh, e);
    if (at < 0 || (fresh && nodes_in_ball(r, &c, e)))
        return -1;
    return key_add(r, at, time, value, e);
}

static int take_box(reader *r, const char *text, double *box, err *e)
{
    if (take_lengths(r, text, 6, box, "X0,Y0,Z0,X1,Y1,Z1: a box, in metres or with suffixes", e))
        return -1;
    for (int a = 0; a < 3; a++)
        if (box[a] > box[a + 3])
            return keyfile_error(&r->k, e, "box %.200s is empty: %g > %g; expected the low corner first", text, box[a],
                                 box[a + 3]);
    return 0;
}

static int line_displace(reader *r, double time, err *e)
{
    double value[3];
    script_curve c = {.verb = SCRIPT_DISPLACE, .volume = -1, .line = r->k.line, .target = r->k.word[2]};
    bool box = strchr(c.target, ',') != NULL, fresh;
    if ((box && take_box(r, c.target, c.box, e)) || take_displacement(r, 3, value, &c.mask, e))
        return -1;
    int64_t at = curve_of(r, &c, &fresh, e);
    if (at < 0 || (fresh && (box ? nodes_in_box : nodes_of_surface)(r, &c, e)))
        return -1;
    if (r->s->curve[at].mask != c.mask)
        return keyfile_error(&r->k, e,
                             "'%.200s' frees other components than line %" PRId64
                             " does; expected the same in all lines of a target",
                             r->k.word[3], r->s->curve[at].line);
    return key_add(r, at, time, value, e);
}

/* On a bound surface or a region of it. */
static int add_to_surface(reader *r, script_verb verb, double time, const double *value, err *e)
{
    char name[MODEL_NAME];
    script_curve c = {.verb = verb, .volume = -1, .line = r->k.line, .target = r->k.word[2]};
    const char *region = script_region(&c);
    if (script_take_surface(&c, r->m, &r->k, name, e) ||
        (region && strchr(region, ',') && take_box(r, region, c.box, e)))
        return -1;
    c.is_region = region != NULL;
    bool fresh;
    int64_t at = curve_of(r, &c, &fresh, e);
    if (at < 0 || (fresh && script_take_triangles(r->s, r->m, &r->k, e)))
        return -1;
    return key_add(r, at, time, value, e);
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

static const struct verb {
    int words;
    int (*take)(reader *r, double time, err *e);
    const char *expected;
} verbs[] = {
    [SCRIPT_CONTRACT] = {4, line_contract, "TIME contract MUSCLE LEVEL"},
    [SCRIPT_GRAVITY] = {3, line_gravity, "TIME gravity X,Y,Z"},
    [SCRIPT_FORCE] = {5, line_force, "TIME force X,Y,Z RADIUS FX,FY,FZ"},
    [SCRIPT_DISPLACE] = {4, line_displace, "TIME displace SURFACE|X0,Y0,Z0,X1,Y1,Z1 UX,UY,UZ"},
    [SCRIPT_PRESSURE] = {4, line_pressure, "TIME pressure SURFACE[:GROUP|:X0,Y0,Z0,X1,Y1,Z1] PA"},
    [SCRIPT_TRACTION] = {4, line_traction, "TIME traction SURFACE[:GROUP|:X0,Y0,Z0,X1,Y1,Z1] X,Y,Z"},
};

static const char *const verb_names[] = {
    [SCRIPT_CONTRACT] = "contract", [SCRIPT_GRAVITY] = "gravity",   [SCRIPT_FORCE] = "force",
    [SCRIPT_DISPLACE] = "displace", [SCRIPT_PRESSURE] = "pressure", [SCRIPT_TRACTION] = "traction"};

enum { VERBS = sizeof verbs / sizeof *verbs };

static int take_line(reader *r, err *e)
{
    const keyfile *k = &r->k;
    double time;
    if (num_double(k->word[0], &time) || time < 0)
        return keyfile_error(k, e, "'%.200s' is not a time; expected TIME VERB ..., TIME in seconds from 0",
                             k->word[0]);
    if (k->count == 1)
        return keyfile_error(k, e, "a time alone; expected TIME VERB ..., such as %s", verbs[0].expected);
    int v = 0;
    while (v < VERBS && strcmp(verb_names[v], k->word[1]))
        v++;
    if (v == VERBS)
        return near_unknown(e, k->name, k->line, "verb", k->word[1], verb_names, VERBS);
    if (k->count != verbs[v].words)
        return keyfile_error(k, e, "%d words; expected %s", k->count, verbs[v].expected);
    return verbs[v].take(r, time, e);
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
    int64_t nodes = model_count(r->m, "node");
    int32_t *owner = mem_array(3 * (nodes < 0 ? 0 : nodes), sizeof *owner, "the script's nodes", e); /* curve + 1 */
    int status = owner ? 0 : -1;
    for (int64_t i = 0; i < s->curves && !status; i++) {
        const script_curve *c = &s->curve[i];
        for (int64_t j = 0; c->verb == SCRIPT_DISPLACE && j < c->node_count && !status; j++)
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

/* Sides of voxels are seldom whole in binary: 3 x 1.1 mm is more than 3.3 mm by a rounding. */
static void take_near(reader *r)
{
    lattice l;
    err none = {0};
    bool known = model_meta_of(r->m, "lattice.spacing") && !lattice_of(r->m, &l, &none);
    for (int a = 0; a < 3; a++)
        r->near[a] = known ? 1e-9 * l.spacing[a] : 0;
}

int script_read(script *s, in *source, const model *m, err *e)
{
    reader r = {.s = s, .m = m, .first = s->curves};
    int more, status = -1;
    if (!s->file && !(s->file = mem_text(in_name(source), e)))
        return -1;
    keyfile_open(&r.k, source);
    take_near(&r);
    while ((more = keyfile_next(&r.k, e)) > 0)
        if (take_line(&r, e))
            goto out;
    if (more < 0)
        goto out;
    if (!r.count)
        err_set(e, in_name(source), 0, "nothing in it; expected lines TIME VERB ..., such as 0 gravity 0,0,-9.81");
    else
        status = gather_keys(&r, e) || refuse_conflicts(&r, e) ? -1 : 0;
out:
    free(r.entries);
    return status;
}
