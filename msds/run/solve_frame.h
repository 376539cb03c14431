/* One frame of msds-run: the probe goes to its pose, the tissue and the skin follow, and what they come to is written.
 */
#ifndef SINEW_SOLVE_FRAME_H
#define SINEW_SOLVE_FRAME_H

#include "msds/run/session.h"

/* What a frame is made of. */
typedef struct frame_input {
    double time; /* s */
    bool has_pose;
    pose at;
    int64_t line; /* that the pose stood in, for messages; 0: no line */
    method_word method;
    int64_t iterations; /* as an earlier run had them; -1: as the time asks for */
} frame_input;

/* A frame as the poses of a file ask for it. */
frame_input solve_frame_input(const session *s, double time, const pose *at, int64_t line);

/* Makes a frame and writes it. -1 with e filled; status 3: it diverged. */
int solve_frame(session *s, const frame_input *from, err *e);

/* The same in parts: solves a frame; puts the tissue and the skin back to rest instead; writes what it came to. */
int solve_frame_solve(session *s, const frame_input *from, err *e);
int solve_frame_rest(session *s, const frame_input *from, err *e);
int solve_frame_write(session *s, const frame_input *from, err *e);

#endif
