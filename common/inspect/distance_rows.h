/* What sinew distance prints: a row of figures for each region of a surface. Regions are those of the command line, or
 * the whole and each group of polygons. The caller owns the lists; begin with zeroed ones.
 */
#ifndef SINEW_DISTANCE_ROWS_H
#define SINEW_DISTANCE_ROWS_H

#include "cli/opt.h"
#include "inspect/distance_surface.h"

typedef struct distance_region {
    char *name;       /* owned: as chars_show() writes it */
    const char *text; /* borrowed: surface/surface_region.h */
    double box[6];    /* mm, if it is a box */
} distance_region;

typedef struct distance_regions {
    distance_region *list; /* owned */
    int count;             /* 0: the whole, and each group */
    double mm;             /* of the unit of OBJ files */
} distance_regions;

/* Of --region NAME=REGION; the lengths of a box are in `unit` where they have no suffix. -1 with e filled. */
int distance_regions_of(distance_regions *r, const opt_list *asked, num_unit unit, err *e);
void distance_regions_free(distance_regions *r);

/* Distances of the vertices of a region's triangles, in mm; nan where there are none. A vertex's weight is a third of
 * the area of the region's triangles about it. */
typedef struct distance_row {
    const char *name; /* borrowed of the regions or of the OBJ */
    int64_t vertices; /* that count below */
    int64_t border;   /* that do not, as their nearest point is on the border of the other surface */
    double mean, rms;
    double median, most_of; /* the least distance with half and .95 of the weight at most so far away */
    double largest;
    double signed_mean; /* outside positive */
    double furthest;    /* of all, those at the border too */
} distance_row;

typedef struct distance_rows {
    distance_row *row; /* owned */
    int64_t count;
} distance_rows;

/* -1 with e filled: a region that is unknown, that cannot be read, or that has no triangle. */
int distance_rows_of(distance_rows *rows, const distance_regions *r, const distance_surface *s, const distance_field *f,
                     pool *threads, err *e);
void distance_rows_free(distance_rows *rows);

#endif
