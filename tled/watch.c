#include "tled/watch.h"

#include "base/mem.h"
#include "tled/step.h"

#include <math.h>
#include <stdlib.h>

enum { CHUNK = 256 }; /* elements, or nodes */

struct watch_part {                          /* of one chunk */
    double kinetic, strain;                  /* J */
    double acceleration, speed, moved, mass; /* sums over mass: kg m2/s4, kg m2/s2, kg m2, kg */
    double largest;                          /* m2 */
    double frequency;                        /* 1/s2: the largest seen, raised by 1 % */
    int64_t frequency_element, broken;
    bool inverted;
};

static element_corners corners_of(const watch *w, int64_t element, int a)
{
    element_corners c;
    for (int i = 0; i < 8; i++)
        c.at[i] = w->displacement[3 * (int64_t)w->p->element_node[8 * element + i] + a];
    return c;
}

static element_fibre fibre_of(const watch *w, int64_t i)
{
    const tled_problem *p = w->p;
    element_fibre fibre = {0};
    if (!p->fibre)
        return fibre;
    fibre.along = (element_vector){p->fibre[3 * i], p->fibre[3 * i + 1], p->fibre[3 * i + 2]};
    fibre.tension = tled_tension(p, p->element_volume[i], w->curves);
    return fibre;
}

/* Where an element's matrix reaches past the largest frequency of its chunk, that is raised to 1 % above the element's: so few
 * elements need more than one test. */
static void look_at_step(const watch *w, const tled_volume *v, int64_t i, element_tensor h, element_fibre fibre,
                         struct watch_part *part)
{
    step_matrix a;
    step_matrix_of(w->p, v, h, fibre, &a);
    if (step_below(&a, part->frequency))
        return;
    part->frequency = w->raise * step_largest(&a);
    part->frequency_element = i;
}

static void look_at_element(const watch *w, int64_t i, element_shape shape, struct watch_part *part)
{
    const tled_problem *p = w->p;
    const tled_volume *v = &p->volume[p->element_volume[i]];
    element_modes x = element_modes_of(corners_of(w, i, 0)), y = element_modes_of(corners_of(w, i, 1));
    element_modes z = element_modes_of(corners_of(w, i, 2));
    element_tensor h = element_gradient(x, y, z, shape.slope);
    double volume = 1 + element_dilation(h), energy = element_energy(h, v->mu, v->bulk);
    double hourglass = element_hourglass_energy(x, v->hourglass) + element_hourglass_energy(y, v->hourglass) +
                       element_hourglass_energy(z, v->hourglass);
    if (!(volume > 0) || !isfinite(energy) || !isfinite(hourglass)) {
        part->inverted = part->broken < 0 ? volume <= 0 : part->inverted;
        part->broken = part->broken < 0 ? i : part->broken;
        return;
    }
    part->strain += energy * p->side[0] * p->side[1] * p->side[2] + hourglass;
    look_at_step(w, v, i, h, fibre_of(w, i), part);
}

static void element_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    watch *w = context;
    /* A rounding above the frequency at rest, so that elements at rest do not pass it. */
    const double rest = 4 / (w->rest_step * w->rest_step) * (1 + 1e-9);
    struct watch_part part = {.frequency = rest, .frequency_element = -1, .broken = -1};
    element_shape shape = element_box(w->p->side[0], w->p->side[1], w->p->side[2]);
    for (int64_t i = from; i < to; i++)
        look_at_element(w, i, shape, &part);
    w->part[chunk] = part;
}

static void look_at_node(const watch *w, int64_t n, struct watch_part *part)
{
    double outside[3], square = 0, mass = w->p->mass[n];
    tled_external(w->p, w->curves, n, outside);
    for (int a = 0; a < 3; a++) {
        int64_t i = 3 * n + a;
        double gap = outside[a] - w->internal[i], drive = mass * w->velocity[i] * w->velocity[i];
        bool is_free = w->p->hold[i] == HOLD_FREE;
        part->acceleration += is_free ? gap * gap / mass : 0;
        part->speed += is_free ? drive : 0;
        part->kinetic += drive / 2;
        square += w->displacement[i] * w->displacement[i];
    }
    part->mass += mass;
    part->moved += mass * square;
    part->largest = fmax(part->largest, square);
}

static void node_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    watch *w = context;
    struct watch_part part = {0};
    for (int64_t n = from; n < to; n++)
        look_at_node(w, n, &part);
    w->part[chunk] = part;
}

static void sum_elements(watch *w, int64_t chunks, struct watch_part *sum)
{
    watch_sight *s = &w->sight;
    double frequency = 0;
    s->broken = s->stable_element = -1;
    s->stable = w->rest_step;
    for (int64_t c = 0; c < chunks; c++) {
        const struct watch_part *part = &w->part[c];
        sum->strain += part->strain;
        if (s->broken < 0) {
            s->broken = part->broken;
            s->inverted = part->inverted;
        }
        if (part->frequency_element >= 0 && part->frequency > frequency) {
            frequency = part->frequency;
            s->stable_element = part->frequency_element;
            s->stable = 2 / sqrt(frequency);
        }
    }
}

static void sum_nodes(const watch *w, int64_t chunks, struct watch_part *sum)
{
    for (int64_t c = 0; c < chunks; c++) {
        const struct watch_part *part = &w->part[c];
        sum->kinetic += part->kinetic;
        sum->acceleration += part->acceleration;
        sum->speed += part->speed;
        sum->moved += part->moved;
        sum->mass += part->mass;
        sum->largest = fmax(sum->largest, part->largest);
    }
}

int watch_look(watch *w, const backend *b, void *state, double time, err *e)
{
    const tled_problem *p = w->p;
    struct watch_part sum = {0};
    if (b->get(state, TLED_DISPLACEMENT, w->displacement, e) || b->get(state, TLED_VELOCITY, w->velocity, e) ||
        b->get(state, TLED_INTERNAL, w->internal, e))
        return -1;
    tled_curves(p, time, w->curves);
    pool_run(w->threads, p->elements, CHUNK, element_work, w);
    sum_elements(w, pool_chunks(p->elements, CHUNK), &sum);
    pool_run(w->threads, p->nodes, CHUNK, node_work, w);
    sum_nodes(w, pool_chunks(p->nodes, CHUNK), &sum);
    w->sight.time = time;
    w->sight.kinetic = sum.kinetic;
    w->sight.strain = sum.strain;
    w->sight.acceleration = sqrt(sum.acceleration / sum.mass);
    w->sight.speed = sqrt(sum.speed / sum.mass);
    w->sight.moved = sqrt(sum.moved / sum.mass);
    w->sight.moved_most = fmax(w->sight.moved_most, w->sight.moved);
    w->sight.largest = sqrt(sum.largest);
    return 0;
}

watch *watch_create(const tled_problem *p, pool *threads, err *e)
{
    int64_t most = p->elements > p->nodes ? p->elements : p->nodes;
    watch *w = mem_array(1, sizeof *w, "the watch", e);
    if (!w)
        return NULL;
    w->p = p;
    w->threads = threads;
    w->rest_step = step_at_rest(p, NULL);
    w->raise = 1.01;
    w->displacement = mem_array(p->nodes, 3 * sizeof *w->displacement, "the watch", e);
    w->velocity = mem_array(p->nodes, 3 * sizeof *w->velocity, "the watch", e);
    w->internal = mem_array(p->nodes, 3 * sizeof *w->internal, "the watch", e);
    w->curves = mem_array(p->script->curves, 3 * sizeof *w->curves, "the watch", e);
    w->part = mem_array(pool_chunks(most, CHUNK), sizeof *w->part, "the watch", e);
    if (!w->displacement || !w->velocity || !w->internal || !w->curves || !w->part) {
        watch_destroy(w);
        return NULL;
    }
    return w;
}

void watch_destroy(watch *w)
{
    if (!w)
        return;
    free(w->displacement);
    free(w->velocity);
    free(w->internal);
    free(w->curves);
    free(w->part);
    free(w);
}
