/* The numbers of a muscle's curves (muscle_curves.h) in an array, as models and steppers have them. Owns nothing.
 */
#ifndef SINEW_MUSCLE_NUMBERS_H
#define SINEW_MUSCLE_NUMBERS_H

/* 1/optimum - 1; the passive stress, Pa; its exponent; the l from which it is a line, less 1; and of a muscle with a
 * spring in series (muscle_series.h), else 0: the spring's stiffness by the fibre's stretch, Pa, and the velocity
 * without load, stretches of the fibre by s. All 0: optimum 1, no passive stress, and no spring. */
enum { MUSCLE_LESS, MUSCLE_PASSIVE, MUSCLE_STIFFENING, MUSCLE_STRAIGHT, MUSCLE_SPRING, MUSCLE_FASTEST, MUSCLE_NUMBERS };

#endif
