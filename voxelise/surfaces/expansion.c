#include "voxelise/surfaces/expansion.h"

#include <float.h>
#include <stdbool.h>
#include <string.h>

#if FLT_EVAL_METHOD != 0
#error "the error terms need doubles that are rounded to double, as SSE2 does"
#endif

/* The same as expansion_two_sum where |a| >= |b| or a = 0. */
static double two_sum_ordered(double a, double b, double *error)
{
    double sum = a + b;
    *error = b - (sum - a);
    return sum;
}

static int put(double component, double *h, int count)
{
    h[count] = component;
    return count + (component != 0);
}

int expansion_of_sum(double a, double b, double *h)
{
    double low, high = expansion_two_sum(a, b, &low);
    return put(high, h, put(low, h, 0));
}

int expansion_of_product(double a, double b, double *h)
{
    double low, high = expansion_two_product(a, b, &low);
    return put(high, h, put(low, h, 0));
}

/* Shewchuk's FAST-EXPANSION-SUM without its zeros: the components of both, merged by magnitude, go through one
 * running sum whose roundings are the result. */
int expansion_sum(int n, const double *e, int m, const double *f, double *h)
{
    int i = 0, j = 0, count = 0;
    double sum = 0, error;
    while (i < n || j < m) {
        bool take_e = j >= m || (i < n && fabs(e[i]) < fabs(f[j]));
        double next = take_e ? e[i++] : f[j++];
        sum = expansion_two_sum(sum, next, &error);
        count = put(error, h, count);
    }
    return put(sum, h, count);
}

int expansion_add(int n, const double *e, double b, double *h)
{
    return expansion_sum(n, e, b != 0, &b, h);
}

/* Shewchuk's SCALE-EXPANSION: h = e b, up to 2 n components. */
static int scale(int n, const double *e, double b, double *h)
{
    if (n == 0)
        return 0;
    double error, sum = expansion_two_product(e[0], b, &error);
    int count = put(error, h, 0);
    for (int i = 1; i < n; i++) {
        double low, high = expansion_two_product(e[i], b, &low);
        double middle = expansion_two_sum(sum, low, &error);
        count = put(error, h, count);
        sum = two_sum_ordered(high, middle, &error);
        count = put(error, h, count);
    }
    return put(sum, h, count);
}

int expansion_product(int n, const double *e, int m, const double *f, double *h)
{
    double part[EXPANSION_MOST], sum[EXPANSION_MOST];
    int count = 0;
    for (int i = 0; i < m; i++) {
        int parts = scale(n, e, f[i], part);
        memcpy(sum, h, (size_t)count * sizeof *sum);
        count = expansion_sum(count, sum, parts, part, h);
    }
    return count;
}

void expansion_negate(int n, double *e)
{
    for (int i = 0; i < n; i++)
        e[i] = -e[i];
}
