/* Hollow volumes of a model, such as the lumen of a vessel: the tissue about one is under its pressure, by a load that
 * follows the wall, and its elements only keep the walls from crossing. Here is what the caller says of each, and where
 * its wall is: the triangles between its elements and others. Ends that lie on the border of the mesh are open.
 */
#ifndef SINEW_CAVITY_H
#define SINEW_CAVITY_H

#include "base/err.h"

#include <stdint.h>

typedef struct msds_cavity {
    int32_t volume;  /* the model's */
    double pressure; /* Pa: that the wall is under now */
    double at_rest;  /* Pa: with which the model's shape is in balance */
    double outflow;  /* Pa s/m3: rise of the pressure per rate of volume lost; 0: the content leaves freely */
    double wall;     /* N/m: Young's modulus of a wall of its own times its thickness; 0: none */
} msds_cavity;

typedef struct cavity_wall {
    int32_t node[3]; /* counter-clockwise, seen from the tissue */
    int32_t cavity;  /* whose */
} cavity_wall;

/* The walls of all cavities, sorted by their nodes; elements x 4 nodes in VTK order, `volume` of each. The caller frees
 * *walls. Returns how many, or -1 with e filled. */
int64_t cavity_walls(const msds_cavity *list, int cavities, const int32_t *element_node, const int32_t *volume,
                     int64_t elements, cavity_wall **walls, err *e);

/* The cavity that a volume is, or -1. */
int cavity_of(const msds_cavity *list, int cavities, int32_t volume);

#endif
