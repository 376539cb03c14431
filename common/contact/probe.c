#include "contact/probe.h"

#include "base/num.h"

#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846, largest = 1e6 /* m */, usual_edge = .25;

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
    /* All of the sector is as near to the middle of its axis as the tip is, or to the foot of its corners where it is wider. */
    double foot = p.cosine * radius, across = p.sine * radius;
    double middle = foot > across ? .5 * radius / p.cosine : foot;
    double flat = fmax(middle, fmax(radius - middle, hypot(across, foot - middle)));
    p.middle[2] = middle - radius;
    p.reach = sqrt(flat * flat + .25 * thickness * thickness);
    p.size = fmin(.5 * thickness, in_sector(radius, p.sine));
    return p;
}

static bool above_0(double x)
{
    return x > 0 && x <= largest;
}

/* Lengths, or numbers, between commas: `least` to `most` of them, metres; degrees stands for which of them is an angle, or -1. */
static int numbers(const char *text, const char *list, int least, int most, int degrees, double *to, err *e)
{
    num_length length[4];
    int count = num_lengths_of(list, length, most);
    if (count < least)
        return err_usage(e, "--probe %.100s: '%.80s' is none of its lists of lengths; expected %s", text, list,
                         expected);
    for (int i = 0; i < count; i++) {
        to[i] = i == degrees ? length[i].value : num_length_in(length[i], num_unit_of("m"), num_unit_of("m"));
        if (i == degrees && (length[i].unit || !(to[i] > 0) || to[i] > 180))
            return err_usage(e, "--probe %.100s: an angle of %g%s; expected degrees above 0, at most 180", text, to[i],
                             length[i].unit ? num_unit_name(length[i].unit) : "");
        if (i != degrees && !above_0(to[i]) && !(i == most - 1 && i >= least && to[i] == 0))
            return err_usage(e, "--probe %.100s: a length of %g m; expected one above 0", text, to[i]);
    }
    return count;
}

/* An edge that was given must go in. */
static int check_edge(const char *text, double edge, double most, err *e)
{
    if (edge <= most)
        return 0;
    return err_usage(e, "--probe %.100s: an edge of %g m does not go into it; expected at most %g m", text, edge, most);
}

static int read_sphere(probe *p, const char *text, const char *list, err *e)
{
    num_length radius;
    if (num_length_of(list, &radius))
        return err_usage(e, "--probe %.100s: '%.80s' is no length; expected sphere:RADIUS, such as sphere:2cm", text,
                         list);
    double r = num_length_in(radius, num_unit_of("m"), num_unit_of("m"));
    if (!above_0(r))
        return err_usage(e, "--probe %.100s: a radius of %g m; expected one above 0", text, r);
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

void probe_free(probe *p)
{
    free(p->plane);
    free(p->corner);
    p->plane = p->corner = NULL;
    p->planes = p->corners = 0;
}
