#include "tled/folds.h"

#include "base/mem.h"
#include "base/num.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

int folds_make(folds *f, const tled_problem *p, const model *m, int threads, err *e)
{
    *f = (folds){.p = p, .m = m, .last = strained_none(), .worst = quality_none()};
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

void folds_look(folds *f, double time, const double *displacement)
{
    const strained_view v = strained_view_of(f->p, displacement, f->last.quality.element);
    f->last = strained_of(&v, f->threads, f->part);
    const quality *now = &f->last.quality;
    if (!f->frames || now->worst < f->worst.worst) {
        f->worst = *now;
        f->worst_time = time;
    }
    f->frames++;
    f->folded += now->folded > 0;
}

static double share(const strained *s)
{
    return quality_hourglass(s->hourglass, s->strain);
}

void folds_text(const folds *f, char text[FOLDS_TEXT])
{
    const quality *q = &f->last.quality;
    snprintf(text, FOLDS_TEXT,
             "smallest J %.3g in the middle of an element, %.3g at a corner; %lld folded; hourglass energy %.3g %% of "
             "strain energy",
             q->centre, q->corner, (long long)q->folded, 100 * share(&f->last));
}

/* "element 12 (volume 'skin') at 1mm,2mm,3mm": its middle at rest, in the unit of the model's source, as keys of sinew info take it. */
static void name_element(const folds *f, int64_t element, char *to, size_t size)
{
    const tled_problem *p = f->p;
    const char *source = model_meta_of(f->m, "source.unit");
    const num_unit metre = num_unit_of("m"), own = source ? num_unit_of(source) : 0, unit = own ? own : metre;
    const double scale = num_length_in((num_length){1, unit}, unit, metre);
    double at[3] = {0};
    for (int i = 0; i < 24; i++)
        at[i % 3] += p->position[3 * (int64_t)p->element_node[8 * element + i / 3] + i % 3] / (8 * scale);
    snprintf(to, size, "element %lld (volume '%.100s') at %.4g%s,%.4g%s,%.4g%s", (long long)element,
             p->volume[p->element_volume[element]].name, at[0], num_unit_name(unit), at[1], num_unit_name(unit), at[2],
             num_unit_name(unit));
}

static const double usual_kappa = .0075; /* of --hourglass, where it is not given */

/* What was seen to help, on faces: smaller voxels do not, where a muscle's end pulls at a few elements. */
#define REMEDY "expected less load or contraction there, or a larger --hourglass"

static void warn_of_folds(const folds *f, notes *warnings)
{
    char where[300], others[100] = "", j[40] = "inside out at a corner at rest already";
    const quality *q = &f->last.quality;
    name_element(f, q->element, where, sizeof where);
    if (!isnan(q->worst))
        snprintf(j, sizeof j, "J %.3g", q->worst);
    if (f->folded > 1)
        snprintf(others, sizeof others, ", and some in %lld of %lld frames", (long long)f->folded,
                 (long long)f->frames);
    notes_add(warnings,
              "%lld of %lld elements %s folded at the end%s (J <= 0 in the middle or at a corner); the worst is %s, "
              "%s: the result is wrong there; %s",
              (long long)q->folded, (long long)f->p->elements, q->folded == 1 ? "is" : "are", others, where, j,
              isnan(q->worst) ? "expected a mesh without such elements" : REMEDY);
}

/* In frames before the last, which has none. */
static void warn_of_frames(const folds *f, notes *warnings)
{
    char where[300];
    name_element(f, f->worst.element, where, sizeof where);
    notes_add(warnings,
              "elements are folded on the way (J <= 0 in the middle or at a corner), in %lld of %lld frames, worst at "
              "%.6g s, %lld of %lld; the worst is %s, J %.3g: the result is wrong there; " REMEDY,
              (long long)f->folded, (long long)f->frames, f->worst_time, (long long)f->worst.folded,
              (long long)f->p->elements, where, f->worst.worst);
}

static void warn_of_hourglass(const folds *f, notes *warnings)
{
    char where[300];
    const strained *s = &f->last;
    name_element(f, s->twisted, where, sizeof where);
    notes_add(
        warnings,
        "hourglass energy is %.3g %% of strain energy at the end, expected at most %g %%: elements are too coarse "
        "for how they bend; %s holds the most of it, %.3g %%; expected %s%s",
        100 * share(s), 100 * QUALITY_HOURGLASS, where, 100 * s->most / s->hourglass,
        f->p->conforming ? "a finer mesh" : "smaller voxels",
        f->p->kappa > usual_kappa ? ", or a smaller --hourglass" : "");
}

void folds_warn(const folds *f, double most_strain, notes *warnings)
{
    const strained *s = &f->last;
    if (s->quality.folded)
        warn_of_folds(f, warnings);
    else if (f->folded)
        warn_of_frames(f, warnings);
    if (s->twisted >= 0 && s->hourglass > QUALITY_HOURGLASS * fmax(s->strain, .01 * most_strain))
        warn_of_hourglass(f, warnings);
}
