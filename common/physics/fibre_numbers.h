/* What the fibres of a volume are, in numbers, and what they are in one of its elements; fibre.h has the energies. In
 * double, whatever `real` is. Owns nothing.
 */
#ifndef SINEW_FIBRE_NUMBERS_H
#define SINEW_FIBRE_NUMBERS_H

enum { FIBRE_FAMILIES = 2 }; /* of a volume, the most */

typedef struct fibre_numbers {
    double k1, k2, kappa;  /* of a family: Pa, 1, 1; k1 0: there is none */
    double angle;          /* rad: two families at this angle to either side of the fibre; 0: one, along it */
    double c, bf, bt, bfs; /* the law fung: Pa, 1, 1, 1; c 0: it is not of that law */
} fibre_numbers;

/* Whether there is anything that needs a direction. */
static inline int fibre_numbers_any(const fibre_numbers *f)
{
    return f->k1 > 0 || f->c > 0;
}

static inline int fibre_numbers_families(const fibre_numbers *f)
{
    return f->k1 > 0 ? 1 + (f->angle > 0) : 0;
}

/* The law fung's Q in invariants. With E11 = a0.E a0 and E12^2 + E13^2 = |E a0|^2 - E11^2,
 *     Q = bt E:E + 2 (bfs - bt) |E a0|^2 + (bf + bt - 2 bfs) E11^2
 *       = all E:E + 2 along |E a0|^2 + both E11^2. */
typedef struct fibre_invariants {
    double all, along, both;
} fibre_invariants;

static inline fibre_invariants fibre_numbers_fung(const fibre_numbers *f)
{
    const fibre_invariants q = {f->bt, f->bfs - f->bt, f->bf + f->bt - 2 * f->bfs};
    return q;
}

/* Of one volume in an element. */
typedef struct fibre_local {
    fibre_numbers of;
    double share;    /* of the tissue, that is of the volume */
    int is_second;   /* the volume is the one that the element's own is mixed with */
    double along[3]; /* unit vector, or 0 0 0 */
    double family[FIBRE_FAMILIES][3];
} fibre_local;

#endif
