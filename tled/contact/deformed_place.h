/* Places in a deformed element of eight nodes, whose map from (0, 1)^3 to space is trilinear: which place a point is,
 * the nodes' shares there, and the slope in space of what is trilinear between nodes. In double. Keeps nothing.
 */
#ifndef SINEW_DEFORMED_PLACE_H
#define SINEW_DEFORMED_PLACE_H

#include <stdbool.h>

/* What is trilinear, as the factors of 1, x, y, z, xy, yz, zx and xyz. */
typedef struct deformed_factors {
    double of[8];
} deformed_factors;

/* value: at the nodes, in VTK order. */
deformed_factors deformed_factors_of(const double value[8]);

/* Where an element is: of each component of space, m. */
typedef struct deformed_map {
    deformed_factors at[3];
} deformed_map;

deformed_map deformed_map_of(double corner[8][3]);

/* By Newton's method from the middle. false where the element has no place for it within two of its sides. */
bool deformed_place(const deformed_map *d, const double x[3], double xi[3]);

/* Moves a place on by what takes it `way` (m) on in space, to first order. false: the element is folded there. */
bool deformed_go(const deformed_map *d, const double way[3], double xi[3]);

/* How far x is from the middle, squared, m2. */
double deformed_from_middle(const deformed_map *d, const double x[3]);

/* The most that a place is out of (0, 1), along an axis. */
double deformed_outside(const double xi[3]);

void deformed_shares(const double xi[3], double share[8]);

/* The place that has these shares. */
void deformed_place_of_shares(const double share[8], double xi[3]);

/* The direction in space in which what is trilinear grows, of length 1; returns how much, per m; 0, and no direction,
 * where it does not grow or the element is folded there. */
double deformed_slope(const deformed_map *d, const double xi[3], const deformed_factors *value, double direction[3]);

/* How much it grows per m at rest, where the element is a box of these sides (m). */
double deformed_rest_slope(const double xi[3], const deformed_factors *value, const double side[3]);

double deformed_value(const deformed_factors *value, const double xi[3]);

#endif
