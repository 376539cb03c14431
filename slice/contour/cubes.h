/* The cases of marching cubes: for a cube's eight corners, inside or out, and for each of its faces that can be
 * read in two ways, whether its inside corners are joined across it: the triangles. What happens on a face
 * depends on that face alone, so two cubes always agree there, and the surface is closed. The table is made, not
 * written down: see cubes.c. The caller frees it.
 */
#ifndef SINEW_CUBES_H
#define SINEW_CUBES_H

#include "base/err.h"

/* Corner x + 2y + 4z. Edge 4a + b + 2c runs along axis a, b and c its places along the axes a + 1 and a + 2 (mod 3).
 * Face 2a + s lies at place s of axis a. Vertex CUBES_CENTRE of a triangle is the mean of the case's rim. */
enum { CUBES_CENTRE = 12, CUBES_TRIANGLES = 12, CUBES_CASES = 656 };

typedef struct cubes_case {
    uint8_t triangles, rim;              /* rim: the vertices about the centre; 0: it has none */
    uint8_t vertex[3 * CUBES_TRIANGLES]; /* edges or the centre; anticlockwise as seen from outside */
} cubes_case;

typedef struct cubes {
    uint16_t first[256];    /* the first case of each set of inside corners */
    uint8_t ambiguous[256]; /* a bit a face: its inside corners are two, diagonally */
    cubes_case one[CUBES_CASES];
} cubes;

/* The table. NULL with e filled on no memory. */
cubes *cubes_create(err *e);

/* The four corners of a face, anticlockwise as seen from outside. */
void cubes_face(int face, int corner[4]);

/* joined: a bit a face, of the ambiguous ones, from the lowest: bit i is of the i-th ambiguous face. */
static inline const cubes_case *cubes_of(const cubes *t, unsigned inside, unsigned joined)
{
    return &t->one[t->first[inside] + joined];
}

#endif
