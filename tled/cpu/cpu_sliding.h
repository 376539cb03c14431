/* What the CPU executors have of nodes that slide on bone (tled/contact/sliding.h): a pass leaves these nodes and their
 * sums alone, and what it does with others is done here, in double, with what the bone bears; part of cpu_loops.h.
 */
enum { SLIDING_CHUNK = 512 };

typedef struct cpu_slider {
    int64_t row, at; /* in the sliding; in the rows' order */
    int64_t node;
    sliding_bone past, was, is; /* a step before now, now, and at the step's end */
} cpu_slider;

/* What the script displaces of it goes where that says. */
static void displace_slider(const cpu_state *s, const cpu_slider *c, double dt, double u[3], double v[3])
{
    for (int a = 0; a < 3; a++) {
        const int32_t hold = s->p->hold[3 * c->node + a];
        if (hold < 0)
            continue;
        const double end = moves_to(s->next, hold, a, s->p->position + 3 * c->node);
        v[a] = (end - u[a]) / dt;
        u[a] = end;
    }
}

static void move_slider(cpu_state *s, const cpu_slider *c, double u[3], double v[3], const double sum[3])
{
    const cpu_work *w = &s->work;
    const tled_problem *p = s->p;
    const double drag = w->damping * w->dt / 2;
    double a[3];
    tled_external(p, s->now, u, c->node, a);
    for (int i = 0; i < 3; i++)
        a[i] = p->hold[3 * c->node + i] == HOLD_FREE ? (a[i] - sum[i]) / p->mass[c->node] : 0;
    const double borne = sliding_bear(p, c->row, &c->was, u, a);
    for (int i = 0; i < 3; i++)
        if (p->hold[3 * c->node + i] == HOLD_FREE && w->what & PASS_FINISH)
            v[i] = v[i] * (1 - drag) + w->dt / 2 * a[i];
    if (w->what & PASS_FINISH)
        sliding_rub(p, c->row, &c->past, &c->was, borne, w->dt, u, v);
    if (!(w->what & PASS_BEGIN))
        return;
    for (int i = 0; i < 3; i++)
        if (p->hold[3 * c->node + i] == HOLD_FREE) {
            v[i] = (v[i] + w->dt / 2 * a[i]) / (1 + drag);
            u[i] += w->dt * v[i];
        }
    displace_slider(s, c, w->dt, u, v);
    sliding_place(p, c->row, &c->was, &c->is, borne, w->dt, u, v);
}

static void slide_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    cpu_state *s = context;
    const sliding *of = s->p->sliding;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        cpu_slider c = {.row = i, .node = of->node[i], .at = s->rows.place[of->node[i]]};
        double u[3], v[3], sum[3];
        c.was = sliding_bone_at(of, of->of[i], s->now);
        c.past = s->work.what & PASS_FINISH ? sliding_bone_at(of, of->of[i], s->past) : c.was;
        c.is = s->work.what & PASS_BEGIN ? sliding_bone_at(of, of->of[i], s->next) : c.was;
        for (int a = 0; a < 3; a++) {
            u[a] = (double)s->field[TLED_DISPLACEMENT][a * s->rows.nodes + c.at];
            v[a] = (double)s->field[TLED_VELOCITY][a * s->rows.nodes + c.at];
            sum[a] = (double)s->sum[a * s->rows.nodes + c.at];
        }
        move_slider(s, &c, u, v, sum);
        for (int a = 0; a < 3; a++) {
            const int64_t at = a * s->rows.nodes + c.at;
            s->field[TLED_VELOCITY][at] = (number)v[a];
            s->spare[at] = (number)(s->work.what & PASS_INTERNAL ? sum[a] : u[a]);
            s->sum[at] = 0;
        }
    }
}

static void move_sliding(cpu_state *s)
{
    pool_run(s->threads, s->p->sliding->count, SLIDING_CHUNK, slide_work, s);
}
