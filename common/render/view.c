#include "render/view.h"

#include "base/num.h"

#include <math.h>

static vec vec_narrow(const double *p)
{
    return (vec){(float)p[0], (float)p[1], (float)p[2]};
}

/* The digits of i in some base, mirrored at the point: evenly spread numbers of [0, 1). */
static float mirrored(unsigned i, unsigned base)
{
    float digit = 1, sum = 0;
    for (; i; i /= base) {
        digit /= (float)base;
        sum += digit * (float)(i % base);
    }
    return sum;
}

/* The second dimension of Sobol's sequence: with mirrored(i, 2), any 4^n points on
 * from a multiple lie one in each cell. */
static float sobol(unsigned i)
{
    unsigned sum = 0;
    for (unsigned direction = 1u << 31; i; i >>= 1, direction ^= direction >> 1)
        if (i & 1)
            sum ^= direction;
    return (float)(sum >> 8) / (float)(1 << 24);
}

/* A point of the unit disc by area. */
static void disc(float a, float b, float *x, float *y)
{
    float radius = sqrtf(a), angle = 6.2831853f * b;
    *x = radius * cosf(angle);
    *y = radius * sinf(angle);
}

/* In a cell of pixels each has its own few directions, and the cell together has them all: what is then averaged over
 * any cell of a smooth place has no grain. */
static void set_patterns(view *v)
{
    for (unsigned p = 0; p < VIEW_CLASSES; p++) {
        for (unsigned k = 0; k < VIEW_NEAR; k++) {
            unsigned i = VIEW_NEAR * p + k;
            float a = mirrored(i, 2) + .5f / (VIEW_CLASSES * VIEW_NEAR), x, y;
            disc(a, sobol(i), &x, &y);
            v->near_by[p][k] = (vec){x, y, sqrtf(1 - a)};
            v->near_length[p][k] = .05f + .95f * mirrored(i + 1, 3);
        }
        float x, y;
        disc(mirrored(p, 2) + .5f / VIEW_CLASSES, sobol(p), &x, &y);
        vec side = vec_unit(vec_cross(v->key, v->unit_up));
        vec lamp = vec_along(v->key, side, .06f * x);
        v->lamp[p] = vec_unit(vec_along(lamp, vec_cross(side, v->key), .06f * y));
    }
    /* One in each row and each column of an 8 x 8 grid. */
    static const int row[VIEW_SUBPIXELS] = {2, 5, 0, 7, 3, 6, 1, 4};
    for (int i = 0; i < VIEW_SUBPIXELS; i++) {
        v->subpixel[i][0] = ((float)i + .5f) / VIEW_SUBPIXELS;
        v->subpixel[i][1] = ((float)row[i] + .5f) / VIEW_SUBPIXELS;
    }
}

void view_set(view *v, const camera *c, const image *im, const double low[3], const double high[3])
{
    double diagonal = 0, most = 0;
    for (int i = 0; i < 3; i++) {
        diagonal += (high[i] - low[i]) * (high[i] - low[i]);
        most = fmax(most, fmax(fabs(low[i]), fabs(high[i])));
    }
    diagonal = sqrt(diagonal);
    v->width = im->width;
    v->height = im->height;
    v->orthographic = c->orthographic;
    v->pixel = (float)(2 * c->half_height / im->height);
    v->eye = vec_narrow(c->eye);
    v->forward = vec_narrow(c->forward);
    v->unit_right = vec_narrow(c->right);
    v->unit_up = vec_narrow(c->up);
    v->right = vec_scale(v->unit_right, v->pixel);
    v->up = vec_scale(v->unit_up, v->pixel);
    v->offset = (float)(1e-5 * diagonal + 1e-6 * most);
    v->reach = (float)(v->options->reach * diagonal);
    vec key = vec_along(vec_scale(v->unit_right, -.45f), v->unit_up, .6f);
    vec fill = vec_along(vec_scale(v->unit_right, .8f), v->unit_up, .1f);
    v->key = vec_unit(vec_along(key, v->forward, -.75f));
    v->fill = vec_unit(vec_along(fill, v->forward, -.6f));
    set_patterns(v);
}

static int clamp(double x, int most)
{
    return (int)num_clamp(x, 0, most);
}

void view_window(const view *v, const camera *c, const double low[3], const double high[3], int window[4])
{
    double from[2] = {INFINITY, INFINITY}, to[2] = {-INFINITY, -INFINITY};
    bool before = true;
    for (int k = 0; k < 8; k++) {
        double p[3], at[2];
        for (int i = 0; i < 3; i++)
            p[i] = k >> i & 1 ? high[i] : low[i];
        before = before && camera_project(c, v->width, v->height, p, at);
        for (int i = 0; before && i < 2; i++) {
            from[i] = fmin(from[i], at[i]);
            to[i] = fmax(to[i], at[i]);
        }
    }
    const int most[2] = {v->width, v->height};
    for (int i = 0; i < 2; i++) {
        window[i] = before ? clamp(floor(from[i]) - 2, most[i]) : 0;
        window[2 + i] = before ? clamp(ceil(to[i]) + 2, most[i]) : most[i];
    }
}
