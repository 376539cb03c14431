#include "render/camera.h"

#include "base/near.h"

#include <math.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180;

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double *a, const double *b, double *to)
{
    for (int i = 0; i < 3; i++)
        to[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* False where there is no direction. */
static bool normalise(double *v)
{
    double l = sqrt(dot(v, v));
    if (!(l > 0 && isfinite(l)))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] /= l;
    return true;
}

int camera_axis(const char *name, double axis[3], err *e)
{
    const char *letter = name + (*name == '-' || *name == '+');
    int i = -1;
    if (*letter >= 'x' && *letter <= 'z')
        i = *letter - 'x';
    else if (*letter >= 'X' && *letter <= 'Z')
        i = *letter - 'X';
    if (i < 0 || letter[1])
        return err_set(e, NULL, 0, "no such axis: %s; x, y or z with an optional sign is expected", name);
    axis[0] = axis[1] = axis[2] = 0;
    axis[i] = *name == '-' ? -1 : 1;
    return 0;
}

/* Axes from the way that it looks and what shall be up: false where these are along one line. */
static bool turn(camera *c, const double forward[3], const double up[3])
{
    memcpy(c->forward, forward, sizeof c->forward);
    if (!normalise(c->forward))
        return false;
    cross(c->forward, up, c->right);
    double most = sqrt(dot(up, up));
    if (!(sqrt(dot(c->right, c->right)) > 1e-6 * most) || !normalise(c->right))
        return false;
    cross(c->right, c->forward, c->up);
    return true;
}

/* A view by where it is seen from, in shares of the model's front, up and left, and what is up in the picture. */
typedef struct named_view {
    const char *name;
    double from[3];
    double up[3];
} named_view;

static const named_view views[] = {
    {"front", {1, 0, 0}, {0, 1, 0}},
    {"back", {-1, 0, 0}, {0, 1, 0}},
    {"left", {0, 0, 1}, {0, 1, 0}},
    {"right", {0, 0, -1}, {0, 1, 0}},
    {"top", {0, 1, 0}, {1, 0, 0}},
    {"bottom", {0, -1, 0}, {1, 0, 0}},
    {"three-quarter", {.76, .3, .58}, {0, 1, 0}},
};

enum { VIEWS = sizeof views / sizeof *views };

int camera_view(camera *c, const char *name, const double up[3], const double front[3], err *e)
{
    const char *names[VIEWS];
    int found = -1;
    for (int i = 0; i < VIEWS; i++) {
        names[i] = views[i].name;
        if (!strcmp(name, names[i]))
            found = i;
    }
    if (found < 0)
        return near_option(e, NULL, "view", name, names, VIEWS);
    double axis[3][3], forward[3], above[3];
    memcpy(axis[1], up, sizeof axis[1]);
    cross(up, front, axis[2]);
    double flat = sqrt(dot(axis[2], axis[2])), most = sqrt(dot(up, up) * dot(front, front));
    if (!(flat > 1e-6 * most) || !normalise(axis[1]) || !normalise(axis[2]))
        return err_set(e, NULL, 0, "up and front lie along one line; two directions are expected");
    cross(axis[2], axis[1], axis[0]); /* the front, upright */
    for (int i = 0; i < 3; i++) {
        forward[i] = above[i] = 0;
        for (int k = 0; k < 3; k++) {
            forward[i] -= views[found].from[k] * axis[k][i];
            above[i] += views[found].up[k] * axis[k][i];
        }
    }
    turn(c, forward, above);
    return 0;
}

int camera_look(camera *c, const double eye[3], const double target[3], const double up[3], bool orthographic,
                double angle, err *e)
{
    double forward[3], size = 0;
    for (int i = 0; i < 3; i++) {
        forward[i] = target[i] - eye[i];
        size += fabs(eye[i]) + fabs(target[i]) + fabs(up[i]);
    }
    if (!isfinite(size))
        return err_set(e, NULL, 0, "the camera's position is not finite");
    if (!(dot(forward, forward) > 0))
        return err_set(e, NULL, 0, "the camera and what it looks at are at one place: %g,%g,%g", eye[0], eye[1],
                       eye[2]);
    if (!turn(c, forward, up))
        return err_set(e, NULL, 0, "up (%g,%g,%g) lies along the view; another direction is expected", up[0], up[1],
                       up[2]);
    if (!(angle > 0) || !isfinite(angle) || (!orthographic && angle > 170))
        return err_set(e, NULL, 0,
                       orthographic ? "a height of view of %g m; more than 0 is expected"
                                    : "a field of view of %g degrees; more than 0 to 170 is expected",
                       angle);
    memcpy(c->eye, eye, sizeof c->eye);
    c->orthographic = orthographic;
    c->half_height = orthographic ? angle / 2 : tan(angle / 2 * degree);
    return 0;
}

/* ---- fitting */

/* How far a set of points reaches toward the four sides of a picture and along the view. For perspective, a side's
 * plane through the eye leans by k, and what counts is how far a point lies beyond the plane through the origin: the
 * greatest of (x + k z) and so on; from those of two opposite sides follow the eye's place and distance. */
typedef struct extent {
    const camera *camera;
    double lean[2];             /* right, up; 0: orthographic */
    double most[2][2], near_by; /* [axis][towards + or -]; the greatest z, toward the eye */
} extent;

static inline void exceed(double *most, double x)
{
    *most = x > *most ? x : *most;
}

static void extend(extent *x, const double p[3], double radius)
{
    const camera *c = x->camera;
    const double *axis[2] = {c->right, c->up};
    double z = -dot(c->forward, p);
    for (int i = 0; i < 2; i++) {
        double k = x->lean[i], side = dot(axis[i], p), swell = radius > 0 ? radius * sqrt(1 + k * k) : 0;
        exceed(&x->most[i][0], side + k * z + swell);
        exceed(&x->most[i][1], -side + k * z + swell);
    }
    exceed(&x->near_by, z + radius);
}

static int check_fit(int width, int height, double angle, double margin, err *e)
{
    if (width < 1 || height < 1)
        return err_set(e, NULL, 0, "a picture of %d x %d pixels; at least 1 x 1 is expected", width, height);
    if (!(angle >= 0 && angle <= 170))
        return err_set(e, NULL, 0, "a field of view of %g degrees; 0 (orthographic) to 170 is expected", angle);
    if (!(margin >= 0 && margin < .5))
        return err_set(e, NULL, 0, "a margin of %g; 0 to under .5 of the shorter side is expected", margin);
    return 0;
}

static void begin_fit(extent *x, camera *c, int width, int height, double angle, double margin)
{
    c->orthographic = angle == 0;
    double tangent = tan(angle / 2 * degree), free_ = 2 * margin * fmin(width, height);
    *x = (extent){.camera = c, .near_by = -INFINITY};
    /* The sides that are leant on are those of the picture without its margin. */
    x->lean[0] = tangent * (width - free_) / height;
    x->lean[1] = tangent * (height - free_) / height;
    for (int i = 0; i < 4; i++)
        x->most[i / 2][i % 2] = -INFINITY;
    c->half_height = tangent;
}

static void place_eye(camera *c, double right, double up, double back)
{
    for (int i = 0; i < 3; i++)
        c->eye[i] = right * c->right[i] + up * c->up[i] - back * c->forward[i];
}

static void end_fit(extent *x, camera *c, int width, int height, double margin)
{
    double at[2], half[2], free_ = 2 * margin * fmin(width, height);
    for (int i = 0; i < 2; i++) {
        at[i] = (x->most[i][0] - x->most[i][1]) / 2;
        half[i] = (x->most[i][0] + x->most[i][1]) / 2;
    }
    if (c->orthographic) {
        double across = half[0] * height / (width - free_), along = half[1] * height / (height - free_);
        c->half_height = fmax(fmax(across, along), 1e-9);
        place_eye(c, at[0], at[1], x->near_by + c->half_height);
        return;
    }
    /* Just before the nearest point there is nothing yet: keep a little off it. */
    double back = fmax(half[0] / x->lean[0], half[1] / x->lean[1]);
    place_eye(c, at[0], at[1], fmax(back, x->near_by + 1e-3 * fabs(back - x->near_by) + 1e-9));
}

static void extend_float(extent *x, const float *p, float radius)
{
    const double q[3] = {(double)p[0], (double)p[1], (double)p[2]};
    extend(x, q, (double)radius);
}

int camera_fit_scene(camera *c, const scene *s, int width, int height, double angle, double margin, err *e)
{
    extent x;
    if (scene_check(s, e) || check_fit(width, height, angle, margin, e))
        return -1;
    begin_fit(&x, c, width, height, angle, margin);
    for (int64_t i = 0; i < s->meshes; i++) {
        const scene_mesh *m = &s->mesh[i];
        for (int64_t k = 0; k < m->faces * m->corners; k++)
            extend_float(&x, &m->position[3 * (int64_t)m->corner[k]], 0);
    }
    for (int64_t i = 0; i < s->sphere_sets; i++)
        for (int64_t k = 0; k < s->spheres[i].count; k++)
            extend_float(&x, s->spheres[i].centre_radius + 4 * k, s->spheres[i].centre_radius[4 * k + 3]);
    if (!isfinite(x.near_by))
        return err_set(e, NULL, 0, "nothing to be seen: no faces and no spheres");
    end_fit(&x, c, width, height, margin);
    return 0;
}

/* ---- use */

double camera_pixel(const camera *c, int height, const double point[3])
{
    double depth = 1;
    if (!c->orthographic)
        depth = dot(c->forward, point) - dot(c->forward, c->eye);
    return 2 * c->half_height * depth / height;
}

bool camera_project(const camera *c, int width, int height, const double point[3], double pixel[2])
{
    double from[3];
    for (int i = 0; i < 3; i++)
        from[i] = point[i] - c->eye[i];
    double size = camera_pixel(c, height, point);
    if (!(dot(c->forward, from) > 0 && size > 0))
        return false;
    pixel[0] = .5 * width + dot(c->right, from) / size;
    pixel[1] = .5 * height - dot(c->up, from) / size;
    return true;
}
