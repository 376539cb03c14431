/* What the CPU executors have of skin that touches itself (tled/contact/self_contact.h): the nodes about it go there
 * and back after a pass that begins a step; part of cpu_loops.h.
 */
enum { SELF_CHUNK = 1024 };

static void skin_in(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const cpu_state *s = context;
    const int32_t *node = s->p->self_contact->node;
    double *u = self_contact_displacement(s->skin), *v = self_contact_velocity(s->skin);
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        for (int a = 0; a < 3; a++) {
            const int64_t at = a * s->rows.nodes + s->rows.place[node[i]];
            u[3 * i + a] = (double)s->spare[at];
            v[3 * i + a] = (double)s->field[TLED_VELOCITY][at];
        }
}

static void skin_out(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const cpu_state *s = context;
    const int32_t *node = s->p->self_contact->node;
    const double *u = self_contact_displacement(s->skin), *v = self_contact_velocity(s->skin);
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        for (int a = 0; a < 3; a++) {
            const int64_t at = a * s->rows.nodes + s->rows.place[node[i]];
            s->spare[at] = (number)u[3 * i + a];
            s->field[TLED_VELOCITY][at] = (number)v[3 * i + a];
        }
}

static void touch_skin(cpu_state *s)
{
    const int64_t nodes = s->p->self_contact->nodes;
    pool_run(s->threads, nodes, SELF_CHUNK, skin_in, s);
    if (self_contact_step(s->skin, s->threads, s->work.dt))
        pool_run(s->threads, nodes, SELF_CHUNK, skin_out, s);
}
