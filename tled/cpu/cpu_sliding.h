/* What the CPU executors have of nodes that slide on bone (tled/contact/sliding.h): a pass leaves these nodes and their
 * sums alone, and what it does with others is done here, in double, with what the bone bears; part of cpu_loops.h.
 */
enum { SLIDING_CHUNK = 512 };

static void slide_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    cpu_state *s = context;
    const cpu_work *w = &s->work;
    const tled_problem *p = s->p;
    const sliding *of = p->sliding;
    const sliding_step step = {w->dt, w->damping, w->what & PASS_FINISH, w->what & PASS_BEGIN, s->next};
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        const int64_t node = of->node[i], place = s->rows.place[node];
        const sliding_node n = sliding_node_of(p, i);
        sliding_bones bones = {.was = sliding_bone_at(of, n.of, s->now)};
        double u[3], v[3], sum[3], a[3];
        bones.past = step.finishes ? sliding_bone_at(of, n.of, s->past) : bones.was;
        bones.is = step.begins ? sliding_bone_at(of, n.of, s->next) : bones.was;
        for (int k = 0; k < 3; k++) {
            u[k] = (double)s->field[TLED_DISPLACEMENT][k * s->rows.nodes + place];
            v[k] = (double)s->field[TLED_VELOCITY][k * s->rows.nodes + place];
            sum[k] = (double)s->sum[k * s->rows.nodes + place];
        }
        tled_external(p, s->now, u, node, a);
        for (int k = 0; k < 3; k++)
            a[k] = (a[k] - sum[k]) / p->mass[node];
        sliding_go(&of->ground, &n, &bones, &step, a, u, v);
        for (int k = 0; k < 3; k++) {
            const int64_t at = k * s->rows.nodes + place;
            s->field[TLED_VELOCITY][at] = (number)v[k];
            s->spare[at] = (number)(w->what & PASS_INTERNAL ? sum[k] : u[k]);
            s->sum[at] = 0;
        }
    }
}

static void move_sliding(cpu_state *s)
{
    pool_run(s->threads, s->p->sliding->count, SLIDING_CHUNK, slide_work, s);
}
