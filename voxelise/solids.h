/* The volumes of a plan as triangles in the source file's unit, ready for the inside test: vertices at one place made
 * one, polygons cut into triangles, every volume seen to be closed. Owned by whoever declares it.
 */
#ifndef SINEW_SOLIDS_H
#define SINEW_SOLIDS_H

#include "base/num.h"
#include "voxelise/inside.h"
#include "voxelise/volumes.h"

typedef struct solids {
    double *position; /* vertices x 3, those used only */
    int64_t vertices;
    int32_t *vertex; /* triangles x 3 */
    int32_t *volume; /* triangles */
    bool *rigid;     /* triangles: of a surface that is rigid by name */
    int64_t triangles;
    double low[3], high[3]; /* the box of the vertices */
    int64_t *open;          /* volumes: open edges */
    double (*open_at)[3];   /* volumes: the middle of the first of them */
} solids;

/* unit: of the source file, for messages. sheets: polygons that cancel in pairs, as where two solids touch, are kept as
 * two sheets at one place, which enclose nothing; else they are left out. -1 with e filled where a volume is open (with
 * allow_open that is a note). Coordinates too small for exact arithmetic (grid.h) are taken as 0, those too large
 * refused. */
int solids_build(solids *s, const obj *o, const volumes *plan, num_unit unit, bool sheets, bool allow_open,
                 notes *warnings, err *e);

void solids_free(solids *s);

/* The triangles of all volumes, or of those of level 0: borrowed. */
inside_triangles solids_triangles(const solids *s, const volumes *plan, bool lowest);

/* Whether a volume of level 0 is open: then what is inside of it is a guess. */
bool solids_are_open(const solids *s, const volumes *plan);

#endif
