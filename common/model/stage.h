/* A tool's place in a pipe: the model that comes in on stdin, the model that goes out, and how both end. A tool
 * that fails after stage_open ends its output with `fail`, so that the tools behind it end with the same status
 * and say nothing. The caller owns the stage; its models are its own.
 */
#ifndef SINEW_STAGE_H
#define SINEW_STAGE_H

#include "cli/tool.h"
#include "model/stream.h"

typedef struct stage_ahead stage_ahead;

typedef struct stage {
    const tool *t;
    in *source;
    model_reader *reader;
    bool lines_follow; /* the model on stdin, for the caller to take (live/lines.h); set before stage_read */
    out *sink;
    model_writer *writer;
    stage_ahead *ahead;  /* a thread that writes, see stage_write_ahead */
    err ahead_failed;    /* what went wrong there */
    bool has_provenance; /* the model that is written */
    const frame *kept;   /* in place of a reader: the frames that came, borrowed */
    int64_t kept_count;
} stage;

/* Opens what the tool has: the output first (-o, --text, -z, from t's options; binary to a terminal is refused), so
 * that even a failure to read reaches the next tool. Call it before anything else that can fail. */
int stage_open_output(stage *s, const tool *t, err *e);

/* Reads the model on stdin. A terminal there is a usage error (status 2). */
int stage_read(stage *s, model *m, err *e);

/* The name of the stream that the model came from, for messages; in a job of --batch, that of all jobs. */
const char *stage_name(const stage *s);

/* Appends the tool's provenance to m and writes it. */
int stage_write(stage *s, model *m, err *e);

/* Whether to write a model takes long enough for a thread of its own. */
bool stage_is_large(const model *m);

/* Appends the provenance, and begins to write on a thread of its own: all but the arrays, then the first of these, up
 * to the first that `changes`. So the next tool reads while this one computes. Until stage_write, which writes the
 * rest, m may only get more arrays, and those that do not change stay as they are. */
int stage_write_ahead(stage *s, model *m, bool changes(const model_array *a), err *e);

/* The same of a large model as a whole, which stays as it is until stage_written, and s where it is; a small model is
 * written at once. What goes wrong in writing on the thread comes out of stage_written. */
int stage_write_beside(stage *s, model *m, err *e);

/* Waits until what was begun is written: before anything else is. What closes a stage does so too. Of nothing, and
 * again: nothing. -1 with e filled, each time, where it could not be written. */
int stage_written(stage *s, err *e);

/* Copies the frames that are left in to out. */
int stage_copy_frames(stage *s, const model *m, err *e);

/* Reads the frames that are left, and copies them to out where `copied`. Returns how many, the last of which goes to
 * *last, zeroed before and the caller's to free; or -1 with e filled. */
int64_t stage_last_frame(stage *s, const model *m, bool copied, frame *last, err *e);

/* Reads the frames that are left and drops them, noting how many. */
int stage_drop_frames(stage *s, const model *m, notes *warnings, err *e);

/* Ends and closes all: `end` where e is clear, else `fail` (or no file). An error of closing goes into e. s may be
 * part open, or zeroed after a usage error: then `fail` is written all the same if stdout is a pipe. */
void stage_close(stage *s, const tool *t, err *e);

/* Closes one that has no output. */
void stage_close_input(stage *s);

/* ---- One model for several */

/* The model on stdin, and the frames that came with it, for the jobs of --batch: each has a stage and a model of its
 * own, in which the numbers are these. Jobs read them and change nothing of them. The main owns it, zeroed to begin
 * with. */
typedef struct stage_shared {
    stage stage;
    model m;
    frame *frame; /* frames; owned */
    int64_t frames;
} stage_shared;

/* Reads the frames of a model that has come (stage_read), to the end of the stream. -1 with e filled. */
int stage_shared_read(stage_shared *s, err *e);

/* Gives a job's stage the frames, and its model, zeroed, what is in this one. -1 with e filled. */
int stage_shared_lend(const stage_shared *s, stage *to, model *m, err *e);

void stage_shared_free(stage_shared *s);

#endif
