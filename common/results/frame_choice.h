/* Which arrays the frames of a solver have, and which of them are stored as f32: --frames of tled-run and msds-run.
 * The solver offers what its frames can have, reads the list, and hands each frame over before it is written. Without
 * a list frames have all that is offered, as f64, but bound surfaces, which are not computed then. The creator owns a
 * choice; it borrows from the model.
 */
#ifndef SINEW_FRAME_CHOICE_H
#define SINEW_FRAME_CHOICE_H

#include "base/pool.h"
#include "cli/opt.h"
#include "model/model.h"

/* For the help and completion. */
#define FRAME_CHOICE_WORDS "displacement|velocity|surfaces|bodies|forces|probe"

enum {
    FRAME_CHOICE_ALWAYS = 1,  /* another option asks for it: frames have it whether the list does or not */
    FRAME_CHOICE_LISTED = 2,  /* frames have it only where the list does */
    FRAME_CHOICE_PERHAPS = 4, /* what comes live, or from a record, decides whether frames have it */
    FRAME_CHOICE_EMPTY = 8    /* frames have it, but it says nothing in this run: a list may not name it */
};

typedef struct frame_array {
    char name[MODEL_NAME];
    int flags;
    bool wanted, listed, narrow;
} frame_array;

typedef struct frame_choice {
    frame_array *array;
    int64_t arrays, capacity;
    struct frame_surface *surface; /* those bound surfaces that are wanted */
    int64_t surfaces;
    bool is_given;     /* there is a list */
    bool follows;      /* types are those of the frames before */
    const char *empty; /* what a list that names what is empty is told to expect */
} frame_choice;

/* Adds an array that frames can have; twice is once. -1 with e filled, as for all below; free it all the same. */
int frame_choice_offer(frame_choice *c, const char *name, int flags, err *e);

/* Offers the displacement of each bound surface of the model, NAME/vertex.displacement, where a list has it. */
int frame_choice_offer_bound(frame_choice *c, const model *m, err *e);

/* Chooses by a list of NAME[:f32|:f64]: names of arrays, or words for several. Status 2 where one is wrong. */
int frame_choice_read(frame_choice *c, const opt_list *list, err *e);

/* Whether frames have the array; whether they have it as f32, in place of f64; and whether they have one whose name
 * begins so. */
bool frame_choice_has(const frame_choice *c, const char *name);
bool frame_choice_narrow(const frame_choice *c, const char *name);
bool frame_choice_has_of(const frame_choice *c, const char *beginning);

/* Gets ready to move the bound surfaces that are wanted, once the model has all its arrays. */
int frame_choice_open(frame_choice *c, const model *m, err *e);

/* Whether bound surfaces are wanted, for which a frame needs body.pose, where there are bodies. */
bool frame_choice_moves(const frame_choice *c);

/* Sets to 1 those of `node` (nodes) whose displacement moves the bound surfaces that are wanted, once they are open. */
void frame_choice_mark(const frame_choice *c, uint8_t *node);

/* Adds the bound surfaces to a frame of m, as sinew deform moves them; displacement: nodes x 3, m, of which those that
 * frame_choice_mark tells are read. threads: may be NULL. */
int frame_choice_add_surfaces(const frame_choice *c, frame *f, const model *m, const double *displacement,
                              pool *threads, err *e);

/* Drops the arrays of a frame that are not wanted, and makes those narrow that are stored as f32. */
void frame_choice_take(const frame_choice *c, frame *f);

/* For frames that go on behind others, of which `before` is the last: without a list, arrays that are f32 there are so
 * in those to come. Refuses other arrays, or with a list other types. where: the stream's name. */
int frame_choice_follow(frame_choice *c, const frame *before, const char *where, err *e);

void frame_choice_free(frame_choice *c);

#endif
