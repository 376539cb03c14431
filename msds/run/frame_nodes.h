/* What frames have of the nodes: displacement, velocity, and the bound surfaces that the nodes move. Where the device
 * has snapshots, only what frames take comes from it, while the next frame is solved, and the thread that writes makes
 * the arrays of that; else all is made of the state, by who sends the frame. The creator owns it; it borrows the state,
 * the model and the choice.
 */
#ifndef SINEW_FRAME_NODES_H
#define SINEW_FRAME_NODES_H

#include "frames/frame_queue.h"
#include "msds/problem/msds_executor.h"
#include "results/frame_choice.h"

typedef struct frame_nodes {
    const msds_executor *device;
    msds_state *state;
    const model *m;
    const frame_choice *choice;
    pool *threads, *writers; /* of who sends, borrowed; of who writes, owned: both may run at once */
    int64_t nodes;
    bool displacement, velocity, moves; /* frames have these; bound surfaces */
    bool beside;                        /* by snapshots */
    int32_t *moving;                    /* count: the nodes that move bound surfaces, ascending */
    int64_t count;
    double *now;     /* nodes x 3, m: the displacement, or (beside) that of `moving` alone; NULL: not wanted apart */
    double *all;     /* nodes x 3, m: the displacement, of a device that has snapshots; or NULL, not asked for yet */
    double *wide[2]; /* nodes x 3: what was taken in single precision, and frames have as f64; or NULL */
} frame_nodes;

/* Makes n (zeroed), once the choice is open; gets the device ready. -1 with e filled, as for all below, and to be freed
 * all the same. */
int frame_nodes_make(frame_nodes *n, const msds_problem *p, const frame_choice *choice, const model *m, pool *threads,
                     err *e);
void frame_nodes_free(frame_nodes *n);

/* Begins a frame of the state as it is: the arrays of nodes come first. */
int frame_nodes_begin(frame_nodes *n, frame *f, err *e);

/* The displacement of all nodes in the frame that was begun last, x 3, m. Where the device has snapshots, this waits
 * for it, and it is for what is seldom asked. NULL with e filled. */
const double *frame_nodes_displacement(frame_nodes *n, const frame *f, err *e);

/* Adds bound surfaces, behind all other arrays, and keeps what is wanted: who sends (writes false), before the frame is
 * sent; and who writes (true), before it is written. Each does its part. */
int frame_nodes_end(frame_nodes *n, frame *f, bool writes, err *e);

#endif
