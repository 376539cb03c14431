/* What the parts of tled-run share: the model, the problem made of it, the run and how it is going. main's, who frees
 * what is in it.
 */
#ifndef SINEW_TLED_SESSION_H
#define SINEW_TLED_SESSION_H

#include "cli/progress.h"
#include "model/stage.h"
#include "results/frame_choice.h"
#include "results/results.h"
#include "tled/contact/self_contact.h"
#include "tled/contact/sliding.h"
#include "tled/loop/checkpoint.h"
#include "tled/loop/folds.h"
#include "tled/loop/relax.h"
#include "tled/loop/run.h"
#include "tled/problem/collider.h"
#include "tled/problem/followers.h"
#include "tled/problem/support.h"

/* Which jobs of a batch compute on a card now. */
typedef struct card_gate {
    pthread_mutex_t lock;
    pthread_cond_t opened;
    int64_t elements; /* of their models, in all; 0: there are none */
} card_gate;

typedef struct session {
    const tool *t;
    stage stage;
    model m;
    script script;
    expressions expressions;
    tled_problem problem;
    support support;
    collider collider;
    sliding sliding;
    self_contact skin; /* that touches itself */
    executor_ahead ahead;
    pool *threads;
    run_setup run;
    run_log log;
    progress progress;
    checkpoint *checkpoint; /* NULL: none */
    int64_t next_frame;     /* its index */
    card_gate *card;        /* of a batch, whose model is as it is to be; NULL: of none */
    bool started;           /* the state that the run begins from has been written: as a frame that came */
    int64_t cut;            /* parts of a step, as said last */
    double stable;          /* s: at rest */
    folds folds;            /* of the frames written */
    int64_t beyond;         /* likewise, the most nodes that slid beyond a distance field */
    results *results;       /* that frames get; NULL: none; owned */
    frame_choice frames;    /* the arrays that they have */
    double *activation;     /* volumes: of the frame that is written, where there are results; owned */
    struct live *live;      /* NULL: not a live run, nor a replay; owned */
    notes warnings;
} session;

#endif
