/* What the CPU executor for boxes has of elements that are laminates (tled/problem/cut.h): the numbers of groups of
 * these; part of cpu_loops.h.
 */
static int64_t border_numbers(const cpu_state *s)
{
    return (int64_t)s->rows.borders * LAMINATE_NUMBERS * s->pass->lanes;
}

static int border_allocate(cpu_state *s, err *e)
{
    return s->rows.borders ? make_numbers(&s->border, border_numbers(s), 1, e) : 0;
}

static int64_t border_bytes(const cpu_state *s)
{
    return border_numbers(s) * (int64_t)sizeof(number);
}

static void border_fill_group(const cpu_state *s, const rows_group *g)
{
    const int lanes = s->pass->lanes;
    number *to = s->border + (int64_t)g->border * LAMINATE_NUMBERS * lanes;
    for (int i = 0; i < g->count; i++) {
        const double *of = tled_border(s->p, s->rows.cell_element[g->cell + i]);
        for (int k = 0; k < LAMINATE_NUMBERS; k++)
            to[k * lanes + i] = (number)of[k];
    }
}

static void border_fill(const cpu_state *s)
{
    for (const rows_group *g = s->rows.group; s->border && g < s->rows.group + s->rows.groups; g++)
        if (g->border >= 0)
            border_fill_group(s, g);
}
