/* The console: what runs, what it shows, what pages may do. One thread, that of console_go, starts and ends tools and
 * acts on messages, so all but the parts named below is its own. Threads of the children call console_said,
 * console_show and what they use, which are in console_show.c.
 */
#ifndef SINEW_CONSOLE_H
#define SINEW_CONSOLE_H

#include "cli/tool.h"
#include "console/around.h"
#include "console/cases.h"
#include "console/colouring.h"
#include "console/dials.h"
#include "console/expression_names.h"
#include "console/geometry.h"
#include "console/images.h"
#include "console/inbox.h"
#include "console/programs/steering.h"
#include "console/web.h"
#include "live/feed.h"
#include "model/source.h"

#include <pthread.h>
#include <stdatomic.h>

enum { CONSOLE_POSES = 64, CONSOLE_PULLS = 16, CONSOLE_WORD = 64, CONSOLE_LINE = 300, CONSOLE_FILE = 4096 };

/* What the threads of frames and of tools' words share with console_go: under its lock. */
typedef struct console_shared {
    pthread_mutex_t lock;
    struct {
        double row[7], sent; /* s, by clock_now */
    } poses[CONSOLE_POSES];  /* that were sent: a ring */
    int next_pose;
    double last_row[7], lag;         /* of the last frame: its pose; s from that pose to it, nan: not known */
    double began_wall, began_time;   /* s: of the frame that the ratio is counted from */
    double before_wall, before_time; /* a second or more ago */
    char said[2][CONSOLE_LINE];      /* the last words of the tool that computes, and of us-slice */
    char device[CONSOLE_WORD];       /* "cpu": what the tool said of it; "": nothing yet */
    bool device_is_new;
    char save[CONSOLE_FILE]; /* where the next frame is to be saved as a model; "": nowhere */
} console_shared;

typedef struct console {
    const tool *t;
    const char *record; /* the folder of --record, or NULL */
    web *web;
    inbox *inbox;
    steering *steering; /* what moves the probe beside pages; NULL: nothing does */
    pose steered;       /* its last pose, in its frame */
    bool has_steered;
    bool waits;   /* this pose, until a hand has been still for a while */
    bool by_hand; /* a page has moved the probe last */
    double hand;  /* s, by clock_now: when a hand did */
    address at;
    const char *token; /* or NULL */
    cases cases;
    char kept[CONSOLE_FILE]; /* the folder of what is saved without --record: made when it is needed */
    int saves;
    /* The case that is open. */
    int open;  /* -1: none */
    bool face; /* else ultrasound */
    bool paused, recording, replaying;
    char why[CONSOLE_LINE]; /* why no case is open, or why a tool is not alive; "": no reason */
    char method[CONSOLE_WORD];
    dials dials, knobs; /* of the tool that computes, and of us-slice */
    source body;        /* the model, without its frames; with the surfaces around it */
    around around;
    geometry *scene;
    child compute, slice;
    bool has_compute, has_slice; /* were started */
    bool told[2];                /* that they ended */
    feed *feed;
    images *images;
    expression_names expressions; /* "@smile", of a face */
    double *level;                /* muscles, then expressions: as asked for last */
    colouring_room colours;       /* console_show's own, once a case is open */
    atomic_int colour;            /* a colouring */
    struct {
        char id[CONSOLE_WORD], line[CONSOLE_LINE];
    } pulls[CONSOLE_PULLS];
    int pull_count;
    double began;                  /* s, by clock_now: poses' time 0 */
    char records[2][CONSOLE_FILE]; /* the last ones: of the tool that computes, and of us-slice; "": none */
    pose pose;                     /* the last */
    console_shared shared;
    atomic_llong frames;             /* that were shown */
    double drawn, imaged;            /* s, by clock_now: positions and an image; each its thread's own */
    double making;                   /* s: what positions take, smoothed; its thread's own */
    atomic_uint_least64_t time_bits; /* of the newest frame's time */
} console;

/* ---- console_case.c: opening and closing cases */

/* Opens a case, or what is open anew, after what was open is closed. replay: shows the records of what ran last. -1
 * with e filled, and no case is open. */
int console_open(console *c, int index, bool replay, err *e);
void console_close(console *c);

/* The name of a muscle of the case that is open, or "@" and that of an expression, which come after them, for i from 0
 * on; NULL: there is none. */
const char *console_muscle(const console *c, int64_t i);

/* Says of children that ended what there is to say. */
void console_look(console *c);

/* ---- console_take.c: what pages ask for */

void console_take(console *c, int client, const message *m);

/* The client that poses come from which no page has sent: console_steered puts them into the inbox, by another thread.
 */
enum { CONSOLE_STEERING = -2 };
void console_steered(void *context, const pose *at);

/* Lets a pose that waits for a hand to be still have its turn. -1 with e filled. */
int console_steer(console *c, err *e);

/* The path of a file that a page may have: see web_plan. */
int console_file(void *context, const char *uri, char path[WEB_PATH]);

/* The folder for what is saved: --record's, or one of its own. NULL with e filled. */
const char *console_folder(console *c, err *e);
void console_remove_folder(console *c);

/* Sends a pose in the model's axes to the tool that computes, and to others who listen. -1 with e filled. */
int console_pose(console *c, const pose *at, err *e);

/* Puts the probe where a case begins: at this pose, or where what steers it has it. -1 with e filled. */
int console_begin_pose(console *c, const pose *at, err *e);

/* ---- console_state.c */

void console_send_state(console *c);

/* ---- console_show.c: for other threads too */

void console_said(void *context, const char *name, const char *line);
void console_heard(void *context, const char *name, const char *line); /* of what steers the probe, and of igtl-out */
void console_show(void *context, const model *m, const frame *f);
bool console_wants_image(void *context);
bool console_wants_raw(void *context);
void console_show_image(void *context, mail *m);
double console_time(void *context);
void console_failed(void *context, const char *name, const err *e);
void console_begin_showing(console *c);

#endif
