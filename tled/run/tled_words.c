#include "tled/run/tled_words.h"

#include "tled/loop/timeline.h"
#include "tled/problem/cut.h"
#include "tled/problem/films.h"
#include "tled/run/tled_live.h"

#include <math.h>
#include <stdio.h>

void words_start(const session *s, const char *device, const struct options *o)
{
    const tled_problem *p = &s->problem;
    const run_setup *r = &s->run;
    char sides[100];
    snprintf(sides, sizeof sides, "%g x %g x %g mm", 1e3 * p->side[0], 1e3 * p->side[1], 1e3 * p->side[2]);
    if (p->conforming)
        snprintf(sides, sizeof sides, "any shape, %.4g mm in the mean", 1e3 * p->side[0]);
    tool_say(s->t, "%lld elements of %s, %lld nodes, %lld held; %s, %s precision", (long long)p->elements, sides,
             (long long)p->nodes, (long long)p->held, device, o->precision ? "single" : "double");
    if (p->films)
        tool_say(s->t, "%lld films hang on bone", (long long)films_count(p));
    if (p->sliding)
        tool_say(s->t, "%lld nodes slide on bone, friction %g", (long long)p->sliding->count,
                 p->sliding->ground.friction);
    if (p->self_contact)
        tool_say(s->t, "%lld samples of skin may touch %lld elements, friction %g", (long long)p->self_contact->samples,
                 (long long)p->self_contact->elements, p->self_contact->friction);
    if (p->self_contact && p->self_contact->solids)
        tool_say(s->t, "and %d distance field%s of bone", (int)p->self_contact->solids,
                 p->self_contact->solids == 1 ? "" : "s");
    const int64_t least = cut_least(p);
    if (least)
        tool_say(s->t, "%lld cut element%s, of which less than %g is enclosed, the mass is that of %g",
                 (long long)least, least == 1 ? "" : "s", CUT_LEAST, CUT_LEAST);
    tool_say(s->t, "stable step %.6g ms, dt %.6g ms, damping %.4g 1/s%s", 1e3 * s->stable,
             1e3 / r->rate / (double)live_parts(s->live), r->damping, r->adapt ? ", then adapted" : "");
    if (!r->point && !r->coarser && p->start > 0 && p->start >= o->ramp && (o->contract.count || o->gravity.count))
        tool_say(s->t, "the run begins after the ramp of %g s: -c and -g act in full from the first step", o->ramp);
    if (s->live)
        tool_say(s->t, "from %.6g s, %.6g frames a second", p->start, o->rate > 0 ? o->rate : 60);
    else if (r->point)
        tool_say(s->t, "the run goes on from %.6g s, after %lld steps", p->start,
                 (long long)(r->point->first - r->point->course.from));
    else if (r->rest >= 0)
        tool_say(s->t, "from %.6g s to rest, tolerance %g", p->start, r->rest);
    else
        tool_say(s->t, "from %.6g s, %lld step%s%s", p->start, (long long)r->steps, r->steps == 1 ? "" : "s",
                 isfinite(r->end) ? ", the last one shorter" : "");
}

void words_refined(void *context, double time, double closest)
{
    session *s = context;
    progress_clear(&s->progress);
    tool_say(s->t, "at %.6g s single precision comes no closer to rest than %.3g of its displacement: on in double",
             time, closest);
}

void words_coarse(const session *s, const err *none)
{
    const multigrid_told told = s->run.coarser ? multigrid_tell(s->run.coarser) : (multigrid_told){0};
    if (s->run.coarser)
        tool_detail(s->t, "the run begins from the rest of %d coarser model%s: %lld elements in all, %lld steps",
                    told.models, told.models == 1 ? "" : "s", (long long)told.elements, (long long)told.steps);
    else
        tool_detail(s->t, "the run begins from no coarser model: %s", none->text);
}

void words_anew(const session *s, const err *e)
{
    tool_say(s->t, "begun from the rest of a coarser model, the run failed: %s; again, from the beginning", e->text);
}

/* Where multiples of an option's interval lie between two steps, other than the last's end, which is met. */
void words_between(const session *s, const char *option, const char *what, double every)
{
    const run_setup *r = &s->run;
    const double rate = r->rate, start = s->problem.start, origin = timeline_plan(start, rate).origin;
    const double end = isfinite(r->end) ? r->end : start + (double)r->steps / rate, last = end - 1e-6 / rate - origin;
    if (every == 0)
        return;
    const double first = (floor(start / every) + 1) * every - origin;
    if (every * rate < 1)
        tool_say(s->t, "%s %g s is shorter than a step: one %s is written for each step", option, every, what);
    else if ((first < last && timeline_is_between(first, rate)) ||
             (first + every < last && timeline_is_between(every, rate)))
        tool_say(s->t,
                 "multiples of %s %g s lie between steps: each %s is of the first step after one, up to %.3g ms late",
                 option, every, what, 1e3 / rate);
}

/* Of the frames that were written, whether the run came to its end or not. */
void words_folds(session *s, const run_end *end, bool ended)
{
    char folded[FOLDS_TEXT];
    if (!s->folds.frames || out_failed(s->stage.sink, &(err){0}))
        return;
    folds_text(&s->folds, ended, folded);
    tool_say(s->t, "%s", folded);
    folds_warn(&s->folds, ended, end->most_strain, &s->warnings);
    if (end->crowded)
        notes_add(&s->warnings,
                  "%lld elements of skin had more than %d other elements near them during the run; contact with the "
                  "others was left out; expected skin that is crushed less, or less skin (bind --self-contact)",
                  (long long)end->crowded, SELF_CONTACT_BESIDE);
    if (s->beyond)
        notes_add(&s->warnings,
                  "%lld nodes slid beyond the distance field of their bone, which goes on there as at its border; "
                  "expected a way of at most 8 voxels beyond where nodes slide at rest",
                  (long long)s->beyond);
}

void words_end(session *s, const run_end *end)
{
    const monitor_reading *w = &end->reading;
    char left[80] = "";
    if (end->parts > 1)
        tool_say(s->t, "steps were cut into up to %lld: %lld steps were taken in place of %lld", (long long)end->parts,
                 (long long)end->taken, (long long)end->steps);
    if (end->rested)
        snprintf(left, sizeof left, ", %.3g of its displacement to go", end->remaining);
    tool_say(s->t, "%s %.6g s, after %lld steps: kinetic energy %.3g J, largest displacement %.6g mm%s",
             end->rested ? "at rest at" : "at", w->time, (long long)(s->live ? end->taken : end->steps), w->kinetic,
             1e3 * w->largest, left);
    if (s->run.coarser) {
        const multigrid_told told = multigrid_tell(s->run.coarser);
        tool_detail(s->t, "coarser models corrected it %d time%s; their %lld steps in all are worth %.0f of its own",
                    end->corrections, end->corrections == 1 ? "" : "s", (long long)told.steps, told.work);
    }
    words_folds(s, end, true);
    tool_detail(s->t, "%s: %.4g MB, %.4g bytes an element", s->run.device->is.device, 1e-6 * (double)end->bytes,
                (double)end->bytes / (double)s->problem.elements);
}
