#include "tled/loop/multigrid.h"
#include "tled/loop/residual.h"
#include "tled/loop/run_parts.h"
#include "tled/loop/subspace.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    POOR = 3
}; /* corrections in a row that bring nothing, before a run gives them up: a turn of slender tissue may */

struct run_corrector {
    bool over;            /* no more corrections */
    int made, count;      /* so far: in this precision, and in all */
    int poor;             /* since the last one that brought it closer */
    double before;        /* m/s2: monitor_reading's acceleration when the last one was made; the share of the way that
                           * is left to go rises also when a slower motion comes to be known */
    double least;         /* m/s2: of all so far */
    double *displacement; /* nodes x 3, m: at this check */
    double *residual;     /* nodes x 3, N: what is out of balance there */
    double *last[2];      /* and both at the check before, where there was a correction */
    double *correction;   /* nodes x 3, m */
    double *left, *next;  /* nodes x 3: N, what a recombination leaves out of balance; m */
    subspace ways;
};

int run_corrector_make(run *n)
{
    const int64_t nodes = n->r->p->nodes;
    run_corrector *c = n->corrector = mem_array(1, sizeof *c, "the corrections", n->e);
    if (!c)
        return -1;
    double **const array[] = {&c->displacement, &c->residual, &c->last[0], &c->last[1],
                              &c->correction,   &c->left,     &c->next};
    for (size_t i = 0; i < sizeof array / sizeof *array; i++) {
        *array[i] = mem_array(nodes, 3 * sizeof **array[i], "the corrections", n->e);
        if (!*array[i])
            return -1;
    }
    c->before = c->least = INFINITY;
    return subspace_make(&c->ways, 3 * nodes, n->e);
}

void run_corrector_free(run_corrector *c)
{
    if (!c)
        return;
    free(c->displacement);
    free(c->residual);
    free(c->last[0]);
    free(c->last[1]);
    free(c->correction);
    free(c->left);
    free(c->next);
    subspace_free(&c->ways);
    free(c);
}

bool run_corrects(const run *n)
{
    return n->corrector && !n->corrector->over;
}

/* The run goes on at rest from where it was, moved by the correction. */
static int move(run *n)
{
    const run_corrector *c = n->corrector;
    field_values values = {{0}};
    int failed = fields_allocate(&n->r->p->fields, FIELDS_ALL, &values, "the state to go on from", n->e);
    for (int64_t i = 0; i < 3 * n->r->p->nodes && !failed; i++)
        values.of[TLED_DISPLACEMENT][i] = c->displacement[i] + c->correction[i];
    if (!failed)
        failed = n->device->put ? n->device->put(n->state, &values, run_now(n), n->e)
                                : run_go_on_from(n, n->device, &values);
    fields_free(&values);
    return failed;
}

/* The way since the check before, with its correction, is one of those that are recombined. It has the slowest motion
 * too, which steps between corrections hardly have: what Rayleigh's quotient is of. */
static void add_way(run *n)
{
    run_corrector *c = n->corrector;
    monitor_reading *s = &n->monitor->reading;
    const int64_t numbers = 3 * n->r->p->nodes;
    subspace_push(&c->ways);
    s->stiffness = s->inertia = 0;
    for (int64_t i = 0; i < numbers; i++) {
        const double way = c->displacement[i] - c->last[0][i], force = c->last[1][i] - c->residual[i];
        const bool is_free = n->r->p->hold[i] == HOLD_FREE;
        c->ways.way[0][i] = way;
        c->ways.force[0][i] = force;
        s->stiffness += way * force;
        s->inertia += is_free ? n->r->p->mass[i / 3] * way * way : 0;
    }
}

int run_read_way(run *n)
{
    run_corrector *c = n->corrector;
    if (residual_read(n->r->p, n->device, n->state, run_now(n), c->displacement, c->residual, n->e))
        return -1;
    if (c->made)
        add_way(n);
    return 0;
}

/* What single precision leaves hides what is to be corrected: on in double, from new ways. */
static int begin_anew(run *n)
{
    run_corrector *c = n->corrector;
    c->made = c->poor = c->ways.ways = 0;
    c->before = c->least = INFINITY;
    return run_refine(n);
}

/* No more of them: the run comes to rest as it would without. */
static int give_up(run *n)
{
    run_corrector *c = n->corrector;
    if (n->r->finer && n->course.finer == 0)
        return begin_anew(n);
    c->over = true;
    n->monitor->differences = true;
    n->course.relax.states = 1; /* what was saved is not what differences are to be of */
    if (!(n->monitor->reading.acceleration > c->before))
        return 0;
    for (int64_t i = 0; i < 3 * n->r->p->nodes; i++)
        c->correction[i] = c->last[0][i] - c->displacement[i];
    return move(n) || run_monitor(n) ? -1 : 0;
}

/* The recombination of the ways so far, and the correction of what that leaves out of balance. */
static int find_correction(run *n)
{
    err failed = {0};
    run_corrector *c = n->corrector;
    const int64_t numbers = 3 * n->r->p->nodes;
    subspace_least(&c->ways, c->residual, c->correction, c->left);
    if (multigrid_correct(n->r->coarser, c->left, n->course.remaining, c->next, &failed))
        return 1;
    for (int64_t i = 0; i < numbers; i++)
        c->correction[i] += c->next[i];
    for (int64_t i = 0; i < numbers; i++)
        c->next[i] = c->displacement[i] + c->correction[i];
    return multigrid_is_upright(n->r->coarser, c->next) ? 0 : 1;
}

int run_correct(run *n)
{
    run_corrector *c = n->corrector;
    const size_t size = 3 * (size_t)n->r->p->nodes * sizeof(double);
    const double left = n->monitor->reading.acceleration;
    c->poor = left > .9 * c->least ? c->poor + 1 : 0;
    c->least = fmin(c->least, left);
    if (c->poor > POOR || left > 10 * c->least || find_correction(n))
        return give_up(n);
    memcpy(c->last[0], c->displacement, size);
    memcpy(c->last[1], c->residual, size);
    c->before = left;
    c->made++;
    c->count++;
    return move(n);
}

int run_corrections(const run *n)
{
    return n->corrector ? n->corrector->count : 0;
}
