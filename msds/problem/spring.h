/* The maths of one spring and damper between two nodes (PST equation 1), for gcc and nvcc; `real` is the includer's.
 *
 * With the rest vector D, its length x0, and the differences of displacement du and of velocity dv of its ends, the
 * spring is d = D + du long, x = |d|, and pulls its first end along d/x with
 *     k (x - x0) + gamma dx/dt,    dx/dt = dv . d / x.
 * x^2 - x0^2 is taken as e = du . (2 D + du), so that a small stretch keeps its digits: x - x0 = e / (x + x0). The
 * force over d is then, with one division,
 *     (k e x^2 + gamma (dv . d) (x^2 + x0 x)) / (x^2 (x^2 + x0 x)).
 */
#ifndef SINEW_SPRING_H
#define SINEW_SPRING_H

/* A spring that has collapsed has no direction: its length counts as this share of that at rest, at least, squared. */
#define SPRING_LEAST ((real)1e-10)

/* The force on the first end is this times d. */
#define SPRING_FORCE(k, gamma, rest, square, speed, stretch, root)                                                     \
    (((k) * (stretch) * (square) + (gamma) * (speed) * ((square) + (rest) * (root))) /                                 \
     ((square) * ((square) + (rest) * (root))))

#endif
