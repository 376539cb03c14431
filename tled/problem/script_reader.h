/* What reads the lines of a script, for script_read.c, which has most verbs, and script_move.c. Lives as long as a file
 * is read, or a live line taken; borrows all but its entries.
 */
#ifndef SINEW_SCRIPT_READER_H
#define SINEW_SCRIPT_READER_H

#include "tled/problem/script.h"

/* One line of a file, until the keys of each curve are brought together. */
typedef struct script_entry {
    int64_t curve;
    double time, value[3];
} script_entry;

typedef struct script_reader {
    script *s;
    const model *m;
    keyfile k;
    script_entry *entries;
    int64_t count, capacity;
    int64_t first;         /* curves before these came from the command line */
    const script_now *now; /* of a line that comes live; NULL: of a file */
    int64_t gone;          /* live: the curve that the line replaces, or -1 */
    double near[3];        /* m: how far past a box a node may be that counts as on its face, along each axis */
    const pose *place;     /* of a file of poses: where the model lies in their frame */
} script_reader;

/* Numbers in metres, with suffixes or without; exactly count. */
int script_reader_lengths(const script_reader *r, const char *text, int count, double *value, const char *expected,
                          err *e);

/* The curve for this line: the one that an earlier line began, or a new one (*fresh). -1 with e filled. */
int64_t script_reader_curve(script_reader *r, const script_curve *c, bool *fresh, err *e);

/* Adds a key to a curve, or, live, holds it at that value from now on. -1 with e filled. */
int script_reader_key(script_reader *r, int64_t at, double time, const double *value, err *e);

/* TIME contract MUSCLE LEVEL. */
int script_line_contract(script_reader *r, double time, err *e);

/* TIME move BODY X,Y,Z QX,QY,QZ,QW [about X,Y,Z]; and a line of script_read_poses. */
int script_line_move(script_reader *r, double time, err *e);
int script_line_pose(script_reader *r, err *e);

#endif
