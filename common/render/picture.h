/* A picture of a model: one panel or a sheet of several, each with its own things, frame and view, with captions and
 * legends. A picture owns what it keeps from one frame to the next (the font, threads and cameras are borrowed or
 * kept), so that the frames of a film are seen alike. The spec is the caller's.
 */
#ifndef SINEW_PICTURE_H
#define SINEW_PICTURE_H

#include "picture/font.h"
#include "render/showing.h"
#include "render/trace.h"

/* From where a panel is seen: by a name, from a direction, or from a place. */
typedef struct picture_view {
    enum { PICTURE_NAMED, PICTURE_FROM, PICTURE_PLACED } kind;
    char name[32];            /* PICTURE_NAMED: of CAMERA_VIEWS */
    double from[3];           /* PICTURE_FROM: from the model toward the eye, any length */
    double eye[3], target[3]; /* PICTURE_PLACED, m */
} picture_view;

typedef struct picture_panel {
    int things; /* SHOWING_*; 0, but for the probe, with no names: surfaces, or voxels where the model carries none */
    bool what_there_is; /* of muscles, rigid nodes and centres only what the model has */
    bool names;         /* the spec's names besides */
    bool moved;         /* by the frame; else at rest */
    bool framed;        /* by that of `index`, not by the picture's */
    int64_t index;
    bool coloured; /* by the spec's field; else by what things are */
    picture_view view;
    bool worded; /* the caption is the user's: no time is added */
    char caption[120];
} picture_panel;

typedef struct picture_cut {
    int axis;
    int side; /* 1: above, -1: below, 0: the side toward the eye */
    double at;
} picture_cut;

enum { PICTURE_PANELS = 12, PICTURE_CUTS = 6 };

typedef struct picture_spec {
    int width, height;
    picture_panel panel[PICTURE_PANELS];
    int panels;
    bool captions, transparent;
    bool ranged;
    const char *field; /* NULL: none */
    double low, high;  /* of the scale where `ranged`, SI */
    const char *const *name, *const *clear;
    int names, clears;
    picture_cut cut[PICTURE_CUTS];
    int cuts;
    const char *body;  /* see showing_want; NULL: none */
    const char *slice; /* an image to be seen where it lies, see showing_want; NULL: none */
    double up[3], front[3];
    double angle;  /* field of view, degrees; 0: orthographic */
    double margin; /* share of the shorter side that stays free */
} picture_spec;

typedef struct picture {
    const picture_spec *spec;
    font *font;
    pool *threads;
    image image; /* the last one drawn */
    camera camera[PICTURE_PANELS];
    bool placed; /* the cameras are: later frames keep them */
    colourmap map;
    trace_report report; /* sums over the panels of the last one */
} picture;

/* font and threads stay the caller's, and must outlive the picture. f NULL: it has no words (no captions, no field). */
int picture_open(picture *p, const picture_spec *spec, font *f, pool *threads, err *e);
void picture_close(picture *p);

/* Draws p->image. f: for each panel the frame that moves it; NULL: it is at rest. -1 with e filled. */
int picture_draw(picture *p, const model *m, const frame *const f[PICTURE_PANELS], err *e);

#endif
