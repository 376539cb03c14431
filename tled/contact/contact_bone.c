#include "tled/contact/contact_bone.h"

#include "tled/contact/contact_near.h"
#include "tled/contact/contact_touch.h"

#include <math.h>
#include <string.h>

enum { SAMPLES_CHUNK = 64 };

/* In shortest sides: what is deeper has come another way. */
static const double most_deep = 1;
/* Skin touches bone that it faces, by the cosine between its normal and the bone's, or where its own is not to be
 * trusted, at its edges. */
static const double facing = -.3, sure = .25;
/* A sample moves further than nodes where it is extrapolated: a share of what is clear. */
static const double spare_way = 1. / 8;

/* ---- the bones' motions */

static sliding_bone bone_at(const self_contact_work *w, int32_t which, const double *value)
{
    static const sliding_bone rest = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};
    return value ? sliding_bone_at(w->c->bones, which, value) : rest;
}

/* The most that a corner of a field's box has moved since the last step. */
static double most_moved(const sliding_field *f, const double spacing[3], const sliding_bone *from,
                         const sliding_bone *to)
{
    double most = 0;
    for (int c = 0; c < 8; c++) {
        double where[3], before[3], after[3], square = 0;
        for (int a = 0; a < 3; a++)
            where[a] = f->first[a] + (c >> a & 1 ? spacing[a] * (f->samples[a] - 1) : 0);
        sliding_move(from, where, before);
        sliding_move(to, where, after);
        for (int a = 0; a < 3; a++)
            square += (after[a] - before[a]) * (after[a] - before[a]);
        most = fmax(most, square);
    }
    return sqrt(most);
}

static void move_bones(self_contact_work *w, const double *was, const double *is)
{
    const sliding *s = w->c->bones;
    for (int32_t k = 0; k < w->c->solids; k++) {
        contact_solid *at = &w->solid[k];
        const int32_t which = w->c->solid[k];
        const sliding_bone next = bone_at(w, which, is);
        at->was = bone_at(w, which, was);
        at->drift += most_moved(&s->field[which], s->ground.spacing, at->is_placed ? &at->is : &at->was, &next);
        at->is = next;
        at->is_placed = true;
    }
}

/* ---- a sample */

/* Where a sample is to a bone: its depth as t->off. false: beyond its field, or nowhere near it. clear, m: how far it
 * may still go. */
static bool find_touch(const self_contact_work *w, int64_t sample, int32_t k, const double x[3], touch *t,
                       double *clear)
{
    const sliding_ground *g = &w->c->bones->ground;
    const contact_solid *at = &w->solid[k];
    const int32_t which = w->c->solid[k];
    double where[3], slope[3], before[3], after[3], own[3], dot = 0;
    for (int a = 0; a < 3; a++) {
        where[a] = 0;
        for (int i = 0; i < 3; i++)
            where[a] += at->is.turn[i][a] * (x[i] - at->is.to[i]);
    }
    *clear = w->c->shortest;
    if (sliding_beyond(g, which, where))
        return false;
    const double phi = sliding_distance(g, which, where, slope), length = sliding_length(slope);
    t->off = phi / fmax(length, SLIDING_SLOPE) - w->c->bone_rest[k * w->c->samples + sample];
    *clear = fmax(t->off, 0);
    if (!(t->off < 0) || t->off < -most_deep * w->c->shortest || !(length > 0))
        return false;
    for (int a = 0; a < 3; a++)
        t->normal[a] =
            (at->is.turn[a][0] * slope[0] + at->is.turn[a][1] * slope[1] + at->is.turn[a][2] * slope[2]) / length;
    sliding_move(&at->was, where, before);
    sliding_move(&at->is, where, after);
    const double trusted = contact_normal(w, sample, own);
    for (int a = 0; a < 3; a++) {
        t->carried[a] = after[a] - before[a];
        dot += own[a] * t->normal[a];
    }
    return dot < facing || trusted < sure;
}

/* The bone that a sample is deepest in, to the sample's place in w->bone_touch. */
static void find_deepest(const self_contact_work *w, int64_t sample)
{
    touch *deepest = &w->bone_touch[sample];
    double x[3];
    bool placed = false;
    deepest->sides = 0;
    for (int32_t k = 0; k < w->c->solids; k++) {
        double *until = &w->bone_until[k * w->c->samples + sample], clear;
        const double drift = w->drift + w->solid[k].drift;
        touch t = {.sample = (int32_t)sample, .element = -1, .sides = 1};
        if (drift < *until)
            continue;
        if (!placed)
            contact_place(w, sample, x);
        placed = true;
        if (find_touch(w, sample, k, x, &t, &clear) && (!deepest->sides || t.off < deepest->off))
            *deepest = t;
        *until = clear > 0 ? drift + spare_way * clear : 0;
    }
}

static void touch_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        find_deepest(context, i);
}

void contact_bones(self_contact_work *w, pool *threads, const double *was, const double *is)
{
    if (!w->c->solids)
        return;
    move_bones(w, was, is);
    pool_run(threads, w->c->samples, SAMPLES_CHUNK, touch_work, w);
    for (int64_t i = 0; i < w->c->samples; i++)
        if (w->bone_touch[i].sides)
            w->touch[w->touches++] = w->bone_touch[i];
}
