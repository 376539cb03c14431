/* Makes the scene that shows a model: carried and bound surfaces, the outside of elements, rigid nodes and contraction
 * centres, at rest or as a frame moves them, in the colours of what they are or of a field. The caller owns a showing;
 * model, frame and field are borrowed while it is made.
 */
#ifndef SINEW_SHOWING_H
#define SINEW_SHOWING_H

#include "model/model.h"
#include "picture/colourmap.h"
#include "render/field.h"
#include "render/scene.h"

/* Takes away the elements whose centres at rest lie on one side of a plane across an axis. */
typedef struct showing_cut {
    int axis;
    bool above; /* takes away what lies above `at`, else below */
    double at;  /* m */
} showing_cut;

enum {
    SHOWING_SURFACES = 1, /* all that the model carries, but muscles within a skin */
    SHOWING_VOXELS = 2,   /* all elements, with edges; cuts open them */
    SHOWING_MUSCLES = 4,  /* the elements of muscles, with edges; whole */
    SHOWING_RIGID = 8,    /* rigid nodes, as spheres */
    SHOWING_CENTRES = 16, /* contraction centres, as spheres */
    SHOWING_PROBE = 32    /* what presses, where the frame has it */
};

enum { SHOWING_THINGS = 6 };

/* The names of the above, in that order, for command lines. */
extern const char *const showing_things[SHOWING_THINGS];

typedef struct showing_want {
    int things;
    const char *const *name; /* surfaces or groups to be seen besides, by name; a '*' at the end matches any rest */
    int names;
    const char *const
        *clear; /* those of the names (or "surface", "voxels", "muscles", "probe") through which one sees; 64 at most */
    int clears;
    const showing_cut *cut;
    int cuts;
    const frame *moved; /* NULL: at rest */
    const field *field; /* NULL: in the colours of what things are */
    const char *slice;  /* a file of us-slice (PGM, PPM), or a pattern as s_%04d.pgm for the frame's; NULL: none */
    const char *body;   /* a body's file (volume/body.h) whose surfaces are to be seen; NULL: none */
} showing_want;

typedef struct showing {
    scene scene;
    double **value; /* a mesh: the field's, one a face (where that mesh has face_colour) or vertex; or NULL */
    int64_t values, value_capacity;
    bool marked; /* the scene's set of spheres `marks` is contraction centres: they are to be seen through all else */
    int64_t marks;
    uint64_t cleared; /* bit k: one sees through something by the want's clear[k] */
    int seen;         /* of SHOWING_*: what there is of it; SHOWING_MUSCLES also where voxels show muscle */
} showing;

/* -1 with e filled: what is wanted is not there (with the names there are), there is
 * nothing to be seen, or no memory. */
int showing_make(showing *b, const model *m, const showing_want *want, err *e);
void showing_free(showing *b);

/* What of SHOWING_MUSCLES, SHOWING_RIGID and SHOWING_CENTRES the model has. */
int showing_there(const model *m);

/* The range of the field in all that is seen. False: nothing has a value. */
bool showing_range(const showing *b, double *low, double *high);

/* Gives what has values its colours: by the scale from low to high, or a colour a name. */
void showing_colour(showing *b, const field *f, const colourmap *map, double low, double high);

/* The colours of what things are, sRGB. */
extern const uint8_t showing_green[3], showing_red[3], showing_centre[3];

#endif
