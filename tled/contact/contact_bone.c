#include "tled/contact/contact_bone.h"

#include <math.h>
#include <string.h>

enum { SAMPLES_CHUNK = 64 };

/* ---- the bones' motions */

static sliding_bone bone_at(const self_contact_work *w, int32_t which, const double *value)
{
    static const sliding_bone rest = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};
    return value ? sliding_bone_at(w->c->bones, which, value) : rest;
}

static void move_bones(self_contact_work *w, const double *was, const double *is)
{
    const sliding *s = w->c->bones;
    for (int32_t k = 0; k < w->c->solids; k++) {
        contact_solid *at = &w->solid[k];
        const int32_t which = w->c->solid[k];
        const sliding_bone next = bone_at(w, which, is);
        at->was = bone_at(w, which, was);
        at->drift += contact_bone_way(&s->field[which], s->ground.spacing, at->is_placed ? &at->is : &at->was, &next);
        at->is = next;
        at->is_placed = true;
    }
}

/* ---- a sample */

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
            contact_place(w->c, w->x, sample, x);
        placed = true;
        if (contact_touches_bone(w->c, w->x, x, &w->c->bones->ground, w->c->solid[k], &w->solid[k].was, &w->solid[k].is,
                                 w->c->bone_rest[k * w->c->samples + sample], &t, &clear) &&
            (!deepest->sides || t.off < deepest->off))
            *deepest = t;
        *until = clear > 0 ? drift + CONTACT_SPARE * clear : 0;
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
