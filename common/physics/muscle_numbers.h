/* The numbers of a muscle's curves (muscle_curves.h) in an array, as models and steppers have them. Owns nothing.
 */
#ifndef SINEW_MUSCLE_NUMBERS_H
#define SINEW_MUSCLE_NUMBERS_H

/* 1/optimum - 1; the passive stress, Pa; its exponent; the l from which it is a line, less 1. All 0: optimum 1, and no
 * passive stress. */
enum { MUSCLE_LESS, MUSCLE_PASSIVE, MUSCLE_STIFFENING, MUSCLE_STRAIGHT, MUSCLE_NUMBERS };

#endif
