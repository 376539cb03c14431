#include "fibre_rule.h"

#include "base/near.h"
#include "cli/spelling.h"
#include "fibre_field.h"
#include "mesh/lattice.h"
#include "model/muscle_name.h"
#include "surface/surface.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Muscles that close an opening, by their names: a sphincter may also be in arcs, of which none is a ring. */
static const char *const sphincters[] = {"orbicularis*", "sphincter*", "oom*", "oop*", "ooc*"};

/* ---- whether a rule applies */

static bool closes_opening(const fibre_case *c)
{
    bool named = false;
    for (size_t i = 0; i < sizeof sphincters / sizeof *sphincters; i++)
        named |= surface_in_group(muscle_name_short(c->of->name), sphincters[i]);
    return c->ring || (named && c->of->elements);
}

static bool has_shape(const fibre_case *c)
{
    return c->shape && c->of->elements;
}

static bool has_elements(const fibre_case *c)
{
    return c->of->elements > 1;
}

static bool has_axis(const fibre_case *c)
{
    return c->of->axis[0] != 0 || c->of->axis[1] != 0 || c->of->axis[2] != 0;
}

static bool always(const fibre_case *c)
{
    (void)c;
    return true;
}

/* ---- what it does */

/* Elements: with more of them, the threads share the loops over one muscle; with fewer, such loops are too short. */
enum { MANY = 1 << 15 };

/* The muscle's attachments are found again, since b->part holds one muscle's. */
static muscle_field *open_voxels(fibre_case *c, attachments *own, err *e)
{
    lattice grid;
    if (attachments_find(own, c->b, c->index, c->of->volume, e))
        return NULL;
    if (!c->voxels->of && !lattice_of(c->m, &grid, e))
        c->voxels->of = field_create(c->b, grid.spacing, e);
    return c->voxels->of ? field_open(c->voxels->of, c->of->volume, e) : NULL;
}

static int fill_field(fibre_case *c, err *e)
{
    attachments own = {0};
    c->is_left = !c->threads && c->of->elements > MANY;
    if (!c->of->elements || c->is_left)
        return 0;
    pthread_mutex_lock(&c->voxels->lock);
    muscle_field *m = open_voxels(c, &own, e);
    pthread_mutex_unlock(&c->voxels->lock);
    const int rc = m ? field_fibres(m, c->threads, own.of, own.count, NULL, e) : -1;
    field_close(m);
    free(own.of);
    return rc;
}

static int fill_shape(fibre_case *c, err *e)
{
    return c->shape ? muscle_shape_fibres(c->shape, c->b, c->of->volume, e) : fill_field(c, e);
}

/* Round its own line; what is no ring is an arc of a sphincter, and has its fibres from end to end. */
static int fill_round(fibre_case *c, err *e)
{
    const body *b = c->b;
    double centre[3], along[3];
    if (!c->ring)
        return fill_shape(c, e);
    for (int64_t at = b->start[c->of->volume]; at < b->start[c->of->volume + 1]; at++) {
        body_centre(b, b->element[at], centre);
        ring_along(c->ring, centre, along);
        for (int a = 0; a < 3; a++)
            body_fibre(b, b->element[at], c->of->volume)[a] = (float)along[a];
    }
    return 0;
}

#define ROW(rule, name, applies, fill, what) [rule] = {name, what, applies, fill},
const fibre_rule fibre_rules[MUSCLE_RULES] = {
    ROW(MUSCLE_ROUND, "round", closes_opening, fill_round, "round the opening of a ring, along the arcs of a sphincter")
        ROW(MUSCLE_SHAPE, "shape", has_shape, fill_shape, "from end to end through the muscle's own closed surface")
            ROW(MUSCLE_FIELD, "field", has_elements, fill_field, "from end to end through the muscle's voxels")
                ROW(MUSCLE_AXIS, "axis", has_axis, NULL, "along the longest axis of the muscle's voxels")
                    ROW(MUSCLE_CENTRE, "centre", always, NULL, "straight toward the contraction centre")};

muscle_fibre fibre_rule_for(const fibre_case *c)
{
    for (int i = 0; i < MUSCLE_RULES; i++)
        if (fibre_rules[i].applies(c))
            return (muscle_fibre)i;
    return MUSCLE_CENTRE;
}

/* ---- --fibre */

/* The rule that a value names, in either spelling; -1: by default ("auto"). -2 with e filled. */
static int rule_named(const char *value, err *e)
{
    char british[16] = "";
    const char *equals = strrchr(value, '='), *name = equals ? equals + 1 : value;
    spelling_british(name, strlen(name), british, sizeof british);
    for (int i = 0; i < MUSCLE_RULES; i++)
        if (!strcmp(fibre_rules[i].name, name) || !strcmp(fibre_rules[i].name, british))
            return i;
    if (!strcmp(name, "auto"))
        return -1;
    err_usage(e, "--fibre '%.200s': expected " MUSCLE_RULE_NAMES ", or MUSCLES=RULE", value);
    return -2;
}

/* Gives the rule to the muscles that a pattern names. Returns how many. */
static int64_t ask(muscles *list, const char *pattern, int rule)
{
    int64_t found = 0;
    for (int64_t i = 0; i < list->count; i++)
        if (surface_in_group(list->of[i].name, pattern) ||
            surface_in_group(muscle_name_short(list->of[i].name), pattern)) {
            list->of[i].asked = rule;
            found++;
        }
    return found;
}

static int no_muscle(const muscles *list, const char *pattern, err *e)
{
    const char **names = calloc((size_t)list->count + 1, sizeof *names);
    for (int64_t i = 0; names && i < list->count; i++)
        names[i] = list->of[i].name;
    near_option(e, "--fibre", "muscle", pattern, names, names ? (int)list->count : 0);
    free(names);
    return -1;
}

static int take_value(muscles *list, const char *value, err *e)
{
    const char *equals = strrchr(value, '=');
    const int rule = rule_named(value, e);
    if (rule == -2)
        return -1;
    for (int64_t i = 0; !equals && i < list->count; i++)
        list->of[i].asked = rule;
    for (const char *p = value; equals && p < equals;) {
        char pattern[MODEL_NAME];
        const size_t word = strcspn(p, ","), left = (size_t)(equals - p), n = word < left ? word : left;
        snprintf(pattern, sizeof pattern, "%.*s", (int)(n < sizeof pattern ? n : 0), p);
        if (*pattern && !ask(list, pattern, rule))
            return no_muscle(list, pattern, e);
        p += n + 1;
    }
    return 0;
}

int fibre_rules_asked(muscles *list, const opt_list *values, err *e)
{
    for (int64_t i = 0; i < list->count; i++)
        list->of[i].asked = -1;
    for (int i = 0; i < values->count; i++)
        if (take_value(list, values->value[i], e))
            return -1;
    return 0;
}

int fibre_rules_check(const opt_list *values, err *e)
{
    for (int i = 0; i < values->count; i++)
        if (rule_named(values->value[i], e) == -2)
            return -1;
    return 0;
}

bool fibre_rules_single(const opt_list *values)
{
    bool single = values->count > 0;
    for (int i = 0; i < values->count; i++)
        single = single && !strchr(values->value[i], '=') && strcmp(values->value[i], "auto") != 0;
    return single;
}
