#include "tled/muscle/muscles.h"
#include "tled/problem/script.h"

#include "base/mem.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

static bool rises(const script *s, const script_curve *c)
{
    bool any = false;
    for (int32_t i = 0; i < c->key_count; i++)
        any |= s->value[3 * ((int64_t)c->key_first + i)] > 0;
    return any;
}

/* What makes a muscle's level rise above 0 at any time: its own curve, or an expression's; NULL: nothing does. */
static const script_curve *contracted_by(const script *s, const script_curve *c)
{
    if (c->verb != SCRIPT_CONTRACT)
        return NULL;
    if (rises(s, c))
        return c;
    for (int64_t i = 0; i < s->terms; i++)
        if (s->curve + s->term[i].contract == c && s->term[i].factor > 0 && rises(s, s->curve + s->term[i].express))
            return s->curve + s->term[i].express;
    return NULL;
}

static bool is_idle(const script *s, const script_curve *c, const fitness *of)
{
    return contracted_by(s, c) && !of[c->volume].moving;
}

/* Warns of the muscles that cannot contract, or refuses where none can. */
static int weigh(const script *s, const model *m, const fitness *of, notes *warnings, err *e)
{
    int64_t driven = 0, idle = 0;
    char why[300];
    for (int64_t i = 0; i < s->curves; i++) {
        driven += contracted_by(s, &s->curve[i]) != NULL;
        idle += is_idle(s, &s->curve[i], of);
    }
    for (int64_t i = 0; i < s->curves; i++) {
        if (!is_idle(s, &s->curve[i], of))
            continue;
        const int32_t volume = s->curve[i].volume;
        const script_curve *by = contracted_by(s, &s->curve[i]);
        const int64_t line = by->line; /* 0: of the command line */
        const char *place = script_place(s, by);
        const char *name = model_find(m, "volume.name")->str[volume];
        say_why(m, &of[volume], why, sizeof why);
        if (idle == driven && driven == 1)
            return err_set(e, place, line, "%.200s cannot contract: %s", name, why);
        if (idle == driven)
            return err_set(e, place, line, "none of the %" PRId64 " muscles can contract; %.200s: %s", driven, name,
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
        any |= contracted_by(s, &s->curve[i]) != NULL;
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
