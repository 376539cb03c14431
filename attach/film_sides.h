/* The triangles of rigid surfaces, on which side each has tissue, and which way its vertices move into it; and the
 * elements about a place. film.c makes films of these. The creator owns it; it borrows the model and the rigid.
 */
#ifndef SINEW_FILM_SIDES_H
#define SINEW_FILM_SIDES_H

#include "mesh/lattice.h"
#include "rigid.h"

enum { FILM_ABOVE = 1, FILM_BELOW = 2 }; /* where its normal points to, by the order of its corners; and behind */

typedef struct film_triangle {
    int32_t vertex[3]; /* places: those at one place are one */
    int32_t anchor;
    int sides;       /* that have tissue: FILM_* */
    bool is_bounded; /* there is bone on its other side, as on that of all of its surface */
} film_triangle;

/* A triangle, and which way its corners move: to x + d way. */
typedef struct film_piece {
    double x[3][3], way[3][3];
} film_piece;

typedef struct film_sides {
    lattice grid;
    lattice_map map;
    const float *fraction, *inside; /* element.fraction, element.inside, or NULL */
    const int32_t *cell;            /* element.lattice */
    film_triangle *triangle;
    int64_t triangles, room;
    double *position, *normal; /* places x 3: m; unit normals, by the triangles' corners or the other way round */
    int32_t *place;            /* of all corners of the primitives, in their order */
} film_sides;

/* -1 with e filled and s to be freed all the same. */
int film_sides_make(film_sides *s, const model *m, const rigid *r, err *e);
void film_sides_free(film_sides *s);

/* The product of b - a and c - a, made a unit; returns its length. */
double film_normal(const double *a, const double *b, const double *c, double normal[3]);

/* m: how wide a voxel is along a direction. */
double film_voxel(const film_sides *s, const double direction[3]);

/* The share of the element at a place; of several in a cell, of all; 0 where there is none. */
double film_share_at(const film_sides *s, const double place[3]);

/* The element in the cell that a place is in, of several the one whose inside is nearest; or -1. near: else the nearest
 * of those about the cell, if it is so near as samples of the share may miss it, or the centre of a voxel. */
int32_t film_element_in(const film_sides *s, const int64_t cell[3], const double place[3]);
int32_t film_element_near(const film_sides *s, const int64_t cell[3], const double place[3]);

/* Halves a triangle until no side of a piece is longer than the shortest of a voxel, as the tissue beside it may
 * change, and calls take for each that is not away from all elements. Stops where that returns other than 0, which is
 * then returned. */
int film_pieces(const film_sides *s, const film_piece *triangle, int (*take)(void *context, const film_piece *piece),
                void *context);

/* The corners of a triangle, and which way they move to one of its sides (1 above, -1 below): as far along its normal
 * as all others that meet there. */
void film_ways(const film_sides *s, const film_triangle *t, int side, double x[3][3], double way[3][3]);

/* m, at most 0: from where on elements are no tissue of theirs but a film's. Without shares they may reach half a voxel
 * into the bone. */
double film_begins(const film_sides *s, const film_triangle *t, const double normal[3]);

#endif
