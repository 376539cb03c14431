/* What the CPU executor for boxes has of elements that are cut (tled/problem/cut.h): the moments of groups of these,
 * and the weight of nodes in parts of their mass; part of cpu_loops.h.
 */
enum { CUT_USED = 6 }; /* moments that forces take */

static int cut_allocate(cpu_state *s, err *e)
{
    const bool cuts = s->p->cut.count;
    return (cuts && make_numbers(&s->cut, s->rows.cuts, CUT_USED * s->pass->lanes, e)) ||
                   (s->p->weight && make_numbers(&s->weight, s->rows.nodes, 1, e))
               ? -1
               : 0;
}

static int64_t cut_bytes(const cpu_state *s)
{
    const int64_t cuts = s->cut ? (int64_t)s->rows.cuts * CUT_USED * s->pass->lanes : 0;
    return (cuts + (s->weight ? s->rows.nodes : 0)) * (int64_t)sizeof(number);
}

static void cut_fill_group(const cpu_state *s, const rows_group *g)
{
    const int lanes = s->pass->lanes;
    number *to = s->cut + (int64_t)g->cut * CUT_USED * lanes;
    for (int i = 0; i < g->count; i++) {
        const float *moments = tled_cut(s->p, s->rows.cell_element[g->cell + i]);
        for (int k = 0; moments && k < CUT_USED; k++)
            to[k * lanes + i] = (number)moments[k];
    }
}

static void cut_fill(const cpu_state *s)
{
    for (const rows_group *g = s->rows.group; s->cut && g < s->rows.group + s->rows.groups; g++)
        if (g->cut >= 0)
            cut_fill_group(s, g);
    for (int64_t n = 0; s->weight && n < s->p->nodes; n++)
        s->weight[s->rows.place[n]] = (number)tled_weight_part(s->p, n);
}
