/* Traces a scene into an image: matte surfaces under a soft key and fill light, with ambient light that is dimmed where
 * surfaces lie close together, edges as dark lines of constant width, and antialiased outlines. The same scene, camera
 * and options give the same bytes for any number of threads.
 */
#ifndef SINEW_RENDER_TRACE_H
#define SINEW_RENDER_TRACE_H

#include "picture/image.h"
#include "render/camera.h"
#include "render/scene.h"

typedef struct trace_options {
    float background[4]; /* premultiplied linear RGBA */
    double edge_width;   /* of drawn edges, in pixels */
    double occlusion;    /* how much of the ambient light nearness takes: 0 none, 1 all */
    double reach;        /* how far it sees, as a share of the scene's diagonal */
    bool shadows;        /* the key light casts them */
    bool draft;          /* one ray a pixel, no ambient occlusion: for looking quickly */
} trace_options;

/* White background, edges 1.1 pixels wide, ambient occlusion and no shadows. */
trace_options trace_defaults(void);

/* What a trace took; for -v. */
typedef struct trace_report {
    double build, trace; /* s */
    int64_t faces, spheres, rays;
    int64_t covered; /* pixels in which anything is seen: 0 is an empty picture */
} trace_report;

/* Draws into im, which keeps its size and is overwritten whole. Of meshes in one plane the last is seen.
 * report may be NULL. -1 with e filled: a scene that does not check, a camera that is not finite, no memory.
 * An empty scene is the background alone. */
int trace(const scene *s, const camera *c, image *im, pool *p, const trace_options *o, trace_report *report, err *e);

#endif
