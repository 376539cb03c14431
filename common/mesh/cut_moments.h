/* The moments of elements that a surface cuts, in a model: cut.element and cut.moments, of the elements whose strain is
 * its mean over what is enclosed of them (element_cut.h); other elements have theirs at the centre. Borrows the model.
 */
#ifndef SINEW_CUT_MOMENTS_H
#define SINEW_CUT_MOMENTS_H

#include "model/model.h"

/* Columns of cut.moments: means of x, y, z, xy, yz, zx, and xyz, which loads by volume take. */
enum { CUT_XYZ = 6, CUT_MOMENTS };

typedef struct cut_moments {
    const int32_t *element; /* ascending */
    const float *of;        /* count x CUT_MOMENTS */
    int64_t count;          /* 0: no element has any */
} cut_moments;

/* -1 with e filled where a model has some that cannot be. */
int cut_moments_of(cut_moments *to, const model *m, err *e);

/* The row of an element, or -1; its moments, or NULL. */
int64_t cut_moments_row(const cut_moments *of, int64_t element);
const float *cut_moments_at(const cut_moments *of, int64_t element);

#endif
