/* What a run that was killed goes on from, in three files:
 *     FILE         the state at a check, small: a model (sinew-model(5)) with one frame, checksums and an end, that
 *                  appears whole
 *     FILE.1       the one before it
 *     FILE.frames  all frames written so far, as blocks of a model; frames are only added to it
 * So a frame is stored once, and a run that goes on writes all of them to its output again. FILE says how many frames
 * there were by then; those after them are cut off. A run locks FILE.frames as long as it has the checkpoint. The
 * creator owns a checkpoint.
 */
#ifndef SINEW_CHECKPOINT_H
#define SINEW_CHECKPOINT_H

#include "tled/loop/fingerprint.h"
#include "tled/loop/run.h"

typedef struct checkpoint checkpoint;

/* A frame from before, in its order. -1 with e filled. */
typedef int checkpoint_frame(void *context, const frame *f, err *e);

enum { CHECKPOINT_FILES = 3 };

/* The name of FILE, FILE.1 or FILE.frames, for i 0 to 2; the caller frees it. NULL with e filled. */
char *checkpoint_file(const char *path, int i, err *e);

/* Begins anew: none may be there. NULL with e filled. */
checkpoint *checkpoint_begin(const char *path, const fingerprint_run *run, err *e);

/* Goes on from FILE or, where that is damaged, with a warning from FILE.1. Refuses
 * those of another run. NULL with e filled. */
checkpoint *checkpoint_resume(const char *path, const fingerprint_run *run, notes *warnings, err *e);

/* Puts the state that it goes on from into the problem, which then starts there;
 * returns where the run stood, as long as c. */
const run_point *checkpoint_take(const checkpoint *c, tled_problem *p);

/* Gives every frame from before. To be called once, before anything is added or saved. -1 with e filled. */
int checkpoint_replay(checkpoint *c, checkpoint_frame *take, void *context, err *e);

/* Adds a frame. -1 with e filled. */
int checkpoint_add(checkpoint *c, const frame *f, err *e);

/* Saves the state, once all frames that were added are stored. -1 with e filled, and FILE as it was. */
int checkpoint_save(checkpoint *c, const run_point *at, double time, const field_values *state, err *e);

/* How far the run can go back to, s; nan: nothing is saved. */
double checkpoint_saved(const checkpoint *c);

/* The run's output is whole: removes the files. -1 with e filled where one stays. */
int checkpoint_remove(const checkpoint *c, err *e);

/* c may be NULL. */
void checkpoint_close(checkpoint *c);

#endif
