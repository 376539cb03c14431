/* What a march's cells are made of (march.h): what special ones have, and the directions of fibres. */
#ifndef SINEW_MARCH_CELLS_H
#define SINEW_MARCH_CELLS_H

#include "tled/cuda/march.h"

/* Of an element, if it were special; and whether it has to be: it is not of the plain law, may contract or is cut. */
march_cell march_cell_of(const march *m, const tled_problem *p, int64_t element);
bool march_cell_special(const march *m, const tled_problem *p, int64_t element, const march_cell *cell);

/* What a cut element has besides. */
march_cut march_cut_of(const march *m, const float *moments);

/* The most families of fibres of an element. -1: a march has no such fibres, as there are those of the second volume of
 * an element, those of the law fung, or muscles with curves of their own. */
int march_families_of(const tled_problem *p);

/* k1 of each family, Pa: where some cells have two, those of a volume that has one are two alike. */
double march_stiffness(const march *m, const fibre_numbers *of);

/* The directions of fibres: two numbers of 32 bits for each place of all layers, then for each element of tips, from
 * row march_along_tips on. A direction a0 of length 1 along the march's axes is told by a0/(|x| + |y| + |z|), without
 * its z, which is 1 - |x| - |y|; of z < 0, by x = (1 - |y|) sign x and y = (1 - |x|) sign y instead. Where no element
 * has more than one family, these are x and y, as float; no fibres: x is 2. Else there are two, cos t a0 +- sin t b, t
 * their cell's angle: x, y, the angle of b across a0 from the first of march_beside, and whether there are fibres take
 * 21, 21, 21 and 1 bits, lowest first: a number from 0 to 2097151 for -1 to 1, or for all around. NULL with e filled;
 * the march's. */
uint32_t *march_along_make(const march *m, err *e);
int64_t march_along_tips(const march *m);

/* Two directions across a, of length 1, and across each other (Duff et al. 2017). */
void march_beside(const double a[3], double first[3], double second[3]);

/* An element's, to such a row. */
void march_along_put(const march *m, const tled_problem *p, int64_t element, int64_t row);

/* The volume whose cells are plain: that of the most elements. */
int32_t march_plain_of(const tled_problem *p);

#endif
