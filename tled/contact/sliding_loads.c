#include "tled/contact/sliding_loads.h"

#include "base/mem.h"
#include "place/pose_fit.h"
#include "tled/contact/self_contact.h"

#include <stdlib.h>
#include <string.h>

enum { CHUNK = 256 }; /* nodes */

typedef struct bearing {
    const tled_problem *p;
    const bodies_state *now;
    double *force; /* nodes that slide x 3, N: on the bone */
} bearing;

/* The body that node row i slides on, or -1. */
static int32_t body_of(const sliding *s, int64_t i)
{
    return s->body ? s->body[s->of[i]] : -1;
}

static void place_of(const bearing *b, int64_t i, double x[3])
{
    const int64_t n = 3 * (int64_t)b->p->sliding->node[i];
    for (int a = 0; a < 3; a++)
        x[a] = b->p->position[n + a] + b->now->displacement[n + a];
}

/* The sum of the forces on a node. */
static void find_net(const bearing *b, int64_t node, double net[3])
{
    const tled_problem *p = b->p;
    double pull[8][3];
    tled_external(p, b->now->value, b->now->displacement + 3 * node, node, net);
    for (const int32_t *c = p->corner + 8 * node; c < p->corner + 8 * (node + 1) && *c < 8 * p->elements; c++) {
        bodies_pull(p, *c / 8, b->now, pull);
        for (int a = 0; a < 3; a++)
            net[a] -= pull[*c % 8][a];
    }
}

static void bear_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const bearing *b = context;
    const sliding *s = b->p->sliding;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        double net[3];
        if (body_of(s, i) < 0)
            continue;
        find_net(b, s->node[i], net);
        const sliding_load load = sliding_load_at(b->p, i, b->now->value, b->now->displacement, net);
        for (int a = 0; a < 3; a++)
            b->force[3 * i + a] = -(load.normal[a] + load.stuck[a]);
    }
}

/* About where a body's torque is told. */
static void find_middle(const bearing *b, int32_t body, double middle[3])
{
    const sliding *s = b->p->sliding;
    int64_t count = 0;
    if (bodies_middle(b->p, body, b->now->displacement, middle))
        return;
    for (int64_t i = 0; i < s->count; i++) {
        double x[3];
        place_of(b, i, x);
        for (int a = 0; a < 3 && body_of(s, i) == body; a++)
            middle[a] += x[a];
        count += body_of(s, i) == body;
    }
    for (int a = 0; a < 3 && count; a++)
        middle[a] /= (double)count;
}

static void add_to(const bearing *b, int32_t body, body_load *to)
{
    const sliding *s = b->p->sliding;
    double middle[3];
    find_middle(b, body, middle);
    for (int64_t i = 0; i < s->count; i++) {
        double x[3];
        const double *f = b->force + 3 * i;
        if (body_of(s, i) != body)
            continue;
        place_of(b, i, x);
        for (int a = 0; a < 3; a++) {
            const int j = (a + 1) % 3, k = (a + 2) % 3;
            to->force[a] += f[a];
            to->torque[a] += (x[j] - middle[j]) * f[k] - (x[k] - middle[k]) * f[j];
        }
    }
}

int sliding_loads(const tled_problem *p, pool *threads, const bodies_state *now, body_load *to, err *e)
{
    const sliding *s = p->sliding;
    if (!s || !s->body || !p->bodies)
        return 0;
    bearing b = {p, now, mem_array(s->count, 3 * sizeof *b.force, "the sliding nodes", e)};
    if (!b.force)
        return -1;
    pool_run(threads, s->count, CHUNK, bear_work, &b);
    for (int32_t i = 0; i < p->bodies->count; i++)
        add_to(&b, i, &to[i]);
    free(b.force);
    return 0;
}

/* The first field that moves with a body, or -1. */
static int32_t field_of(const sliding *s, int32_t body)
{
    for (int32_t f = 0; f < s->fields; f++)
        if (s->body[f] == body)
            return f;
    return -1;
}

/* Where a body has moved to, by where four points go. */
static pose pose_of(const sliding *s, int32_t which, const double *value)
{
    static const double rest[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const int32_t point[4] = {0, 1, 2, 3};
    const sliding_bone bone = sliding_bone_at(s, which, value);
    double displacement[12];
    for (int i = 0; i < 12; i++)
        displacement[i] = bone.to[i % 3] + (i < 3 ? 0 : bone.turn[i % 3][i / 3 - 1]) - rest[i];
    return pose_fit(rest, displacement, point, 4);
}

static int add_loads(const tled_problem *p, pool *threads, const bodies_state *now, double *force, double *torque,
                     err *e)
{
    body_load *load = mem_array(p->bodies->count, sizeof *load, "the bodies", e);
    const int failed = load ? sliding_loads(p, threads, now, load, e) : -1;
    for (int64_t i = 0; !failed && i < 3 * (int64_t)p->bodies->count; i++) {
        force[i] += load[i / 3].force[i % 3];
        torque[i] += load[i / 3].torque[i % 3];
    }
    free(load);
    return failed;
}

/* The fields of nodes that slide, or else those that skin may not enter. */
static const sliding *bones_of(const tled_problem *p)
{
    return p->sliding ? p->sliding : p->self_contact ? p->self_contact->bones : NULL;
}

int sliding_add(const tled_problem *p, pool *threads, const bodies_state *now, frame *f, err *e)
{
    const sliding *s = bones_of(p);
    const model_array *at = frame_find(f, "body.pose"), *force = frame_find(f, "body.force");
    const model_array *torque = frame_find(f, "body.torque");
    if (!s || !s->body || !at || !force || !torque)
        return 0;
    for (int32_t i = 0; i < p->bodies->count; i++) {
        const int32_t which = field_of(s, i);
        if (which >= 0 && p->bodies->start[i] == p->bodies->start[i + 1]) {
            const pose moved = pose_of(s, which, now->value);
            pose_to_row(&moved, at->f64 + 7 * (int64_t)i);
        }
    }
    return add_loads(p, threads, now, force->f64, torque->f64, e);
}
