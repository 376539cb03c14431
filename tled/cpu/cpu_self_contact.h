/* What the CPU executors have of skin that touches itself (tled/contact/self_contact.h): the nodes about it go there
 * and back after a pass that begins a step; part of cpu_loops.h.
 */
enum { SELF_CHUNK = 1024 };

static void skin_in(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const cpu_state *s = context;
    const int32_t *node = s->p->self_contact->node;
    double *u = self_contact_displacement(s->skin);
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        for (int a = 0; a < 3; a++)
            u[3 * i + a] = (double)s->spare[a * s->rows.nodes + s->rows.place[node[i]]];
}

static void touch_skin(cpu_state *s)
{
    const int32_t *node = s->p->self_contact->node, *row;
    double *u = self_contact_displacement(s->skin), *v = self_contact_velocity(s->skin);
    pool_run(s->threads, s->p->self_contact->nodes, SELF_CHUNK, skin_in, s);
    const int32_t count = self_contact_find(s->skin, s->threads, s->now, s->next, &row);
    for (int64_t k = 0; k < 3 * (int64_t)count; k++)
        v[3 * (int64_t)row[k / 3] + k % 3] =
            (double)s->field[TLED_VELOCITY][k % 3 * s->rows.nodes + s->rows.place[node[row[k / 3]]]];
    self_contact_solve(s->skin, s->work.dt);
    for (int64_t k = 0; k < 3 * (int64_t)count; k++) {
        const int64_t at = k % 3 * s->rows.nodes + s->rows.place[node[row[k / 3]]];
        s->spare[at] = (number)u[3 * (int64_t)row[k / 3] + k % 3];
        s->field[TLED_VELOCITY][at] = (number)v[3 * (int64_t)row[k / 3] + k % 3];
    }
}
