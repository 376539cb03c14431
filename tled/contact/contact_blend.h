/* The shares that nodes have in a place of an element that moves blended, as the skin is drawn (mesh/motion.h): the
 * maps of the element's eight nodes, each the mean of the elements around it, are linear in the displacements of nodes
 * near it. The creator owns it; it borrows nothing.
 */
#ifndef SINEW_CONTACT_BLEND_H
#define SINEW_CONTACT_BLEND_H

#include "mesh/motion.h"
#include "tled/contact/deformed_place.h"

enum {
    BLEND_NODES = 27, /* the most of a node's map */
    BLEND_MOST = 96   /* and of an element's eight, of which slits may have more than 64 */
};

/* Shares that are worth having are above this. */
#define BLEND_LEAST 1e-9

typedef struct contact_blend {
    double side[3];   /* m: of an element */
    int64_t elements; /* rows */
    int32_t *place;   /* elements x 8: of the maps below; -1: the node has that of the element itself */
    int32_t *node;    /* elements x BLEND_MOST: rows of nodes, of so many: */
    uint8_t *count;   /* elements */
    uint8_t *index;   /* elements x 8 x BLEND_NODES: which of these an entry of a node's map is */
    int64_t maps;
    int32_t *start; /* maps + 1 */
    double *
        coefficient; /* entries x 4: of a displacement, in the map's at its node, and in its slope along x, y, z, 1/m */
} contact_blend;

/* of: a motion, opened, in which all of these elements are. element: which of the model's each row is; node: the
 * model's elements' nodes (x 8); row: of the model's nodes, which all that move them have. -1 with e filled, and b to
 * be freed all the same. */
int contact_blend_make(contact_blend *b, const motion *of, const int32_t *element, int64_t elements,
                       const int32_t *node, const int32_t *row, const double side[3], err *e);
void contact_blend_free(contact_blend *b);

/* ---- the maps' shares, one source for every executor */

/* Of corner c's map of an element: how many nodes it has. */
DEFORMED_FUNCTION int contact_blend_entries(const contact_blend *b, int64_t element, int c)
{
    const int32_t place = b->place[8 * element + c];
    return place < 0 ? 8 : b->start[place + 1] - b->start[place];
}

/* A place in an element of these sides, 0 to 1 along each axis in it, from that of corner c's map, m; own: that is the
 * element's own. */
DEFORMED_FUNCTION void contact_blend_from(const double *side, int c, bool own, const double *xi, double *from)
{
    for (int a = 0; a < 3; a++)
        from[a] = side[a] * (xi[a] - (own ? .5 : deformed_corner(c, a)));
}

/* Corner k's part in its element's slope along an axis, 1/m. */
DEFORMED_FUNCTION double contact_blend_slope(const double *side, int k, int axis)
{
    const double slope = 1 / (4 * side[axis]); /* of all corners, so that loops over them divide once */
    return deformed_corner(k, axis) ? slope : -slope;
}

/* The share, at a place that is `from` (m) from that of a map, of a node with these coefficients; and of node k of an
 * element in its own map. */
DEFORMED_FUNCTION double contact_blend_share(const double *of, const double *from)
{
    return of[0] + (of[1] * from[0] + of[2] * from[1] + of[3] * from[2]);
}

DEFORMED_FUNCTION double contact_blend_own(const double *side, int k, const double *from)
{
    double share = 1. / 8;
    for (int a = 0; a < 3; a++)
        share += contact_blend_slope(side, k, a) * from[a];
    return share;
}

/* The parts of the eight maps at a place; beyond the element, as at the nearest in it. */
DEFORMED_FUNCTION void contact_blend_parts(const double *xi, double *part)
{
    double nearest[3];
    for (int a = 0; a < 3; a++)
        nearest[a] = fmin(fmax(xi[a], 0.), 1.);
    deformed_shares(nearest, part);
}

/* ---- all of a place's */

/* Of a place in an element's row, 0 to 1 along each axis in it: fills share, of b->count of nodes. */
void contact_blend_shares(const contact_blend *b, int64_t element, const double xi[3], double share[BLEND_MOST]);

/* The nodes of these that move it by more than nothing, as rows, and their shares. Returns how many. */
int contact_blend_lever(const contact_blend *b, int64_t element, const double xi[3], int32_t node[BLEND_MOST],
                        double share[BLEND_MOST]);

#endif
