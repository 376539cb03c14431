#include "msds/cpu/mixing.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A difference counts where this share of it is not a combination of those taken before. */
static const double independent = 1e-10;

int mixing_make(mixing *m, int64_t count, int64_t led, err *e)
{
    m->count = count;
    m->led = led;
    m->x = mem_array(count, sizeof *m->x, "the solver", e);
    m->step = mem_array(count, sizeof *m->step, "the solver", e);
    m->dx = mem_array(count, MIXING_DEPTH * sizeof *m->dx, "the solver", e);
    m->dstep = mem_array(count, MIXING_DEPTH * sizeof *m->dstep, "the solver", e);
    return m->x && m->step && m->dx && m->dstep ? 0 : -1;
}

void mixing_free(mixing *m)
{
    free(m->x);
    free(m->step);
    free(m->dx);
    free(m->dstep);
    *m = (mixing){0};
}

void mixing_begin(mixing *m)
{
    m->held = m->next = 0;
    m->begun = false;
}

static double dot(const mixing *m, const double *a, const double *b)
{
    double sum[4] = {0};
    int64_t i = 0;
    for (; i + 4 <= m->led; i += 4)
        for (int l = 0; l < 4; l++)
            sum[l] += a[i + l] * b[i + l];
    for (; i < m->led; i++)
        sum[0] += a[i] * b[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

static void note_difference(mixing *m, const double *x, const double *step)
{
    double *dx = m->dx + m->next * m->count, *dstep = m->dstep + m->next * m->count;
    for (int64_t i = 0; i < m->count && m->begun; i++) {
        dx[i] = x[i] - m->x[i];
        dstep[i] = step[i] - m->step[i];
    }
    if (m->begun) {
        m->next = (m->next + 1) % MIXING_DEPTH;
        m->held += m->held < MIXING_DEPTH;
    }
    memcpy(m->x, x, (size_t)m->count * sizeof *x);
    memcpy(m->step, step, (size_t)m->count * sizeof *step);
    m->begun = true;
}

/* The products of the differences with each other, and with the step. */
static void multiply_all(const mixing *m, const double *step, double a[MIXING_DEPTH][MIXING_DEPTH], double *b)
{
    for (int i = 0; i < m->held; i++) {
        for (int j = 0; j <= i; j++)
            a[i][j] = a[j][i] = dot(m, m->dstep + i * m->count, m->dstep + j * m->count);
        b[i] = dot(m, m->dstep + i * m->count, step);
    }
}

/* Least squares by Cholesky's factor; what depends on others gets 0. */
static void solve(int n, double a[MIXING_DEPTH][MIXING_DEPTH], double *b)
{
    bool taken[MIXING_DEPTH] = {false};
    for (int j = 0; j < n; j++) {
        double pivot = a[j][j];
        for (int k = 0; k < j; k++)
            pivot -= taken[k] ? a[j][k] * a[j][k] : 0;
        taken[j] = pivot > independent * a[j][j];
        for (int i = j; i < n && taken[j]; i++) {
            double sum = i == j ? pivot : a[i][j];
            for (int k = 0; k < j && i > j; k++)
                sum -= taken[k] ? a[i][k] * a[j][k] : 0;
            a[i][j] = i == j ? sqrt(sum) : sum / a[j][j];
        }
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++)
            b[i] -= taken[k] && taken[i] ? a[i][k] * b[k] : 0;
        b[i] = taken[i] ? b[i] / a[i][i] : 0;
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++)
            b[i] -= taken[k] && taken[i] ? a[k][i] * b[k] : 0;
        b[i] = taken[i] ? b[i] / a[i][i] : 0;
    }
}

void mixing_next(mixing *m, double *x, const double *step)
{
    double a[MIXING_DEPTH][MIXING_DEPTH], share[MIXING_DEPTH];
    note_difference(m, x, step);
    multiply_all(m, step, a, share);
    solve(m->held, a, share);
    for (int64_t i = 0; i < m->count; i++) {
        double to = x[i] + step[i];
        for (int j = 0; j < m->held; j++)
            to -= share[j] * (m->dx[j * m->count + i] + m->dstep[j * m->count + i]);
        x[i] = to;
    }
}
