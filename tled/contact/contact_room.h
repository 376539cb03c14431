/* What a step of skin that touches itself works in (self_contact.h): where nodes are, which elements samples may be in,
 * and what touches. The creator owns it.
 */
#ifndef SINEW_CONTACT_ROOM_H
#define SINEW_CONTACT_ROOM_H

#include "tled/contact/contact_maths.h"

/* Bone that skin may not enter. */
typedef struct contact_solid {
    sliding_bone was, is; /* at the beginning and the end of the step */
    double drift;         /* m: how far its fastest corner has come since the start, step by step */
    bool is_placed;
} contact_solid;

struct self_contact_work {
    const tled_problem *p;
    const self_contact *c;
    double *u, *v;  /* nodes x 3 */
    double *x;      /* nodes x 3, m: where they are */
    double *listed; /* nodes x 3, m: where they were when candidates were listed */
    double *change; /* nodes x 3, m */
    double *sum;    /* nodes: of shares; 0 only of those without a contact */
    int32_t *about; /* nodes: those with a contact, in the order of these */
    int32_t abouts;
    bool is_listed;
    contact_table table;
    double spare;  /* m: of the boxes' margin */
    double side;   /* m: of the table's cells */
    int32_t large; /* elements that are in none */
    int32_t *near; /* samples that have candidates */
    int64_t nears;
    double drift;  /* m: how far the fastest node has come since the first list, step by step */
    double *until; /* samples, m: by what drift one may touch */
    touch *touch;  /* samples x 2: first one for each of near, of element -1 where that touches nothing; then those that
                      do, and those in bone */
    int64_t touches;
    int32_t *place_node; /* samples x place_most: what touches point to */
    double *place_share;
    int place_most;
    contact_solid *solid; /* solids */
    double *bone_until;   /* solids x samples: as until */
    touch *bone_touch;    /* samples: what touches bone */
};

/* c: that of the problem, or one that is being made. NULL with e filled. */
self_contact_work *contact_room_make(const tled_problem *p, const self_contact *c, err *e);

/* For qsort and bsearch of int32_t. */
int contact_by_number(const void *a, const void *b);

#endif
