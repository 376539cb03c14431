/* Directions between lines that were drawn on a surface, such as Langer's lines on skin: at a place the mean of the
 * lines about it, as dyads, so that the sense in which a line was drawn makes no difference. Weights are those of
 * modified Shepard interpolation (Franke & Nielson 1980), ((R - d) / (R d))^2 for a line at distance d < R, where R is
 * twice the distance of the nearest line and a step; so directions are smooth, and near a line its own. The creator
 * owns it; any number of threads may ask at once.
 */
#ifndef SINEW_LINE_FIELD_H
#define SINEW_LINE_FIELD_H

#include "base/err.h"

typedef struct line_field line_field;

/* end: segments x 2 x 3, m, finite; those without length are left out. step: m, how far apart the samples of a line are
 * at most, unless that would be more than about 20,000. NULL with e filled; also where no segment has a length. */
line_field *line_field_create(const double *end, int64_t segments, double step, err *e);
void line_field_free(line_field *f);

/* The unit direction at a place; in the plane across a unit normal, where that is not 0 0 0. Its largest component is
 * positive. 0 0 0 where all lines are along the normal. */
void line_field_at(const line_field *f, const double place[3], const double normal[3], double along[3]);

#endif
