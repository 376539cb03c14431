#include "tled/loop/subspace.h"

#include "base/mem.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* A way of which this share alone is across the newer ones, by energy, adds nothing that rounding leaves known. */
static const double least = 1e-4;

int subspace_make(subspace *s, int64_t numbers, err *e)
{
    *s = (subspace){.numbers = numbers};
    for (int i = 0; i < SUBSPACE_WAYS; i++) {
        s->way[i] = mem_array(numbers, sizeof *s->way[i], "the corrections", e);
        s->force[i] = s->way[i] ? mem_array(numbers, sizeof *s->force[i], "the corrections", e) : NULL;
        if (!s->force[i])
            return -1;
    }
    return 0;
}

void subspace_free(subspace *s)
{
    for (int i = 0; i < SUBSPACE_WAYS; i++) {
        free(s->way[i]);
        free(s->force[i]);
    }
}

void subspace_push(subspace *s)
{
    double *way = s->way[SUBSPACE_WAYS - 1], *force = s->force[SUBSPACE_WAYS - 1];
    memmove(s->way + 1, s->way, (SUBSPACE_WAYS - 1) * sizeof *s->way);
    memmove(s->force + 1, s->force, (SUBSPACE_WAYS - 1) * sizeof *s->force);
    s->way[0] = way;
    s->force[0] = force;
    s->ways += s->ways < SUBSPACE_WAYS;
}

static double dot(const double *a, const double *b, int64_t count)
{
    double sum = 0;
    for (int64_t i = 0; i < count; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Cholesky, the newest first: what has no energy of its own is left out. a: the matrix, then its factor; b: what the
 * ways are pushed by, then how far each goes. */
static void solve(int count, double a[SUBSPACE_WAYS][SUBSPACE_WAYS], double b[SUBSPACE_WAYS])
{
    bool kept[SUBSPACE_WAYS];
    for (int i = 0; i < count; i++) {
        const double whole = a[i][i];
        for (int j = 0; j < i; j++) {
            for (int k = 0; k < j; k++)
                a[i][j] -= a[i][k] * a[j][k];
            a[i][j] = kept[j] ? a[i][j] / a[j][j] : 0;
            a[i][i] -= a[i][j] * a[i][j];
        }
        kept[i] = a[i][i] > least * whole;
        a[i][i] = kept[i] ? sqrt(a[i][i]) : 1;
        for (int j = 0; j < i; j++)
            b[i] -= a[i][j] * b[j];
        b[i] = kept[i] ? b[i] / a[i][i] : 0;
    }
    for (int i = count - 1; i >= 0; i--) {
        for (int j = i + 1; j < count; j++)
            b[i] -= kept[j] ? a[j][i] * b[j] : 0;
        b[i] = kept[i] ? b[i] / a[i][i] : 0;
    }
}

void subspace_least(const subspace *s, const double *residual, double *sum, double *left)
{
    double a[SUBSPACE_WAYS][SUBSPACE_WAYS] = {{0}}, b[SUBSPACE_WAYS] = {0};
    for (int i = 0; i < s->ways; i++) {
        b[i] = dot(s->way[i], residual, s->numbers);
        for (int j = 0; j <= i; j++)
            a[i][j] = (dot(s->way[i], s->force[j], s->numbers) + dot(s->way[j], s->force[i], s->numbers)) / 2;
    }
    solve(s->ways, a, b);
    for (int64_t n = 0; n < s->numbers; n++) {
        sum[n] = 0;
        left[n] = residual[n];
        for (int i = 0; i < s->ways; i++) {
            sum[n] += b[i] * s->way[i][n];
            left[n] -= b[i] * s->force[i][n];
        }
    }
}
