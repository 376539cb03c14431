/* What is made of messages: lines of the one pose that is meant, and what their reader should know, on standard error:
 * that it is lost or there again, what senders say, what was wrong. One sender at a time is heard: another one's poses
 * of that name are left out while the first one sends. The caller owns it; the peers are their owner's.
 */
#ifndef SINEW_TRACK_H
#define SINEW_TRACK_H

#include "base/space.h"
#include "cli/tool.h"
#include "link/track/track_lines.h"
#include "link/track/track_names.h"
#include "link/track/track_peer.h"
#include "link/track/track_time.h"

typedef struct track_plan {
    const char *transform; /* NULL: the one that is there */
    space in;              /* in which senders have their poses */
    double timeout;        /* s without a pose, after which it is lost; 0: never */
    bool only_names;       /* nothing is written: track_names is all that is wanted */
} track_plan;

typedef struct track_counts {
    int64_t untracked; /* poses that their sender called so, or that were none */
    int64_t skipped;   /* messages that were wrong in themselves, and matrices that are no pose */
    int64_t checksums; /* of these: by their checksum */
    int64_t late, jumps, other;
} track_counts;

enum { TRACK_TOLD = 32 };

typedef enum track_state { TRACK_WAITING, TRACK_FOUND, TRACK_LOST } track_state;

typedef struct track {
    const tool *t;
    const track_plan *plan;
    track_names names;
    track_lines lines;
    track_time time;
    track_counts counts;
    char chosen[TRACK_NAME]; /* "": not yet */
    const track_peer *holder;
    track_kind kind; /* of the holder's messages */
    track_state state;
    double began, heard;          /* s, by clock_now: the first pose of any name; the last message of the chosen one */
    double since;                 /* s: when it was last tracked */
    double asked;                 /* s: when it was last told what there is */
    int listed;                   /* names of poses that were told then */
    const char *told[TRACK_TOLD]; /* forms of errors */
    int tolds;
} track;

/* "tool: warning: text" on standard error. */
void track_warn(const tool *t, const char *format, ...) SINEW_PRINTF(2, 3);

/* The reader's question: poses, STATUS, STRING and RTS_TDATA are wanted; all else is only counted. */
bool track_wants(void *context, const igtl_header *h);

/* Takes a message that came at `now`. -1 with e filled: the lines cannot be written. */
int track_take(track *k, track_peer *from, const igtl_message *m, double now, err *e);

/* A message was wrong, for the reason in e, which is cleared: tells the first of each kind. */
void track_skip(track *k, err *e);

/* A sender went away. */
void track_forget(track *k, const track_peer *gone);

/* What time brings: the choice, a pose that no longer comes, a line that waits. -1 with e filled. */
int track_pass(track *k, double now, bool connected, err *e);

enum { TRACK_TEXT = 300 };

/* "600 poses; 3 dropped, as their reader was slow; 2 messages skipped, 1 of these for its checksum". */
void track_text(const track *k, char text[TRACK_TEXT]);

#endif
