/* What the command line of sinew-render asks for, understood and checked before anything is read: the picture's spec,
 * which frames, and where to. The plan borrows from the options and owns its lists.
 */
#ifndef SINEW_RENDER_PLAN_H
#define SINEW_RENDER_PLAN_H

#include "cli/frames.h"
#include "cli/numbered.h"
#include "cli/opt.h"
#include "render/picture.h"

enum { RENDER_PNG, RENDER_PPM };

typedef struct render_options {
    opt_common common;
    opt_list show, clear, sheet, cut;
    const char *view, *up, *front, *colour, *frame, *size, *font, *slice, *body;
    opt_lengths camera, range;
    double angle;
    bool transparent, salvage;
    int format;
} render_options;

typedef struct render_plan {
    picture_spec spec;
    frames_which frames;
    int64_t index; /* of FRAMES_ONE */
    bool frame_given;
    bool panels_framed; /* some panels have frames of their own */
    bool files;         /* a file a frame: `names` */
    bool ranged_bare;   /* --range has no unit: SI of whatever is coloured */
    numbered names;
    char *text; /* owned: the lists below point into it */
    const char *name[256];
} render_plan;

/* -1 with e filled (status 2). */
int render_plan_of(render_plan *p, const render_options *o, err *e);
void render_plan_free(render_plan *p);

#endif
