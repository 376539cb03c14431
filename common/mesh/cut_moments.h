/* The moments of elements that a surface cuts or a border parts, in a model. cut.element and cut.moments are of the
 * elements whose strain is its mean over what is enclosed of them (element_cut.h); other elements have theirs at the
 * centre. border.element, border.normal and border.moments are of the elements that are laminates of their two volumes
 * (element_laminate.h), also where a surface cuts them; other mixed elements have moduli between. Borrows the model.
 */
#ifndef SINEW_CUT_MOMENTS_H
#define SINEW_CUT_MOMENTS_H

#include "model/model.h"
#include "physics/laminate_numbers.h"

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

/* Columns of border.moments: means over the second volume's part of x, y, z, xy, yz and zx. */
enum { BORDER_MOMENTS = 6 };

typedef struct borders {
    const int32_t *element; /* ascending */
    const float *normal;    /* count x 3 */
    const float *moments;   /* count x BORDER_MOMENTS */
    int64_t count;          /* 0: no element is a laminate */
} borders;

/* cut: the model's. -1 with e filled where a model has borders that cannot be. */
int borders_of(borders *to, const cut_moments *cut, const model *m, err *e);

/* Finds the row of an element; -1: it has none. */
int64_t borders_at(const borders *of, int64_t element);

/* LAMINATE_NUMBERS of a row, of boxes of these sides (m). moments: of the box, where it is cut, else NULL. fraction:
 * what is enclosed of it; share: the second volume's of that. The kink is at a plane across the normal, beyond which
 * the box has what one of the parts has of it: the second where that is beyond a plane, else all but the first. */
void borders_numbers(const borders *of, int64_t row, const float *moments, const double side[3], double fraction,
                     double share, double *to);

#endif
