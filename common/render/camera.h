/* A camera: an eye, three axes and a perspective or orthographic projection. Directions are unit vectors in the model's
 * frame. Pixel (0, 0) is the upper left; its centre is at (0.5, 0.5). It owns nothing.
 */
#ifndef SINEW_RENDER_CAMERA_H
#define SINEW_RENDER_CAMERA_H

#include "render/scene.h"

typedef struct camera {
    bool orthographic;
    double eye[3];
    double right[3], up[3], forward[3];
    double half_height; /* what is seen above the axis: perspective: at distance 1 (the tangent); orthographic: in m */
} camera;

/* The names of views, separated by ", ", for messages. */
#define CAMERA_VIEWS "front, back, left, right, top, bottom, three-quarter"

/* An axis by its name, with or without a sign: "z", "+y", "-x". -1 with e filled. */
int camera_axis(const char *name, double axis[3], err *e);

/* Turns the camera to a named view of a model whose up and front are as given (front: the way that it looks, so "front"
 * looks the other way; "left" is seen from the model's own left). Eye and half_height are for camera_fit_* to set. -1
 * with e filled: no such view (a near miss is offered), or up and front along one line. */
int camera_view(camera *c, const char *name, const double up[3], const double front[3], err *e);

/* A camera at a place that looks at another; angle: the field of view from top to bottom, degrees, for
 * perspective, or the height seen, m, for orthographic. -1 with e filled: the two are one place, up is along the
 * view, or an angle that is none. */
int camera_look(camera *c, const double eye[3], const double target[3], const double up[3], bool orthographic,
                double angle, err *e);

/* Moves a turned camera so that all of it is seen, as large as can be, in a picture of width by height pixels with at
 * least a share margin (0 to under .5) of the shorter side free on every side. angle: the field of view, degrees, from
 * top to bottom; 0: orthographic. -1 with e filled: nothing to see, sizes or angle that are none. */
int camera_fit_scene(camera *c, const scene *s, int width, int height, double angle, double margin, err *e);

/* The place of a point in a picture, in pixels. False: not before the eye. */
bool camera_project(const camera *c, int width, int height, const double point[3], double pixel[2]);

/* The metres that one pixel's height spans at a point. */
double camera_pixel(const camera *c, int height, const double point[3]);

#endif
