/* What a live run did, as lines of text: a header, the controls that were taken, and a line a frame with all that it
 * was computed from. A run that replays it computes the same frames. sinew-lines(5) is normative.
 *
 *     sinew-record 1 msds-run
 *     of model 0x1f2e3d4c
 *     of device cpu
 *     set repulsion 2
 *     frame 0 0 pose=0,0,.05,0,0,0,1 steps=20 path=msds
 *     end
 *
 * A frame's lines are written by one system call before the frame is computed further, so that a record is whole to its
 * last line whatever happens to the process. Where writing fails, the record ends before the frame that failed, and the
 * run goes on. Records and replays are owned by the caller.
 */
#ifndef SINEW_RECORD_H
#define SINEW_RECORD_H

#include "base/keyfile.h"
#include "base/pose.h"
#include "model/model.h"

enum { RECORD_WORD = 40 };

/* What a record is of: keys and values that must be the same in a replay, as the model's checksum. */
typedef struct record_of {
    const char *key;   /* no blanks */
    const char *value; /* blanks become '_' */
} record_of;

typedef struct record_frame {
    int64_t index; /* the frame's in the output */
    double time;   /* s: the model's */
    bool has_pose;
    pose at;                /* as it was used */
    int64_t steps;          /* steps, or iterations; -1: not said */
    int64_t of;             /* the frame of the input that it was made of; -1: none */
    char path[RECORD_WORD]; /* which solver was used, as a word; "": not said */
} record_frame;

/* The checksum of a model's arrays, as a word. */
void record_model(const model *m, char text[RECORD_WORD]);

typedef struct record record;

/* Creates the file; one that exists is refused unless `force`. of: `count` of them. NULL with e filled. */
record *record_create(const char *path, bool force, const char *tool, const record_of *of, int count, err *e);

/* Adds a control: before the frame that is recorded next. */
void record_control(record *r, const keyfile *k);
void record_setting(record *r, const char *format, ...) SINEW_PRINTF(2, 3);

/* Writes a frame's line, after its controls. Where it cannot, adds a warning, once; nothing more is written then. */
void record_add(record *r, const record_frame *f, notes *warnings);

/* Writes the last controls, and `end`. r may be NULL. */
void record_close(record *r, notes *warnings);

typedef struct replay replay;

/* Opens a record, and compares what it is of: -1 says the first that differs. NULL with e filled. */
replay *replay_open(const char *path, const char *tool, const record_of *of, int count, err *e);

/* The same of a stream, which is closed in the end, or where this fails. */
replay *replay_take(in *source, const char *tool, const record_of *of, int count, err *e);
void replay_close(replay *r);

typedef enum replay_kind { REPLAY_CONTROL, REPLAY_FRAME } replay_kind;

/* The next line. 1: there is one, with its words in *k, valid until the next call, and where it is a frame, in *f; 0:
 * the end, which a record that was cut short has after its last whole line; -1: e filled. */
int replay_next(replay *r, replay_kind *kind, keyfile *k, record_frame *f, err *e);

/* Whether the record came to its `end`. */
bool replay_is_whole(const replay *r);

#endif
