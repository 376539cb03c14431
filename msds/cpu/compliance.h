/* What a probe's contact is to a factor of the stiffness matrix K: the compliance S = N^T K^-1 N between contacts,
 * where N has their directions; with a penalty, the compliance of its springs too. Its product with forces is of one of
 * two kinds, by which takes less work. For few contacts S is dense: its numbers are products of path vectors
 * (factor.h), which are kept from frame to frame. For many, each product is a solve: forward and backward through the
 * factor. The creator owns it.
 */
#ifndef SINEW_COMPLIANCE_H
#define SINEW_COMPLIANCE_H

#include "msds/cpu/contacts.h"
#include "msds/cpu/factor.h"

typedef struct compliance {
    const msds_problem *p;
    pool *threads;
    factor *factor;
    const contacts *c;
    bool dense;
    int32_t *cached; /* nodes: which of the paths are theirs, or -1 */
    int32_t *whose;  /* paths: the node */
    float *path;     /* paths x 3 x factor.path */
    int64_t paths, room, whose_room;
    double *work;  /* for paths being made */
    int64_t fresh; /* the first of them */
    int64_t row;   /* of schur: the first of those being made */
    float *normal; /* contacts x factor.path: along each contact's way */
    double *schur; /* contacts squared */
    int64_t normal_room, schur_room;
    double *load, *result; /* nodes x 3: of a solve */
    double *led;           /* nodes x 3: K^-1 left, where S is not dense */
    const double *force;   /* of the product under way */
    double *product;
    const msds_listener *listener; /* NULL: nobody */
    msds_progress now;             /* what that is told besides */
} compliance;

/* Between c's contacts, whatever they are by then, and by the factor, which is made. s is zeroed but for its listener.
 * -1 with e filled, and to be freed all the same. */
int compliance_make(compliance *s, const msds_problem *p, factor *f, const contacts *c, pool *threads, err *e);
void compliance_free(compliance *s);

/* Of paths and of a dense S, by now. */
int64_t compliance_bytes(const compliance *s);

/* Tells of work on contact; share: of what, 0 to 1. */
void compliance_tell(compliance *s, const char *what, double share);

/* For the contacts listed now. -1 with e filled where memory is short. */
int compliance_begin(compliance *s, err *e);

/* The factor is another from here on. */
void compliance_forget(compliance *s);

/* moved = N^T K^-1 left: how far contacts would move, m, each its way; left: nodes x 3, N. */
void compliance_lead(compliance *s, const double *left, double *moved);

/* product = S force: contacts each, m and N. */
void compliance_multiply(compliance *s, const double *force, double *product);

/* step = K^-1 (left + N force), of the left that led last: nodes x 3, m. */
void compliance_follow(compliance *s, const double *force, double *step);

/* About the inverse of S's diagonal, N/m: what resists a contact's node where all others are held. k: the factor's
 * matrix. */
double compliance_inverse(const compliance *s, const contact *c);

#endif
