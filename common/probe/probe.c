#include "probe/probe.h"

#include "base/num.h"
#include "base/path.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846, usual_edge = .25;
/* Sizes past which distances lose their meaning: m, and degrees. */
static const double least_length = 1e-9, most_length = 1e6, least_angle = 1e-6, most_angle = 180;

static const char expected[] = "sphere:RADIUS, linear:WIDTH,THICKNESS, curved:RADIUS,DEGREES,THICKNESS (both with an "
                               "edge's radius after it, if you like) "
                               "or convex:FILE.obj, such as sphere:2cm or linear:4cm,1cm";

probe probe_sphere(double radius)
{
    probe p = {.kind = PROBE_SPHERE, .radius = radius, .middle = {0, 0, -radius}, .reach = radius, .size = radius};
    return p;
}

probe probe_linear(double width, double thickness, double edge)
{
    const double tall = fmax(width, thickness), sides[3] = {width, thickness, tall};
    probe p = {.kind = PROBE_LINEAR, .width = width, .thickness = thickness, .edge = edge};
    for (int a = 0; a < 3; a++)
        p.half[a] = fmax(0, .5 * sides[a] - edge);
    p.middle[2] = -.5 * tall;
    p.reach = edge + sqrt(p.half[0] * p.half[0] + p.half[1] * p.half[1] + p.half[2] * p.half[2]);
    p.size = .5 * fmin(width, thickness);
    return p;
}

/* The largest circle in a sector. */
static double in_sector(double radius, double sine)
{
    return radius * sine / (1 + sine);
}

probe probe_curved(double radius, double angle, double thickness, double edge)
{
    probe p = {.kind = PROBE_CURVED, .radius = radius, .angle = angle, .thickness = thickness, .edge = edge};
    p.sine = sin(.5 * angle);
    p.cosine = angle >= pi ? 0 : cos(.5 * angle);
    p.half[1] = fmax(0, .5 * thickness - edge);
    p.disc = radius - edge;
    p.tip = edge / p.sine;
    p.side = fmax(0, sqrt(fmax(0, p.disc * p.disc - edge * edge)) - p.tip * p.cosine);
    /* All of the sector is as near to the middle of its axis as the tip is, or to the
     * foot of its corners where it is wider. */
    double foot = p.cosine * radius, across = p.sine * radius;
    double middle = foot > across ? .5 * radius / p.cosine : foot;
    double flat = fmax(middle, fmax(radius - middle, hypot(across, foot - middle)));
    p.middle[2] = middle - radius;
    p.reach = sqrt(flat * flat + .25 * thickness * thickness);
    p.size = fmin(.5 * thickness, in_sector(radius, p.sine));
    return p;
}

static bool is_length(double x)
{
    return x >= least_length && x <= most_length;
}

/* Lengths, or numbers, between commas: `least` to `most` of them, metres; degrees stands
 * for which of them is an angle, or -1. */
static int numbers(const char *text, const char *list, int least, int most, int degrees, double *to, err *e)
{
    num_length length[4];
    int count = num_lengths_of(list, length, most);
    if (count < least)
        return err_usage(e, "--probe %.100s: '%.80s' is not a list of lengths; expected %s", text, list, expected);
    for (int i = 0; i < count; i++) {
        to[i] = i == degrees ? length[i].value : num_length_in(length[i], num_unit_of("m"), num_unit_of("m"));
        if (i == degrees && (length[i].unit || !(to[i] >= least_angle && to[i] <= most_angle)))
            return err_set(e, NULL, 0, "--probe %.100s: an angle of %g%s; expected degrees, %g to %g", text, to[i],
                           length[i].unit ? num_unit_name(length[i].unit) : "", least_angle, most_angle);
        if (i != degrees && !is_length(to[i]) && !(i == most - 1 && i >= least && to[i] == 0))
            return err_set(e, NULL, 0, "--probe %.100s: a length of %g m; expected %g to %g m", text, to[i],
                           least_length, most_length);
    }
    return count;
}

/* An edge that was given must go in. */
static int check_edge(const char *text, double edge, double most, err *e)
{
    if (edge <= most)
        return 0;
    return err_set(e, NULL, 0, "--probe %.100s: an edge of %g m does not fit into it; expected at most %g m", text,
                   edge, most);
}

static int read_sphere(probe *p, const char *text, const char *list, err *e)
{
    num_length radius;
    if (num_length_of(list, &radius))
        return err_usage(e, "--probe %.100s: '%.80s' is not a length; expected sphere:RADIUS, such as sphere:2cm", text,
                         list);
    double r = num_length_in(radius, num_unit_of("m"), num_unit_of("m"));
    if (!is_length(r))
        return err_set(e, NULL, 0, "--probe %.100s: a radius of %g m; expected %g to %g m", text, r, least_length,
                       most_length);
    *p = probe_sphere(r);
    return 0;
}

static int read_linear(probe *p, const char *text, const char *list, err *e)
{
    double n[3] = {0};
    int count = numbers(text, list, 2, 3, -1, n, e);
    if (count < 0)
        return -1;
    double least = fmin(n[0], n[1]), edge = count == 3 ? n[2] : usual_edge * least;
    *p = probe_linear(n[0], n[1], edge);
    return check_edge(text, edge, .5 * least, e);
}

static int read_curved(probe *p, const char *text, const char *list, err *e)
{
    double n[4] = {0};
    int count = numbers(text, list, 3, 4, 1, n, e);
    if (count < 0)
        return -1;
    double angle = n[1] * pi / 180, most = fmin(.5 * n[2], in_sector(n[0], sin(.5 * angle)));
    double edge = count == 4 ? n[3] : fmin(usual_edge * n[2], .5 * most);
    *p = probe_curved(n[0], angle, n[2], edge);
    return check_edge(text, edge, most, e);
}

static int read_convex(probe *p, const char *text, const char *file, err *e)
{
    *p = (probe){.kind = PROBE_CONVEX, .file = file};
    return *file ? 0 : err_usage(e, "--probe %.100s: no file; expected convex:FILE.obj", text);
}

int probe_of(probe *p, const char *text, err *e)
{
    static const struct {
        const char *name;
        int (*read)(probe *, const char *, const char *, err *);
    } kinds[] = {
        {"sphere:", read_sphere}, {"linear:", read_linear}, {"curved:", read_curved}, {"convex:", read_convex}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (!strncmp(text, kinds[i].name, strlen(kinds[i].name)))
            return kinds[i].read(p, text, text + strlen(kinds[i].name), e);
    return err_usage(e, "--probe %.100s; expected %s", text, expected);
}

/* The farthest point of a curved array less its edge, along a direction of its
 * plane: of the arc, a corner or the tip. */
static void far_in_sector(const probe *p, double x, double z, double to[2])
{
    const double mirror = x < 0 ? -1 : 1, u = fabs(x), length = hypot(x, z);
    const double corner[2] = {p->side * p->sine, p->side * p->cosine + p->tip};
    bool arc = u * corner[1] <= z * corner[0] && length > 0;
    bool tip = !arc && u * corner[0] + z * corner[1] < z * p->tip;
    to[0] = tip ? 0 : mirror * corner[0];
    to[1] = tip ? p->tip : corner[1];
    if (arc) {
        to[0] = p->disc * x / length;
        to[1] = p->disc * z / length;
    }
    to[1] -= p->radius;
}

static const double *far_corner(const probe *p, const double d[3])
{
    const double *best = p->corner;
    double most = -INFINITY;
    for (int32_t i = 0; i < p->corners; i++) {
        const double *x = p->corner + 3 * (int64_t)i;
        double along = d[0] * x[0] + d[1] * x[1] + d[2] * x[2];
        if (along > most) {
            most = along;
            best = x;
        }
    }
    return best;
}

/* Of what is rounded by the edge; of a sphere its centre. */
static void far_core(const probe *p, const double d[3], double to[3])
{
    double flat[2];
    for (int a = 0; a < 3; a++)
        to[a] = p->middle[a] + (d[a] < 0 ? -p->half[a] : p->half[a]);
    if (p->kind == PROBE_CURVED) {
        far_in_sector(p, d[0], d[2], flat);
        to[0] = flat[0];
        to[2] = flat[1];
    }
    if (p->kind == PROBE_CONVEX)
        for (int a = 0; a < 3; a++)
            to[a] = far_corner(p, d)[a];
}

void probe_farthest(const probe *p, const double d[3], double to[3])
{
    const double edge = p->kind == PROBE_SPHERE ? p->radius : p->edge;
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    far_core(p, d, to);
    for (int a = 0; a < 3 && length > 0; a++)
        to[a] += edge * d[a] / length;
}

void probe_text(const probe *p, char *to, size_t size)
{
    const double degrees = p->angle * 180 / pi;
    if (p->kind == PROBE_SPHERE)
        snprintf(to, size, "sphere:%.9gm", p->radius);
    else if (p->kind == PROBE_LINEAR)
        snprintf(to, size, "linear:%.9gm,%.9gm,%.9gm", p->width, p->thickness, p->edge);
    else if (p->kind == PROBE_CURVED)
        snprintf(to, size, "curved:%.9gm,%.9g,%.9gm,%.9gm", p->radius, degrees, p->thickness, p->edge);
    else
        snprintf(to, size, "convex:%.250s", p->file + path_folder(p->file));
}

double probe_lever(const probe *p)
{
    return p->reach + sqrt(p->middle[0] * p->middle[0] + p->middle[1] * p->middle[1] + p->middle[2] * p->middle[2]);
}

bool probe_is_thin(const probe *p, double side)
{
    return 2 * p->size < .99 * side;
}

bool probe_is_plate(const probe_placed *at, const double *position, int64_t nodes)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int64_t n = 0; n < nodes; n++)
        for (int i = 0; i < 2; i++) {
            const double *x = position + 3 * n;
            double along = at->axis[i][0] * x[0] + at->axis[i][1] * x[1] + at->axis[i][2] * x[2];
            low[i] = fmin(low[i], along);
            high[i] = fmax(high[i], along);
        }
    const probe *s = &at->shape;
    double wide = 2 * s->size, thick = wide;
    if (s->kind == PROBE_LINEAR || s->kind == PROBE_CURVED) {
        wide = s->kind == PROBE_LINEAR ? s->width : 2 * s->radius * s->sine;
        thick = s->thickness;
    }
    return wide > high[0] - low[0] && thick > high[1] - low[1];
}

void probe_free(probe *p)
{
    free(p->plane);
    free(p->corner);
    free(p->face);
    p->plane = p->corner = NULL;
    p->face = NULL;
    p->planes = p->corners = p->faces = 0;
}
