/* The constants of a trace, which all its tiles share: the scene with its trees, the camera in floats, the lights and
 * the sample patterns. trace() owns it.
 */
#ifndef SINEW_RENDER_VIEW_H
#define SINEW_RENDER_VIEW_H

#include "render/trace.h"
#include "render/vec.h"
#include "surface/embree.h"

enum { VIEW_CELL = 4, VIEW_CLASSES = VIEW_CELL * VIEW_CELL, VIEW_NEAR = 4, VIEW_SUBPIXELS = 8, VIEW_LAYERS = 32 };

typedef struct view {
    const scene *scene;
    const trace_options *options;
    const embree *all, *solid; /* solid: without what is transparent; it may be the same */
    int width, height;
    bool orthographic;
    vec eye, right, up, forward; /* up and right: of one pixel at distance 1 (perspective) or anywhere */
    vec unit_right, unit_up;
    float pixel;                                /* m a pixel: at distance 1, or anywhere */
    float offset, reach;                        /* rays begin this far off a surface; occlusion is seen so far, m */
    vec key, fill;                              /* unit, toward the lights */
    vec near_by[VIEW_CLASSES][VIEW_NEAR];       /* directions about +z, thick toward it */
    float near_length[VIEW_CLASSES][VIEW_NEAR]; /* shares of the reach */
    vec lamp[VIEW_CLASSES];                     /* toward points of the key light */
    float subpixel[VIEW_SUBPIXELS][2];
} view;

/* Fills all but the scene's trees. low and high: its box. */
void view_set(view *v, const camera *c, const image *im, const double low[3], const double high[3]);

/* Pixels [x0, x1) x [y0, y1) that hold all that a box can cover; all of the picture where it reaches behind the eye. */
void view_window(const view *v, const camera *c, const double low[3], const double high[3], int window[4]);

/* The ray through a place in the picture, in pixels. */
static inline void view_ray(const view *v, float x, float y, vec *from, vec *along)
{
    vec across = vec_along(vec_scale(v->right, x - .5f * (float)v->width), v->up, .5f * (float)v->height - y);
    *from = v->orthographic ? vec_add(v->eye, across) : v->eye;
    *along = v->orthographic ? v->forward : vec_add(v->forward, across);
}

/* How far before the eye, in m; it is also how far along its view_ray. */
static inline float view_depth(const view *v, vec place)
{
    return vec_dot(vec_sub(place, v->eye), v->forward);
}

static inline float view_pixel(const view *v, vec place)
{
    return v->orthographic ? v->pixel : v->pixel * view_depth(v, place);
}

#endif
