/* A run of msds-run: what it was asked for, the problem, the state of the solver, and where it has come to. The main
 * owns it, zeroed to begin with; the modules beside this one make it, take it from frame to frame, and tell of it.
 */
#ifndef SINEW_SESSION_H
#define SINEW_SESSION_H

#include "cli/progress.h"
#include "frames/frame_queue.h"
#include "live/broadcast.h"
#include "model/stage.h"
#include "msds/problem/largest.h"
#include "msds/problem/problem.h"
#include "msds/run/cavities.h"
#include "msds/run/compare.h"
#include "msds/run/frame_nodes.h"
#include "msds/run/inverted.h"
#include "msds/run/methods.h"
#include "msds/run/openness.h"
#include "msds/run/press.h"
#include "msds/run/run_options.h"
#include "msds/run/skin_model.h"
#include "results/frame_choice.h"
#include "volume/placing.h"

enum { MASS_STABLE, MASS_LUMPED, SESSION_TEXTS = 16 };

/* What has to take over a setting that changes. */
typedef enum session_part {
    SESSION_PACE,    /* how many iterations a frame takes */
    SESSION_FORCES,  /* gravity, and the kind of contact */
    SESSION_STEP,    /* the step of springs, and their inertia */
    SESSION_SPRINGS, /* the springs themselves, and with them their step */
    SESSION_PROBE,
    SESSION_SKIN,
    SESSION_CAVITIES,
} session_part;

/* The largest value of all frames: of a displacement (m) or of the force on the probe (N). */
typedef struct peak {
    double value, time;
    int64_t contacts;
} peak;

typedef struct session {
    const tool *t;
    struct options *o; /* as they are now */
    stage stage;
    model m;
    msds_problem problem;
    cavities cavities;
    probe probe;
    press press;
    skin skin;
    char skin_name[SURFACE_NAME_MOST + 1];
    largest largest;
    int64_t substeps;
    double stable, sure; /* s: steps of springs that are stable at rest, and in any configuration */
    bool springs_told;
    const msds_executor *device;
    executor_ahead ahead;
    pthread_mutex_t *card; /* of a job of --batch: one at a time computes on a card; NULL: no such job */
    pool *threads;
    msds_state *state;
    frame_queue *queue;  /* of frames on their way out */
    frame_choice frames; /* the arrays that they have */
    err unfit;           /* of a replay: why its frames cannot follow those that came */
    frame_nodes of_nodes;
    inverted inverted;
    openness openness;
    compare *other;       /* the other method, or NULL */
    const char *source;   /* of the poses, for messages */
    method_word method;   /* now */
    method_word used;     /* of the last frame */
    method_word last_fem; /* the last but springs: what springs are compared with */
    press_moves moves;    /* of the last frame, and its plan */
    msds_plan plan;
    placing placing;      /* of --body and --marker */
    body around;          /* of --body; empty where there is none */
    broadcast *socket;    /* of --haptics; or NULL */
    msds_reading reading; /* of the last frame */
    int64_t next_frame;
    progress progress;
    msds_listener listener;
    int64_t posed;     /* frames made */
    double time;       /* s: of the last, or of the last that the model came with */
    double elapsed;    /* s: between the last two; 0 for the first */
    double first_done; /* s, by clock_now: when the first frame was solved and sent, which makes what a method needs */
    double solving;    /* s, by the clock: to solve the frames after it */
    peak moved, pushed;
    bool pressed; /* some node, in some frame */
    bool dented;  /* the skin */
    bool inside_told;
    int64_t stopped;      /* frames in which bone kept the probe from its pose */
    double stopped_first; /* s: the first of them */
    bool diverged;        /* in the last frame */
    notes warnings;
    char *text[SESSION_TEXTS]; /* of settings that changed, which the options point to; owned */
} session;

/* Starts to make the device ready that the options ask for, while the model is read. */
void session_ahead(session *s);

/* Reads the probe and the skin, makes the problem of the model, and chooses the device, the method and the step. -1
 * with e filled, as for all below; to be freed all the same. */
int session_prepare(session *s, err *e);
void session_free(session *s);

/* What decides the result and is not on the command line. */
int session_provenance(const session *s, tool *t, err *e);

/* Passes on the frames that came, starts from the last, and makes the state. */
int session_start(session *s, err *e);

/* Waits until all frames are written, and tells (-v) how long they took, where the run has ended well. -1 with e filled
 * where one could not be. */
int session_finish(session *s, bool ended, err *e);

/* Gives back what the run has on the device. */
void session_leave(session *s);

/* Takes over the options, of which some of one part have changed, from the next frame on. */
int session_change(session *s, session_part part, err *e);

/* Refuses friction with a method that has none: -1 with e filled (status 2). */
int session_slides(const session *s, method_word method, double friction, err *e);

/* The method from the next frame on. */
void session_method(session *s, method_word method);

#endif
