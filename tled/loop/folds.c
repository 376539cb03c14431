#include "tled/loop/folds.h"

#include "base/mem.h"
#include "base/num.h"
#include "mesh/element_place.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

int folds_make(folds *f, const tled_problem *p, const model *m, int threads, err *e)
{
    *f = (folds){.p = p, .m = m, .last = strained_none(), .worst = strained_none()};
    f->threads = pool_create(threads, e);
    f->part = mem_array(pool_chunks(p->elements, STRAINED_CHUNK), sizeof *f->part, "the elements", e);
    return f->threads && f->part ? 0 : -1;
}

void folds_free(folds *f)
{
    pool_destroy(f->threads);
    free(f->part);
    *f = (folds){0};
}

void folds_add(folds *f, double time, const double *displacement)
{
    const strained_view v = strained_view_of(f->p, displacement, f->last.quality.element);
    f->last = strained_none();
    f->last.quality = strained_quality(&v, f->threads, f->part);
    f->has_energies = false;
    f->time = time;
    if (!f->frames || f->last.quality.worst < f->worst.quality.worst) {
        f->worst = f->last.quality.folded ? strained_of(&v, f->threads, f->part) : f->last;
        f->worst_time = time;
    }
    f->frames++;
    f->folded += f->last.quality.folded > 0;
}

void folds_end(folds *f, const double *displacement)
{
    const strained_view v = strained_view_of(f->p, displacement, f->last.quality.element);
    f->last = strained_of(&v, f->threads, f->part);
    f->has_energies = true;
}

static double share(const strained *s)
{
    return quality_hourglass(s->hourglass, s->strain, s->scale);
}

/* As short numbers are printed, nan without a sign. */
static char *number_text(double value, char text[NUM_TEXT])
{
    snprintf(text, NUM_TEXT, "%.3g", isnan(value) ? fabs(value) : value);
    return text;
}

void folds_text(const folds *f, bool ended, char text[FOLDS_TEXT])
{
    const quality *q = &f->last.quality;
    char when[60] = "", centre[NUM_TEXT], corner[NUM_TEXT], part[NUM_TEXT], energy[80] = "";
    if (!ended)
        snprintf(when, sizeof when, "the last frame, at %.6g s: ", f->time);
    if (f->has_energies)
        snprintf(energy, sizeof energy, "; hourglass energy %s %% of strain energy",
                 number_text(100 * share(&f->last), part));
    snprintf(text, FOLDS_TEXT, "%ssmallest J %s in the middle of an element, %s at a corner; %lld folded%s", when,
             number_text(q->centre, centre), number_text(q->corner, corner), (long long)q->folded, energy);
}

enum { REMEDY_TEXT = 160 };

/* Whether hourglass energy is none of the tissue's, but of a stiffness that only keeps modes small. */
static bool is_artificial(const folds *f)
{
    return f->p->control.kind == HOURGLASS_ISOTROPIC;
}

/* What was seen to help, on faces: shares of voxels and a stiffer muscle; smaller voxels do not, where a muscle's end
 * pulls at a few elements; a larger --hourglass does, but not where it holds too much already. */
static const char *remedy(const folds *f, const strained *s, char text[REMEDY_TEXT])
{
    const bool whole = !f->p->conforming && !model_find(f->m, "element.fraction");
    const bool bends = !is_artificial(f) || share(s) > QUALITY_HOURGLASS;
    snprintf(text, REMEDY_TEXT, "expected %sa stiffer material, %sless load or contraction there%s",
             whole ? "voxelise --fraction 4, " : "", bends ? "or " : "", bends ? "" : ", or a larger --hourglass");
    return text;
}

/* When the last frame is. */
static void say_when(const folds *f, bool ended, char text[60])
{
    if (ended)
        snprintf(text, 60, "at the end");
    else
        snprintf(text, 60, "at %.6g s, in the last frame", f->time);
}

static void warn_of_folds(const folds *f, bool ended, notes *warnings)
{
    char where[ELEMENT_PLACE], when[60], others[100] = "", help[REMEDY_TEXT],
                                         j[40] = "inside out at a corner at rest already";
    const quality *q = &f->last.quality;
    element_place_text(f->m, q->element, where);
    say_when(f, ended, when);
    if (!isnan(q->worst))
        snprintf(j, sizeof j, "J %.3g", q->worst);
    if (f->folded > 1)
        snprintf(others, sizeof others, ", and some in %lld of %lld frames", (long long)f->folded,
                 (long long)f->frames);
    notes_add(warnings,
              "%lld of %lld elements %s folded %s%s (J <= 0 in the middle or at a corner); the worst is %s, "
              "%s: the result is wrong there; %s",
              (long long)q->folded, (long long)f->p->elements, q->folded == 1 ? "is" : "are", when, others, where, j,
              isnan(q->worst) ? "expected a mesh without such elements" : remedy(f, &f->last, help));
}

/* In frames before the last, which has none. */
static void warn_of_frames(const folds *f, notes *warnings)
{
    char where[ELEMENT_PLACE], help[REMEDY_TEXT];
    const quality *q = &f->worst.quality;
    element_place_text(f->m, q->element, where);
    notes_add(
        warnings,
        "elements are folded during the run (J <= 0 in the middle or at a corner), in %lld of %lld frames, worst at "
        "%.6g s, %lld of %lld; the worst is %s, J %.3g: the result is wrong there; %s",
        (long long)f->folded, (long long)f->frames, f->worst_time, (long long)q->folded, (long long)f->p->elements,
        where, q->worst, remedy(f, &f->worst, help));
}

static void warn_of_hourglass(const folds *f, bool ended, notes *warnings)
{
    char where[ELEMENT_PLACE], when[60], part[NUM_TEXT];
    const strained *s = &f->last;
    element_place_text(f->m, s->twisted, where);
    say_when(f, ended, when);
    notes_add(warnings,
              "hourglass energy is %s %% of strain energy %s, expected at most %g %%: elements are too coarse "
              "for how they bend; %s holds the most of it, %.3g %%; expected %s",
              number_text(100 * share(s), part), when, 100 * QUALITY_HOURGLASS, where, 100 * s->most / s->hourglass,
              f->p->conforming ? "a finer mesh" : "smaller voxels");
}

void folds_warn(const folds *f, bool ended, double most_strain, notes *warnings)
{
    const strained *s = &f->last;
    if (s->quality.folded)
        warn_of_folds(f, ended, warnings);
    else if (f->folded)
        warn_of_frames(f, warnings);
    if (is_artificial(f) && f->has_energies && s->twisted >= 0 && share(s) > QUALITY_HOURGLASS &&
        s->hourglass > QUALITY_HOURGLASS * .01 * most_strain)
        warn_of_hourglass(f, ended, warnings);
}
