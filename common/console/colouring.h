/* What a page may colour surfaces by: their own colours, or numbers of a frame at the nodes. The owner of a room owns
 * all in it, and borrows the model.
 */
#ifndef SINEW_COLOURING_H
#define SINEW_COLOURING_H

#include "base/out.h"
#include "console/geometry.h"
#include "results/results.h"

typedef enum colouring {
    COLOURING_OWN,
    COLOURING_DISPLACEMENT, /* its length */
    COLOURING_SPEED,        /* m/s: of node.velocity */
    COLOURING_QUALITY,      /* the smallest J = det F at a corner of a node's elements (mesh/quality.h) */
    COLOURING_STRESS,       /* Pa: von Mises', as all that follow of results.h, the mean of a node's elements */
    COLOURING_STRETCH,      /* the largest principal stretch */
    COLOURING_FIBRE,        /* the stretch of fibres; 1 where there are none */
    COLOURING_ENERGY,       /* J/m3: of strain */
    COLOURINGS
} colouring;

/* What colours of a model take. */
typedef struct colouring_room {
    const model *m;
    double *value;    /* nodes */
    double *element;  /* elements */
    float *number;    /* elements x 3 */
    results *results; /* NULL: the model lacks what they take */
} colouring_room;

/* -1 with e filled on no memory. */
int colouring_room_make(colouring_room *room, const model *m, err *e);
void colouring_room_free(colouring_room *room);

const char *colouring_name(colouring is);

/* -1: no such name. */
int colouring_find(const char *name);

/* "own, displacement, ...": for messages. */
enum { COLOURING_WORDS = 200 };
void colouring_words(char to[COLOURING_WORDS]);

/* "colours":[...],"units":{...}: what there is beside their own. */
void colouring_put(out *to);

/* Points to->value at room->value, nodes, with its range, where colours need more than displacements and the frame has
 * it; else leaves to as it is. The range's ends are round, so that colours hold still. */
void colouring_fill(colouring is, colouring_room *room, const frame *f, geometry_frame *to);

#endif
