#include "place/registration.h"

#include "base/mem.h"
#include "place/pose_fit.h"
#include "place/principal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Points less wide than this part of their length are on a line: the turn about it is not known. */
#define LINE 0.01

/* m: what no tracker sees. */
#define FAR 1e6

/* What is left of a fit, as a part of the points' spread: more is none. And a mirrored fit that leaves this part of it
 * is the right one, where there is something to be told apart. */
#define NO_FIT     0.2
#define MIRRORED   0.5
#define MIRRORS_AT 0.01

/* How points spread: their middle, principal axes (as rows) and the mean squares along these, in descending order. */
typedef struct extent {
    double middle[3], axis[3][3], square[3];
} extent;

static extent extent_of(const double *x, int64_t count)
{
    extent t = {.middle = {0}};
    double c[3][3] = {{0}}, v[3][3];
    for (int64_t i = 0; i < count; i++)
        for (int a = 0; a < 3; a++)
            t.middle[a] += x[3 * i + a] / (double)count;
    for (int64_t i = 0; i < count; i++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                c[a][b] += (x[3 * i + a] - t.middle[a]) * (x[3 * i + b] - t.middle[b]) / (double)count;
    principal_axes(c, v);
    const int first = principal_largest(c), least = principal_smallest(c);
    const int last = least != first ? least : (first + 1) % 3, order[3] = {first, 3 - first - last, last};
    for (int k = 0; k < 3; k++) {
        t.square[k] = fmax(c[order[k]][order[k]], 0);
        for (int a = 0; a < 3; a++)
            t.axis[k][a] = v[a][order[k]];
    }
    return t;
}

static double spread_of(const extent *t)
{
    return sqrt(t->square[0] + t->square[1] + t->square[2]);
}

static int check_line(const extent *t, const char *which, const char *place, err *e)
{
    if (sqrt(t->square[1]) > LINE * sqrt(t->square[0]))
        return 0;
    return err_set(
        e, place, 0,
        "the %s points are on a line, to within %.3g mm (rms) of %.3g mm: how far to turn about it they do not "
        "tell; expected points that are not",
        which, 1e3 * sqrt(t->square[1]), 1e3 * sqrt(t->square[0]));
}

static int check_far(const double *x, int64_t count, const char *which, const char *place, err *e)
{
    for (int64_t i = 0; i < 3 * count; i++)
        if (!(fabs(x[i]) <= FAR))
            return err_set(e, place, 0,
                           "a point of the %s is %.3g m away; expected less than %g m: is it in the right unit?", which,
                           fabs(x[i]), FAR);
    return 0;
}

/* ---- fits */

typedef struct fitting {
    const double *from, *to;
    int64_t count;
    double *source, *way; /* x 3 */
    int32_t *all;
} fitting;

/* Fits with the x of `from` times sign, and gives the rms of what is left. */
static double fit(const fitting *f, double sign, pose *at, double *left)
{
    double sum = 0;
    for (int64_t i = 0; i < 3 * f->count; i++) {
        f->source[i] = f->from[i] * (i % 3 ? 1 : sign);
        f->way[i] = f->to[i] - f->source[i];
    }
    *at = pose_fit(f->source, f->way, f->all, f->count);
    for (int64_t i = 0; i < f->count; i++) {
        double x[3];
        pose_apply(at, f->source + 3 * i, x);
        for (int a = 0; a < 3; a++) {
            const double d = f->to[3 * i + a] - x[a];
            sum += d * d;
            if (left)
                left[3 * i + a] = d;
        }
    }
    return sqrt(sum / (double)f->count);
}

static int check_fit(const registration *r, double mirrored, double other, const char *place, err *e)
{
    if (r->fre > MIRRORS_AT * r->spread && mirrored < MIRRORED * r->fre && mirrored <= NO_FIT * r->spread)
        return err_set(
            e, place, 0,
            "the points fit their partners better mirrored: %.3g mm (rms) are left, and %.3g mm as they are; "
            "expected both in right-handed axes, and the same order",
            1e3 * mirrored, 1e3 * r->fre);
    if (r->fre <= NO_FIT * r->spread)
        return 0;
    return err_set(
        e, place, 0,
        "the points do not fit their partners: %.3g mm (rms) are left of points that are %.3g mm (rms) from "
        "their middle, and their partners %.3g mm; expected the same places, in the same order and the units "
        "that were said",
        1e3 * r->fre, 1e3 * r->spread, 1e3 * other);
}

static void take_largest(registration *r, const double *left)
{
    r->largest = -1;
    for (int64_t i = 0; i < r->count; i++) {
        const double *d = left + 3 * i, length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        if (length > r->largest) {
            r->largest = length;
            r->worst = i;
        }
    }
}

static void take_extent(registration *r, const extent *t)
{
    memcpy(r->middle, t->middle, sizeof r->middle);
    memcpy(r->axis, t->axis, sizeof r->axis);
    r->spread = spread_of(t);
    for (int k = 0; k < 3; k++)
        r->apart[k] = t->square[(k + 1) % 3] + t->square[(k + 2) % 3];
}

static int fit_both(const fitting *f, const char *place, registration *r, double *left, err *e)
{
    if (check_far(f->from, f->count, "first", place, e) || check_far(f->to, f->count, "second", place, e))
        return -1;
    const extent from = extent_of(f->from, f->count), to = extent_of(f->to, f->count);
    pose mirror;
    if (check_line(&from, "first", place, e) || check_line(&to, "second", place, e))
        return -1;
    take_extent(r, &from);
    const double mirrored = fit(f, -1, &mirror, NULL);
    r->fre = fit(f, 1, &r->at, left);
    r->fle = r->fre * sqrt((double)f->count / (double)(f->count - 2));
    take_largest(r, left);
    return check_fit(r, mirrored, spread_of(&to), place, e);
}

int registration_fit(const double *from, const double *to, int64_t count, const char *place, registration *r,
                     double *left, err *e)
{
    *r = (registration){.count = count};
    if (count < 3)
        return err_set(e, place, 0, "%lld pair%s of points; expected three or more, not on a line", (long long)count,
                       count == 1 ? "" : "s");
    fitting f = {.from = from, .to = to, .count = count};
    f.source = mem_array(3 * count, sizeof *f.source, "points", e);
    f.way = mem_array(3 * count, sizeof *f.way, "points", e);
    f.all = mem_array(count, sizeof *f.all, "points", e);
    for (int64_t i = 0; f.all && i < count; i++)
        f.all[i] = (int32_t)i;
    const int failed = f.source && f.way && f.all ? fit_both(&f, place, r, left, e) : -1;
    free(f.source);
    free(f.way);
    free(f.all);
    return failed;
}

double registration_tre(const registration *r, const double at[3])
{
    double sum = 0, square = 0;
    for (int a = 0; a < 3; a++)
        square += (at[a] - r->middle[a]) * (at[a] - r->middle[a]);
    for (int k = 0; k < 3; k++) {
        double along = 0;
        for (int a = 0; a < 3; a++)
            along += (at[a] - r->middle[a]) * r->axis[k][a];
        sum += fmax(square - along * along, 0) / r->apart[k];
    }
    return r->fle * sqrt((1 + sum / 3) / (double)r->count);
}
