#include "tled/run/tled_frame.h"

#include "base/mem.h"
#include "tled/contact/sliding_loads.h"
#include "tled/problem/bodies.h"
#include "tled/problem/film_strain.h"
#include "tled/run/tled_live.h"

#include <stdlib.h>
#include <string.h>

int tled_frame_results(session *s, const struct options *o, err *e)
{
    if (!o->which)
        return 0;
    s->activation = mem_array(s->problem.volumes, sizeof *s->activation, "the results", e);
    return s->activation ? results_create(&s->results, &s->m, o->which, s->folds.threads, e) : -1;
}

static int offer(session *s, const char *const *names, int count, err *e)
{
    for (int i = 0; i < count; i++)
        if (frame_choice_offer(&s->frames, names[i], 0, e))
            return -1;
    return 0;
}

static int offer_fields(session *s, err *e)
{
    const fields *f = &s->problem.fields;
    for (int i = 0; i < f->count; i++)
        if (fields_is_in(f, i, FIELD_IN_FRAMES) && frame_choice_offer(&s->frames, f->field[i].name, 0, e))
            return -1;
    return 0;
}

static int offer_results(session *s, unsigned which, err *e)
{
    for (int i = 0; i < RESULTS; i++)
        if (which >> i & 1 && frame_choice_offer(&s->frames, results_array(i), FRAME_CHOICE_ALWAYS, e))
            return -1;
    return 0;
}

int tled_frame_choose(session *s, const struct options *o, err *e)
{
    static const char *const of_probe[] = {"probe.pose", "probe.force", "probe.torque"};
    static const char *const of_bodies[] = {"body.pose", "body.force", "body.torque"}, *const of_bone[] = {
                                                                                           "bone.displacement"};
    if (offer_fields(s, e) || (s->collider.poses && offer(s, of_probe, 3, e)) ||
        (films_count(&s->problem) && offer(s, of_bone, 1, e)) ||
        (bodies_count(&s->problem) && offer(s, of_bodies, 3, e)) || offer_results(s, o->which, e) ||
        frame_choice_offer_bound(&s->frames, &s->m, e) || frame_choice_read(&s->frames, &o->frames, e))
        return -1;
    if (!frame_choice_has(&s->frames, "node.velocity"))
        tled_problem_still(&s->problem);
    return 0;
}

/* Writes it first: who waits for it need not wait for what is to be said of it. displacement: nodes x 3, m; NULL: it is
 * not known. */
static int put_frame(session *s, const frame *f, const double *displacement, err *e)
{
    if (stage_written(&s->stage, e) || model_write_frame(s->stage.writer, f, e) || out_failed(s->stage.sink, e))
        return -1;
    if (displacement)
        folds_add(&s->folds, f->time, displacement);
    return 0;
}

/* Where the probe is, and what pushes it; live, not before its first pose. */
static int add_probe(const session *s, frame *f, const double *displacement, err *e)
{
    if (!s->collider.poses)
        return 0;
    if (!s->live) {
        const collider_moment now = collider_moment_at(&s->collider, f->time);
        return collider_add(&s->problem, &now, f, &s->m, displacement, e);
    }
    const collider_moment *now = live_moment(s->live);
    return now ? collider_add(&s->problem, now, f, &s->m, displacement, e) : 0;
}

/* Bound surfaces on rigid bodies move with these. */
static bool takes_bodies(const session *s)
{
    return bodies_count(&s->problem) && (frame_choice_has_of(&s->frames, "body.") || frame_choice_moves(&s->frames));
}

bool tled_frame_takes_curves(const session *s)
{
    return takes_bodies(s) || films_count(&s->problem) || s->problem.sliding || s->results;
}

/* The curves' values at a frame's time. *own is the caller's to free. NULL with e filled. */
static const double *curves_at(const session *s, double time, double **own, err *e)
{
    *own = NULL;
    if (s->live)
        return live_values(s->live);
    *own = mem_array(s->script.curves, 3 * sizeof **own, "a frame", e);
    if (*own)
        tled_curves(&s->problem, time, *own);
    return *own;
}

static int add_results(session *s, frame *f, const double *value, err *e)
{
    if (!s->results)
        return 0;
    for (int32_t i = 0; i < s->problem.volumes; i++)
        s->activation[i] = tled_activation(&s->problem, i, value);
    return results_add(s->results, f, s->activation, e);
}

/* Adds how the bone of each film has moved. Every frame has it, as all frames of a model have the same arrays. */
static int add_bone(const session *s, frame *f, const double *value, err *e)
{
    if (!films_count(&s->problem))
        return 0;
    model_array *to = frame_add(f, &s->m, "bone.displacement", e);
    for (int64_t i = 0; to && i < films_count(&s->problem); i++) {
        const film_bone bone = films_bone(&s->problem, i, value);
        memcpy(to->f64 + 3 * i, bone.u, sizeof bone.u);
    }
    return to ? 0 : -1;
}

/* The most nodes that a frame has beyond the distance field of their bone. */
static void note_beyond(session *s, const bodies_state *now)
{
    int64_t beyond = 0;
    if (s->problem.sliding && now->value)
        sliding_worst(&s->problem, now->value, now->displacement, &beyond);
    s->beyond = beyond > s->beyond ? beyond : s->beyond;
}

/* Where bone and bodies are, and what the tissue pulls these with; and what elements hold. */
static int add_looks(session *s, frame *f, const field_values *state, err *e)
{
    const int count = s->problem.fields.count;
    double *own;
    if (!tled_frame_takes_curves(s))
        return 0;
    const double *value = curves_at(s, f->time, &own, e);
    const bodies_state now = {value,
                              state->of[TLED_DISPLACEMENT],
                              {count > TLED_CONTRACTILE ? state->of[TLED_CONTRACTILE] : NULL,
                               count > TLED_MIXCONTRACTILE ? state->of[TLED_MIXCONTRACTILE] : NULL}};
    note_beyond(s, &now);
    const int failed = (!value && !s->live) || add_bone(s, f, value, e) ||
                               (takes_bodies(s) && bodies_add(&s->problem, s->folds.threads, &now, f, &s->m, e)) ||
                               sliding_add(&s->problem, s->folds.threads, &now, f, e) || add_results(s, f, value, e)
                           ? -1
                           : 0;
    free(own);
    return failed;
}

int tled_frame_write(void *context, double time, const field_values *state, err *e)
{
    session *s = context;
    frame f = {.index = s->next_frame++, .time = time};
    const double *u = state->of[TLED_DISPLACEMENT];
    bool whole = !fields_lend(&s->problem.fields, FIELD_IN_FRAMES, state, &f, &s->m, e) && !add_probe(s, &f, u, e) &&
                 !add_looks(s, &f, state, e) &&
                 !frame_choice_add_surfaces(&s->frames, &f, &s->m, u, s->folds.threads, e);
    if (whole)
        frame_choice_take(&s->frames, &f);
    int result = whole && !put_frame(s, &f, u, e) && !(s->checkpoint && checkpoint_add(s->checkpoint, &f, e)) ? 0 : -1;
    frame_free(&f);
    if (s->live)
        live_written(s->live);
    return result;
}

void tled_frame_last(void *context, const field_values *state)
{
    session *s = context;
    folds_end(&s->folds, state->of[TLED_DISPLACEMENT]);
}

int tled_frame_replay(void *context, const frame *f, err *e)
{
    session *s = context;
    const model_array *u = frame_find(f, "node.displacement");
    const double *displacement = u && u->rows == s->problem.nodes ? u->f64 : NULL;
    s->next_frame = f->index + 1;
    if (put_frame(s, f, displacement, e))
        return -1;
    if (displacement)
        folds_end(&s->folds, displacement); /* nothing may come after it */
    return 0;
}
