#include "attach/shape/ring.h"

#include "place/principal.h"

#include <math.h>
#include <string.h>

enum { SECTORS = 12 };
static const double hole = .25; /* of the mean distance from the axis: nothing may be nearer */

/* A place about the axis. The angle is known by its cosine and sine alone, as square roots are the same everywhere. */
typedef struct polar {
    double radius, height, cosine, sine;
} polar;

static polar polar_of(const ring *r, const double *x)
{
    double local[3] = {0};
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++)
            local[k] += r->axis[k][a] * (x[a] - r->centre[a]);
    const double radius = sqrt(local[0] * local[0] + local[1] * local[1]);
    return (polar){radius, local[2], radius > 0 ? local[0] / radius : 1, radius > 0 ? local[1] / radius : 0};
}

/* The terms of the series there, and their slopes over the angle. */
static void terms_at(const polar *p, double *term, double *slope)
{
    double c = 1, s = 0;
    term[0] = 1, slope[0] = 0;
    for (int n = 1; 2 * n < RING_TERMS; n++) {
        const double next = c * p->cosine - s * p->sine;
        s = s * p->cosine + c * p->sine;
        c = next;
        term[2 * n - 1] = c, slope[2 * n - 1] = -n * s;
        term[2 * n] = s, slope[2 * n] = n * c;
    }
}

/* Returns the number of the twelfth of the circle that a place is in. */
static int sector_of(const polar *p)
{
    const double x = fabs(p->cosine), y = fabs(p->sine);
    const int quarter = (p->cosine < 0) + 2 * (p->sine < 0);
    if (2 * y < 1)
        return 3 * quarter;
    return 3 * quarter + (2 * x < 1 ? 2 : 1);
}

/* The mean and the principal axes, by weight. False where nothing weighs anything. */
static bool find_frame(ring *r, const ring_points *p, double v[3][3])
{
    double all = 0, c[3][3] = {{0}};
    memset(r->centre, 0, sizeof r->centre);
    for (int64_t i = 0; i < p->count; i++) {
        all += p->weight[i];
        for (int a = 0; a < 3; a++)
            r->centre[a] += p->weight[i] * p->place[3 * i + a];
    }
    for (int a = 0; a < 3; a++)
        r->centre[a] /= all;
    for (int64_t i = 0; i < p->count; i++)
        for (int k = 0; k < 9; k++)
            c[k / 3][k % 3] += p->weight[i] / all * (p->place[3 * i + k / 3] - r->centre[k / 3]) *
                               (p->place[3 * i + k % 3] - r->centre[k % 3]);
    principal_axes(c, v);
    return all > 0;
}

/* The plane across column n of v, turned right-handed, the largest component of the axis positive. */
static void turn_to(ring *r, double v[3][3], int n)
{
    const int column[3] = {(n + 1) % 3, (n + 2) % 3, n};
    int largest = 0;
    double across[3];
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++)
            r->axis[k][a] = v[a][column[k]];
    for (int a = 1; a < 3; a++)
        if (fabs(r->axis[2][a]) > fabs(r->axis[2][largest]) + 1e-9)
            largest = a;
    for (int a = 0; r->axis[2][largest] < 0 && a < 3; a++)
        r->axis[2][a] = -r->axis[2][a];
    for (int a = 0; a < 3; a++)
        across[a] =
            r->axis[2][(a + 1) % 3] * r->axis[0][(a + 2) % 3] - r->axis[2][(a + 2) % 3] * r->axis[0][(a + 1) % 3];
    memcpy(r->axis[1], across, sizeof across);
}

/* Whether the points leave a hole about the axis, and lie all the way round. */
static bool goes_round(const ring *r, const ring_points *p)
{
    double least = INFINITY, sum = 0, all = 0;
    bool seen[SECTORS] = {false};
    for (int64_t i = 0; i < p->count; i++) {
        if (!(p->weight[i] > 0))
            continue;
        const polar at = polar_of(r, p->place + 3 * i);
        seen[sector_of(&at)] = true;
        least = fmin(least, at.radius);
        sum += p->weight[i] * at.radius;
        all += p->weight[i];
    }
    for (int i = 0; i < SECTORS; i++)
        if (!seen[i])
            return false;
    return least > hole * sum / all;
}

/* Solves a x = y by Cholesky's factors; x takes y's place. a is symmetric and made definite by a small part of its
 * diagonal, as a term may hardly be seen in few points. */
static void solve(double a[RING_TERMS][RING_TERMS], double y[2][RING_TERMS])
{
    for (int i = 0; i < RING_TERMS; i++)
        a[i][i] *= 1 + 1e-9;
    for (int i = 0; i < RING_TERMS; i++)
        for (int j = 0; j <= i; j++) {
            double sum = a[i][j];
            for (int k = 0; k < j; k++)
                sum -= a[i][k] * a[j][k];
            a[i][j] = i == j ? sqrt(sum) : sum / a[j][j];
        }
    for (int which = 0; which < 2; which++) {
        for (int i = 0; i < RING_TERMS; i++) {
            for (int k = 0; k < i; k++)
                y[which][i] -= a[i][k] * y[which][k];
            y[which][i] /= a[i][i];
        }
        for (int i = RING_TERMS - 1; i >= 0; i--) {
            for (int k = i + 1; k < RING_TERMS; k++)
                y[which][i] -= a[k][i] * y[which][k];
            y[which][i] /= a[i][i];
        }
    }
}

/* Radius and height over the angle, by least squares. */
static void fit_line(ring *r, const ring_points *p)
{
    double a[RING_TERMS][RING_TERMS] = {{0}}, y[2][RING_TERMS] = {{0}}, term[RING_TERMS], slope[RING_TERMS];
    for (int64_t i = 0; i < p->count; i++) {
        const polar at = polar_of(r, p->place + 3 * i);
        terms_at(&at, term, slope);
        for (int m = 0; m < RING_TERMS; m++) {
            for (int n = 0; n < RING_TERMS; n++)
                a[m][n] += p->weight[i] * term[m] * term[n];
            y[0][m] += p->weight[i] * term[m] * at.radius;
            y[1][m] += p->weight[i] * term[m] * at.height;
        }
    }
    solve(a, y);
    memcpy(r->radius, y[0], sizeof r->radius);
    memcpy(r->height, y[1], sizeof r->height);
}

bool ring_find(ring *r, const ring_points *p)
{
    double v[3][3];
    if (p->count < SECTORS || !find_frame(r, p, v))
        return false;
    for (int n = 0; n < 3; n++) {
        turn_to(r, v, n);
        if (goes_round(r, p)) {
            fit_line(r, p);
            return true;
        }
    }
    return false;
}

void ring_along(const ring *r, const double *x, double *along)
{
    const polar at = polar_of(r, x);
    double term[RING_TERMS], slope[RING_TERMS], radius = 0, out = 0, up = 0, length = 0;
    terms_at(&at, term, slope);
    for (int n = 0; n < RING_TERMS; n++) {
        radius += r->radius[n] * term[n];
        out += r->radius[n] * slope[n];
        up += r->height[n] * slope[n];
    }
    for (int a = 0; a < 3; a++) {
        along[a] = radius * (at.cosine * r->axis[1][a] - at.sine * r->axis[0][a]) +
                   out * (at.cosine * r->axis[0][a] + at.sine * r->axis[1][a]) + up * r->axis[2][a];
        length += along[a] * along[a];
    }
    for (int a = 0; a < 3; a++)
        along[a] /= sqrt(length);
}
