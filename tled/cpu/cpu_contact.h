/* What the CPU executors have of contact with a probe (tled/problem/collider.h): its push begins the sums that a pass
 * adds to; part of cpu_loops.h.
 */
/* What the probe pushes with, into the sums that the pass adds to. */
typedef struct cpu_contact {
    const cpu_state *s;
    probe_placed at;
    double up;
} cpu_contact;

static void contact_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const cpu_contact *c = context;
    const cpu_state *s = c->s;
    (void)chunk;
    for (int64_t n = from; n < to; n++) {
        double x[3], push[3];
        for (int a = 0; a < 3; a++)
            x[a] =
                s->p->position[3 * n + a] + (double)s->field[TLED_DISPLACEMENT][a * s->rows.nodes + s->rows.place[n]];
        if (!collider_push(s->p->collider, &c->at, c->up, x, s->p->mass[n], push))
            continue;
        for (int a = 0; a < 3; a++)
            s->sum[a * s->rows.nodes + s->rows.place[n]] = (number)-push[a];
    }
}
