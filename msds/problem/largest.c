#include "msds/problem/largest.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

enum { STEPS = 150, CHECK = 10 /* steps between looks */ };

/* How sharp the eigenvalue is to be. */
static const double sharp = 1e-3;

typedef struct lanczos {
    const msds_problem *p;
    bool any;     /* springs as stiff in every direction as along themselves, and the probe's repulsion on all nodes */
    double *root; /* nodes: 1 / sqrt(m), 0 where fixed */
    double *v, *before, *next; /* nodes x 3 */
    double alpha[STEPS], beta[STEPS];
} lanczos;

/* next = M^-1/2 K M^-1/2 v. A spring that turns and stretches is never stiffer, in any direction, than k. */
static void apply(lanczos *z)
{
    const msds_problem *p = z->p;
    for (int64_t i = 0; i < 3 * p->nodes; i++)
        z->next[i] = z->any ? p->repulsion[i / 3] * z->root[i / 3] * z->root[i / 3] * z->v[i] : 0;
    for (int64_t i = 0; i < p->springs; i++) {
        const msds_spring *s = &p->spring[i];
        int64_t a = s->node[0], b = s->node[1];
        double d[3], w[3], along = 0;
        for (int c = 0; c < 3; c++) {
            d[c] = (p->position[3 * b + c] - p->position[3 * a + c]) / s->rest;
            w[c] = z->v[3 * b + c] * z->root[b] - z->v[3 * a + c] * z->root[a];
            along += d[c] * w[c];
        }
        for (int c = 0; c < 3; c++) {
            double f = s->stiffness * (z->any ? w[c] : along * d[c]);
            z->next[3 * a + c] -= f * z->root[a];
            z->next[3 * b + c] += f * z->root[b];
        }
    }
}

static double dot(const double *a, const double *b, int64_t count)
{
    double sum = 0;
    for (int64_t i = 0; i < count; i++)
        sum += a[i] * b[i];
    return sum;
}

/* How many eigenvalues of the first n rows of the tridiagonal matrix are below x; the last pivot in *last. */
static int below(const lanczos *z, int n, double x, double *last)
{
    int count = 0;
    double pivot = 1;
    for (int i = 0; i < n; i++) {
        double square = i ? z->beta[i - 1] * z->beta[i - 1] : 0;
        pivot = z->alpha[i] - x - (i ? square / pivot : 0);
        if (pivot == 0)
            pivot = -1e-300;
        count += pivot < 0;
    }
    *last = pivot;
    return count;
}

static double largest_ritz(const lanczos *z, int n)
{
    double low = 0, high = 0, last;
    for (int i = 0; i < n; i++) {
        const double before = i ? z->beta[i - 1] : 0;
        const double after = i + 1 < n ? z->beta[i] : 0;
        high = fmax(high, z->alpha[i] + before + after);
    }
    for (int i = 0; i < 60; i++) {
        double middle = .5 * (low + high);
        if (below(z, n, middle, &last) < n)
            low = middle;
        else
            high = middle;
    }
    return high;
}

/* One step; returns how far the next vector reaches out of those so far. */
static double step(lanczos *z, int i)
{
    const int64_t count = 3 * z->p->nodes;
    apply(z);
    z->alpha[i] = dot(z->v, z->next, count);
    double back = i ? z->beta[i - 1] : 0;
    for (int64_t k = 0; k < count; k++)
        z->next[k] -= z->alpha[i] * z->v[k] + back * z->before[k];
    z->beta[i] = sqrt(dot(z->next, z->next, count));
    double *spare = z->before;
    z->before = z->v;
    z->v = z->next;
    z->next = spare;
    for (int64_t k = 0; k < count && z->beta[i] > 0; k++)
        z->v[k] /= z->beta[i];
    return z->beta[i];
}

/* A start that favours no mode, and is the same each time. */
static void begin(lanczos *z)
{
    const int64_t count = 3 * z->p->nodes;
    uint64_t seed = 88172645463325252u;
    for (int64_t k = 0; k < count; k++) {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        z->v[k] = z->root[k / 3] > 0 ? (double)(seed >> 11) / 9007199254740992. - .5 : 0;
    }
    double length = sqrt(dot(z->v, z->v, count));
    for (int64_t k = 0; k < count && length > 0; k++)
        z->v[k] /= length;
}

static double iterate(lanczos *z)
{
    double found = 0;
    begin(z);
    for (int i = 0; i < STEPS; i++) {
        double out = step(z, i), before = found;
        bool over = out <= 1e-12 * z->alpha[0] || i == STEPS - 1;
        if (!over && (i + 1) % CHECK)
            continue;
        found = largest_ritz(z, i + 1);
        if (over || found - before <= .1 * sharp * found)
            break;
    }
    return found * (1 + sharp);
}

int largest_of(const msds_problem *p, largest *l, err *e)
{
    lanczos z = {.p = p};
    int result = -1;
    z.root = mem_array(p->nodes, sizeof *z.root, "the stable step", e);
    z.v = mem_array(p->nodes, 3 * sizeof *z.v, "the stable step", e);
    z.before = mem_array(p->nodes, 3 * sizeof *z.before, "the stable step", e);
    z.next = mem_array(p->nodes, 3 * sizeof *z.next, "the stable step", e);
    if (!z.root || !z.v || !z.before || !z.next)
        goto out;
    for (int64_t n = 0; n < p->nodes; n++)
        z.root[n] = p->fixed[n] ? 0 : 1 / sqrt(p->weight[n] * p->mass_factor);
    l->rest = iterate(&z);
    z.any = true;
    l->bound = fmax(l->rest, iterate(&z));
    result = 0;
out:
    free(z.root);
    free(z.v);
    free(z.before);
    free(z.next);
    return result;
}

/* dt = sqrt(c^2 + 4/l) - c, written so that it keeps its digits. */
double largest_step(double eigenvalue, double c)
{
    if (eigenvalue <= 0)
        return INFINITY;
    return 4 / eigenvalue / (sqrt(c * c + 4 / eigenvalue) + c);
}

double largest_factor(double eigenvalue, double c, double dt)
{
    return eigenvalue * (dt * dt + 2 * c * dt) / 4;
}
