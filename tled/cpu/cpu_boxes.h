/* The CPU executor for boxes of a lattice: the memory that its groups' forces are kept in, and its passes; part of
 * cpu_loops.h.
 */
enum { CPU_LINE = 64 }; /* bytes of a line of the cache */

/* Numbers that the forces of groups take, with what is read before and behind. */
static int64_t seat_numbers(const cpu_state *s)
{
    return ((int64_t)s->rows.seats * 24 + 2) * s->pass->lanes + CPU_LINE / (int64_t)sizeof(number);
}

static number *seats_at(const cpu_state *s)
{
    const uintptr_t first = (uintptr_t)(s->force + s->pass->lanes);
    return s->force + s->pass->lanes + (CPU_LINE - first % CPU_LINE) % CPU_LINE / sizeof(number);
}

static int boxes_make(cpu_state *s, err *e)
{
    if (rows_make(&s->rows, s->p, s->pass->lanes, pool_threads(s->threads), e))
        return -1;
    s->force = mem_array(seat_numbers(s), sizeof *s->force, "the solver", e);
    return s->force ? 0 : -1;
}

static int64_t boxes_bytes(const cpu_state *s)
{
    const rows *r = &s->rows;
    return r->groups * (int64_t)sizeof *r->group + r->stretches * (int64_t)sizeof *r->stretch +
           r->sums * (int64_t)sizeof *r->sum + r->terms * (int64_t)sizeof *r->term +
           (r->seats ? seat_numbers(s) * (int64_t)sizeof(number) : 0);
}

static void pass_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const cpu_state *s = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++)
        s->pass->slab(&s->work, (int32_t)i);
}

static void boxes_pass(cpu_state *s)
{
    pool_run(s->threads, s->rows.slabs, 1, pass_work, s);
}
