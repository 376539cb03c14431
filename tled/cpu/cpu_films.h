/* What the CPU executors have of films on bone (tled/problem/films.h): their pull joins the sums that a pass adds
 * to; part of cpu_loops.h.
 */
static void films_in(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const cpu_state *s = context;
    const films_work *w = &s->films;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        for (int a = 0; a < 3; a++)
            w->moved[3 * i + a] =
                (double)s->field[TLED_DISPLACEMENT][a * s->rows.nodes + s->rows.place[s->p->films->node[i]]];
}

static void films_out(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const cpu_state *s = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        double pull[3];
        films_sum(&s->films, i, pull);
        for (int a = 0; a < 3; a++)
            s->sum[a * s->rows.nodes + s->rows.place[s->p->films->node[i]]] += (number)pull[a];
    }
}

/* What films pull with, beside the rest. */
static void strain_films(cpu_state *s)
{
    pool_run(s->threads, s->p->films->nodes, FOLLOWERS_CHUNK, films_in, s);
    films_strain(&s->films, s->threads, s->now);
    pool_run(s->threads, s->p->films->nodes, FOLLOWERS_CHUNK, films_out, s);
}
