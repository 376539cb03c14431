/* How a probe gets to a pose: what a frame of msds-run solves, move by move. A frame gets as many iterations as the
 * time since the pose before asks for, --iterations a 60th of a second by default; and with springs, which live in
 * time, the probe goes the way from one pose to the next in a few moves: so what is shown does not depend on how
 * often poses come. A probe that is in the tissue at once, at the first pose or after none, is eased in along its own
 * axis, from where it touches nothing: nodes deep inside would not know which way is out. One that jumps is swept along
 * the screw motion from pose to pose, in moves so short that no node that it meets is past its middle; through free
 * space in one. Bone stops it (bones.h). The creator owns it.
 */
#ifndef SINEW_PRESS_H
#define SINEW_PRESS_H

#include "msds/problem/msds_executor.h"
#include "msds/run/bones.h"

enum {
    PRESS_MOVES = 64, /* of one frame; but for those of a sweep */
    PRESS_SWEEP = 256,
    PRESS_TOGETHER = 5 /* iterations with the probe in one place: of springs, where moves are enough; in a sweep */
};

typedef struct press {
    const msds_problem *p;
    const probe *shape;
    int64_t iterations;
    double rate;      /* frames a second that --iterations are meant for; 0: of any frame */
    bones bones;      /* what stops the probe; owned, see press_bones */
    double *u;        /* nodes x 3, m; owned: to look where nodes are */
    bool live;        /* a frame takes --iterations at most, and what it leaves is done by the next, or not at all */
    bool any;         /* there was a pose */
    bool timed;       /* there was a frame */
    pose last;        /* then, where the probe stood */
    double time;      /* s */
    int64_t due;      /* iterations since the beginning */
    double begin;     /* s: of the first pose */
    int64_t contacts; /* nodes pressed in the last frame; the caller keeps it */
} press;

typedef struct press_move {
    pose at;
    int64_t iterations;
} press_move;

typedef struct press_moves {
    press_move list[PRESS_SWEEP];
    int count;
    bool inside;   /* it would have begun deep in the tissue, and is eased in */
    double back;   /* m: from how far back along its axis */
    int64_t asked; /* iterations that its time asks for: moves may need more */
    bool swept;    /* it jumped: all but the last move only bring the tissue along */
    bool stopped;  /* bone keeps it from its pose */
} press_moves;

int press_make(press *s, const msds_problem *p, const probe *shape, int64_t iterations, double rate, err *e);
void press_free(press *s);

/* The probe cannot enter rigid bodies, of this model. Without it, it can. -1 with e filled. */
int press_bones(press *s, const model *m, err *e);

/* Other iterations, from the next frame on. */
void press_pace(press *s, int64_t iterations, double rate);

/* Goes on from a pose of an earlier run. */
void press_from(press *s, const pose *at, double time);

/* The frame that a probe is moved in. */
typedef struct press_frame {
    double time; /* s */
    pose at;
    bool springs;
    bool newton; /* each move of a sweep takes what a frame does: steps are short where elements are pressed flat */
    int64_t iterations; /* of the frame, as an earlier run had them; -1: as its time asks for */
} press_frame;

/* The moves to a pose; state is asked where the nodes are, if need be. -1 with e filled. */
int press_to(press *s, const msds_executor *device, msds_state *state, const press_frame *f, press_moves *moves,
             err *e);

/* The one move of a frame without a pose. */
void press_wait(press *s, const press_frame *f, press_moves *moves);

/* As if there had been no pose: the tissue is at rest again. */
void press_reset(press *s);

/* Where the probe stands at the end. */
const pose *press_end(const press_moves *moves);

/* Iterations of all moves. */
int64_t press_sum(const press_moves *moves);

#endif
