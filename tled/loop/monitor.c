#include "tled/loop/monitor.h"

#include "tled/contact/sliding.h"
#include "tled/problem/collider.h"

#include "base/mem.h"
#include "mesh/element_place.h"
#include "tled/problem/conforming_step.h"
#include "tled/problem/cut.h"
#include "tled/problem/deformed.h"
#include "tled/problem/film_strain.h"
#include "tled/problem/loads.h"
#include "tled/problem/muscle_fibre.h"
#include "tled/problem/step.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 256 }; /* elements, or nodes */

struct monitor_part { /* of one chunk */
    tled_sums sum;
    bool inverted;
};

static void take_frequency(struct monitor_part *part, int64_t i, double square)
{
    part->sum.frequency = square;
    part->sum.frequency_element = i;
}

static void add_conforming(const monitor *w, int64_t i, const deformed *d, struct monitor_part *part)
{
    const tled_problem *p = w->p;
    const stability_twists t = conforming_twists(p, i, d->h, &d->modes, d->stiffening);
    step_matrix a;
    conforming_matrix(p, i, &d->law, d->h, muscle_fibre_of(p, p->fibre, i, p->element_volume[i], 1, w->curves), &a);
    if (!step_below(&a, conforming_room(p, i, t, part->sum.frequency)))
        take_frequency(part, i, w->raise * conforming_square(p, i, t, step_largest(&a)));
}

/* Of an element that is cut; t: as of a whole one. */
static void add_cut(const monitor *w, int64_t i, const deformed *d, const float *moments, const step_fibres *fibres,
                    stability_twists t, struct monitor_part *part)
{
    step_matrix a;
    t = cut_twists(w->p, i, moments, t);
    step_matrix_of(w->p, &d->law, d->h, fibres, &a);
    cut_matrix(w->p, i, moments, &a);
    if (!step_below(&a, stability_room(t, part->sum.frequency)))
        take_frequency(part, i, w->raise * stability_square(t, step_largest(&a)));
}

/* Of a laminate. */
static void add_border(const monitor *w, int64_t i, const deformed *d, double slope, const step_fibres *fibres,
                       struct monitor_part *part)
{
    const stability_twists t =
        stability_twists_of(w->p->control.kind, d->law.twists, slope, d->h, &d->laminate.modes, d->stiffening);
    const double square =
        border_square(w->p, i, &d->parts, &d->laminate, d->law.c, d->law.density, fibres, t, part->sum.frequency);
    if (!(square <= part->sum.frequency))
        take_frequency(part, i, w->raise * square);
}

/* Bounds tell enough of most elements: that they do not reach past the largest frequency of their chunk, or how far.
 * Where they are too wide, or leave open whether any reaches past the one at rest, the matrix tells, and the frequency
 * is raised to 1 % above the element's: so few need more than one test. */
static void add_step(const monitor *w, int64_t i, const deformed *d, element_shape box, struct monitor_part *part)
{
    const tled_problem *p = w->p;
    const double slope = fmax(box.slope.x, fmax(box.slope.y, box.slope.z));
    const stability_twists t =
        stability_twists_of(p->control.kind, d->law.twists, slope, d->h, &d->modes, d->stiffening);
    const step_fibres fibres = step_fibres_of(p, i, w->curves);
    const float *cut = tled_cut(p, i);
    if (d->border) {
        add_border(w, i, d, slope, &fibres, part);
        return;
    }
    if (cut) {
        add_cut(w, i, d, cut, &fibres, t, part);
        return;
    }
    const stability_range range = stability_range_with(step_range_of(p, &d->law, d->h, &fibres), t);
    step_matrix a;
    if (range.high <= part->sum.frequency)
        return;
    const bool past_rest = part->sum.frequency_element >= 0 || range.low > part->sum.frequency;
    if (past_rest && range.high <= w->raise * range.low) {
        take_frequency(part, i, range.high);
        return;
    }
    step_matrix_of(p, &d->law, d->h, &fibres, &a);
    if (!step_below(&a, stability_room(t, part->sum.frequency)))
        take_frequency(part, i, w->raise * stability_square(t, step_largest(&a)));
}

static void add_element(const monitor *w, int64_t i, element_shape box, struct monitor_part *part)
{
    const deformed d = deformed_of(w->p, i, box, w->displacement);
    const double volume = 1 + d.dilation;
    if (!(volume > 0) || !isfinite(d.energy) || !isfinite(d.hourglass)) {
        part->inverted = part->sum.broken < 0 ? volume <= 0 : part->inverted;
        part->sum.broken = part->sum.broken < 0 ? i : part->sum.broken;
        return;
    }
    part->sum.strain += tled_fraction(w->p, i) * (d.energy * d.rest + d.hourglass);
    if (w->p->conforming)
        add_conforming(w, i, &d, part);
    else
        add_step(w, i, &d, box, part);
}

static void element_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    monitor *w = context;
    struct monitor_part part = {.sum = {.frequency = w->question.rest, .frequency_element = -1, .broken = -1}};
    element_shape shape = element_box(w->p->side[0], w->p->side[1], w->p->side[2]);
    for (int64_t i = from; i < to; i++)
        add_element(w, i, shape, &part);
    w->part[chunk] = part;
}

/* What is left of a force once bone that the node slides on has borne its part. */
static void bear(const monitor *w, int64_t n, double net[3])
{
    const sliding_load load = sliding_load_at(w->p, w->p->sliding->row[n], w->curves, w->displacement, net);
    for (int a = 0; a < 3; a++)
        net[a] += load.normal[a] + load.stuck[a];
}

static void add_node(const monitor *w, int64_t n, tled_sums *sum)
{
    double net[3], square = 0, mass = w->p->mass[n];
    tled_external(w->p, w->curves, w->displacement + 3 * n, n, net);
    for (int a = 0; a < 3; a++)
        net[a] -= w->internal[3 * n + a];
    if (w->p->sliding && w->p->sliding->row[n] >= 0)
        bear(w, n, net);
    for (int a = 0; a < 3; a++) {
        int64_t i = 3 * n + a;
        double gap = net[a], drive = mass * w->velocity[i] * w->velocity[i];
        bool is_free = w->p->hold[i] == HOLD_FREE;
        sum->acceleration += is_free ? gap * gap / mass : 0;
        sum->speed += is_free ? drive : 0;
        sum->kinetic += drive / 2;
        square += w->displacement[i] * w->displacement[i];
        if (w->saved_internal && is_free) {
            double du = w->displacement[i] - w->saved_displacement[i];
            sum->stiffness += du * (w->internal[i] - w->saved_internal[i]);
            sum->inertia += mass * du * du;
        }
    }
    sum->mass += mass;
    sum->moved += mass * square;
    sum->largest = fmax(sum->largest, square);
}

static void node_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    monitor *w = context;
    struct monitor_part part = {0};
    for (int64_t n = from; n < to; n++)
        add_node(w, n, &part.sum);
    w->part[chunk] = part;
}

static void sum_elements(monitor *w, tled_sums *sum)
{
    int64_t chunks = pool_chunks(w->p->elements, CHUNK);
    sum->frequency_element = sum->broken = -1;
    for (int64_t c = 0; c < chunks; c++) {
        const struct monitor_part *part = &w->part[c];
        sum->strain += part->sum.strain;
        if (sum->broken < 0) {
            sum->broken = part->sum.broken;
            w->reading.inverted = part->inverted;
        }
        if (part->sum.frequency_element >= 0 && part->sum.frequency > sum->frequency) {
            sum->frequency = part->sum.frequency;
            sum->frequency_element = part->sum.frequency_element;
        }
    }
}

static void sum_nodes(const monitor *w, tled_sums *sum)
{
    int64_t chunks = pool_chunks(w->p->nodes, CHUNK);
    for (int64_t c = 0; c < chunks; c++) {
        const tled_sums *part = &w->part[c].sum;
        sum->kinetic += part->kinetic;
        sum->acceleration += part->acceleration;
        sum->speed += part->speed;
        sum->moved += part->moved;
        sum->mass += part->mass;
        sum->stiffness += part->stiffness;
        sum->inertia += part->inertia;
        sum->largest = fmax(sum->largest, part->largest);
    }
}

static int need(double **array, int64_t nodes, err *e)
{
    if (!*array)
        *array = mem_array(nodes, 3 * sizeof **array, "the monitor", e);
    return *array ? 0 : -1;
}

static void read_films(monitor *w, tled_sums *sum)
{
    const double square = sum->frequency_element < 0 ? w->p->films->elements_square : sum->frequency;
    sum->strain += films_energies(w->p, w->displacement, w->curves);
    w->film_square = sum->broken < 0 ? films_square(&w->films, w->threads, w->displacement, w->curves, square) : 0;
}

/* On this machine's threads. */
static int read_here(monitor *w, const tled_executor *b, tled_state *state, tled_sums *sum, err *e)
{
    const tled_problem *p = w->p;
    if (need(&w->displacement, p->nodes, e) || need(&w->velocity, p->nodes, e) || need(&w->internal, p->nodes, e) ||
        b->get(state, TLED_DISPLACEMENT, w->displacement, e) || b->get(state, TLED_VELOCITY, w->velocity, e) ||
        b->get(state, TLED_INTERNAL, w->internal, e))
        return -1;
    *sum = (tled_sums){0};
    tled_curves(p, w->question.time, w->curves);
    if (p->followers) {
        followers_move(&w->followers, w->displacement);
        w->load_square = followers_square(&w->followers, w->threads, w->curves);
    }
    pool_run(w->threads, p->elements, CHUNK, element_work, w);
    sum_elements(w, sum);
    if (p->films)
        read_films(w, sum);
    pool_run(w->threads, p->nodes, CHUNK, node_work, w);
    sum_nodes(w, sum);
    return 0;
}

static void take_sums(monitor *w, const tled_sums *sum)
{
    monitor_reading *s = &w->reading;
    s->time = w->question.time;
    s->kinetic = sum->kinetic;
    s->strain = sum->strain;
    s->acceleration = sqrt(sum->acceleration / sum->mass);
    s->speed = sqrt(sum->speed / sum->mass);
    s->moved = sqrt(sum->moved / sum->mass);
    s->moved_most = fmax(s->moved_most, s->moved);
    s->stiffness = sum->stiffness;
    s->inertia = sum->inertia;
    s->largest = sqrt(sum->largest);
    s->broken = sum->broken;
    s->stable_element = sum->frequency_element;
    s->stable = sum->frequency_element < 0 ? w->rest_step : 2 / sqrt(sum->frequency);
    if (w->film_square > 4 / (s->stable * s->stable))
        s->stable = 2 / sqrt(w->film_square);
    s->stable = followers_step(w->load_square + w->spring_square, collider_step(w->p, s->stable));
}

int monitor_read(monitor *w, const tled_executor *b, tled_state *state, double time, err *e)
{
    tled_sums sum;
    /* A rounding above the frequency at rest, so that no matrix at rest passes it.
     * (Bounds may, of elements with unlike sides.) */
    w->question = (tled_question){time, 4 / (w->rest_step * w->rest_step) * (1 + 1e-9), w->raise, w->differences};
    if (b->monitor ? b->monitor(state, &w->question, &sum, e) : read_here(w, b, state, &sum, e))
        return -1;
    tled_curves(w->p, time, w->curves);
    w->spring_square = loads_square(w->p, w->curves);
    take_sums(w, &sum);
    return 0;
}

int monitor_locate(monitor *w, const tled_executor *b, tled_state *state, err *e)
{
    tled_sums sum;
    if (!b->monitor)
        return 0;
    if (read_here(w, b, state, &sum, e))
        return -1;
    take_sums(w, &sum);
    return 0;
}

int monitor_save(monitor *w, const tled_executor *b, tled_state *state, err *e)
{
    size_t size = 3 * (size_t)w->p->nodes * sizeof(double);
    if (w->differences && !b->monitor) {
        if (need(&w->saved_displacement, w->p->nodes, e) || need(&w->saved_internal, w->p->nodes, e))
            return -1;
        memcpy(w->saved_displacement, w->displacement, size);
        memcpy(w->saved_internal, w->internal, size);
    }
    return b->save(state, e);
}

void monitor_words(const model *m, const monitor_reading *s, char *to, size_t size)
{
    const int64_t element = s->broken >= 0 ? s->broken : s->stable_element;
    char where[ELEMENT_PLACE];
    if (element < 0) {
        snprintf(to, size, "the stable step is %.4g ms", 1e3 * s->stable);
        return;
    }
    element_place_text(m, element, where);
    if (s->broken >= 0)
        snprintf(to, size, "%s was inverted or not finite after longer steps", where);
    else
        snprintf(to, size, "%s has a stable step of %.4g ms", where, 1e3 * s->stable);
}

/* What of the script has room of its own. */
static int allocate_script(monitor *w, err *e)
{
    w->curves = mem_array(w->p->script->curves, 3 * sizeof *w->curves, "the monitor", e);
    return w->curves ? followers_room(&w->followers, w->p->followers, e) : -1;
}

int monitor_reload(monitor *w, err *e)
{
    free(w->curves);
    followers_room_free(&w->followers);
    w->load_square = 0;
    return allocate_script(w, e);
}

monitor *monitor_create(const tled_problem *p, pool *threads, err *e)
{
    int64_t most = p->elements > p->nodes ? p->elements : p->nodes;
    monitor *w = mem_array(1, sizeof *w, "the monitor", e);
    if (!w)
        return NULL;
    w->p = p;
    w->threads = threads;
    w->rest_step = step_at_rest(p, NULL);
    w->raise = 1.01;
    w->part = mem_array(pool_chunks(most, CHUNK), sizeof *w->part, "the monitor", e);
    if (!w->part || allocate_script(w, e) || films_room(&w->films, p, e)) {
        monitor_destroy(w);
        return NULL;
    }
    return w;
}

void monitor_destroy(monitor *w)
{
    if (!w)
        return;
    free(w->displacement);
    free(w->velocity);
    free(w->internal);
    free(w->saved_displacement);
    free(w->saved_internal);
    free(w->curves);
    free(w->part);
    followers_room_free(&w->followers);
    films_room_free(&w->films);
    free(w);
}
