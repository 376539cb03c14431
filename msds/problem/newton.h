/* The numbers of the method tissue that the CPU (msds/cpu/tissue.c, contacts.c) and the card (msds/cuda/cuda_newton.cu)
 * share, so that both take the same steps. Owns nothing.
 */
#ifndef SINEW_NEWTON_H
#define SINEW_NEWTON_H

/* Conjugate gradients stop at this share of the square of what was left, so that Newton's next step begins from a new
 * tangent. */
#define NEWTON_FORCING .01

/* The length of a step along what is left: below 2 over the largest eigenvalue of the tangent times the inverse. */
#define NEWTON_FIXED .35

/* How far a node may go in a Newton step, in sides of a cell. */
#define NEWTON_STRIDE 2.

/* A residual below which pressures are held for the next frame. */
#define NEWTON_BALANCED .5

/* A residual at which a frame ends: single precision gets little further. */
#define NEWTON_TOLERANCE 1e-6

/* From how far a node may touch the probe in a step, and how far one that was pressed stays, in the probe's size. */
#define CONTACT_NEAR_BY  .1
#define CONTACT_CLINGING .02

#endif
