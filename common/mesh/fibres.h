/* The fibres of a model's elements that resist being stretched (physics/fibre.h): what each volume's material has of
 * them, and their directions in an element, from element.fibre and element.mixfibre and, of two families at an angle,
 * element.normal. Who made the view frees it; it borrows the model's arrays.
 */
#ifndef SINEW_FIBRES_H
#define SINEW_FIBRES_H

#include "base/err.h"
#include "model/model.h"
#include "physics/fibre_numbers.h"

struct material;

typedef struct fibres_view {
    fibre_numbers *of;           /* volumes; NULL: no element has any. Owned */
    const int32_t *volume, *mix; /* elements; mix NULL: none is mixed */
    const float *mixture;
    const float *along, *mixalong; /* elements x 3, or NULL */
    const float *normal;           /* elements x 3, or NULL */
    int64_t volumes;
} fibres_view;

/* of: of each volume. -1 with e filled: an array is missing, or a volume that needs directions has none anywhere, or
 * one of the law fung lacks some. to is to be freed all the same. */
int fibres_make(fibres_view *to, const model *m, const struct material *of, err *e);
void fibres_free(fibres_view *f);

/* Notes how many elements of a volume lack directions: they have no fibres. */
void fibres_note(const fibres_view *f, const model *m, notes *to);

/* Those of an element that has any: of its volume, and of the second that it is mixed of, by their shares of the
 * tissue. How many. */
int fibres_at(const fibres_view *f, int64_t element, fibre_local to[2]);

/* Whether any volume has families at an angle: these have directions of their own. */
bool fibres_angled(const fibres_view *f);

/* Whether a volume has fibres that resist being stretched. */
static inline int fibres_any(const fibres_view *f, int32_t volume)
{
    return f->of && volume >= 0 && fibre_numbers_any(&f->of[volume]);
}

#endif
