/* A region of a surface, as people write it: a box X0,Y0,Z0,X1,Y1,Z1, the inside of a closed OBJ, whose name ends in
 * .obj or .obj.gz, or, where it is neither, a group of polygons. A polygon's triangle is in a box or in an OBJ if its
 * three corners are. Owns nothing.
 */
#ifndef SINEW_SURFACE_REGION_H
#define SINEW_SURFACE_REGION_H

#include "base/num.h"
#include "base/pool.h"

/* Whether it is a box; path_is_obj() says whether it is an OBJ. */
bool surface_region_is_box(const char *text);

/* inside: of each of `vertices` positions (x 3), whether it is in the box, of which the low corner comes first, or on
 * its sides to rounding. */
void surface_region_in_box(const double *position, int64_t vertices, const double box[6], uint8_t *inside);

/* The same of the closed surface in an OBJ file, whose coordinates times `scale` are metres; a position times `metre`
 * is metres too. threads: NULL: the caller's alone. -1 with e filled where the file cannot be read, has no polygons or
 * is open. */
int surface_region_in_file(const char *file, double scale, const double *position, int64_t vertices, double metre,
                           pool *threads, uint8_t *inside, err *e);

/* Gives the next of the names in SURFACE,...[:REGION], from *at, which moves past it and its comma. Returns 1; 0 where
 * no name is left; and -1 where a name is empty, or does not fit in `size` bytes. */
int surface_region_name(const char **at, char *name, size_t size);

/* The region that follows a ':' in an option's value: a box of lengths or an OBJ, in that unit; NULL: everywhere.
 * Positions are in m. -1 with e filled, in the option's name, where it is neither. */
int surface_region_of_option(const char *option, const char *text, num_unit unit, const double *position,
                             int64_t vertices, pool *threads, uint8_t *inside, err *e);

#endif
