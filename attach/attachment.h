/* The attachments of muscles: the connected components of a muscle's rigid nodes, where the rigid nodes of one element
 * are connected. The caller owns the list; begin with a zeroed one.
 */
#ifndef SINEW_ATTACHMENT_H
#define SINEW_ATTACHMENT_H

#include "base/err.h"
#include "muscle_body.h"

typedef struct attachment {
    int32_t muscle;
    int64_t nodes;
    double centre[3]; /* of its nodes, by the largest part that the muscle has of an element there, m */
    int32_t anchor;   /* that holds most of them, of equals the first; -1: not known */
} attachment;

typedef struct attachments {
    attachment *of; /* muscle after muscle; of one, those of more nodes first */
    int64_t count, capacity;
} attachments;

/* Adds those of a muscle, and numbers them, from 0, in b->part at its nodes, -1 at its other nodes. */
int attachments_find(attachments *list, const body *b, int32_t muscle, int32_t volume, err *e);

#endif
