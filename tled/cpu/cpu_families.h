/* The directions of an element's families of fibres, where these are at an angle to the fibre, in the memory of the CPU
 * executors; part of cpu_loops.h.
 */
/* The directions of families in a cell, where they are not those of fibres. */
static void fill_families(cpu_state *s, int64_t cell)
{
    const int64_t cells = s->rows.cells + ROWS_PAD;
    fibre_local at[2];
    const int count = s->family ? fibres_at(&s->p->fibres, s->rows.cell_element[cell], at) : 0;
    for (int i = 0; i < count; i++) {
        number *to = at[i].is_second ? s->mixfamily : s->family;
        for (int k = 0; k < 3 * FIBRE_FAMILIES; k++)
            to[k * cells + cell] = (number)at[i].family[k / 3][k % 3];
    }
}

/* Where the families' directions are: with the fibres, unless any are at an angle to these. */
static void find_families(cpu_state *s)
{
    cpu_work *w = &s->work;
    const int64_t cells = s->rows.cells + ROWS_PAD;
    for (int a = 0; a < 3; a++) {
        w->family[0][a] = w->fibre[a];
        w->mixfamily[0][a] = w->mixfibre[a];
    }
    for (int k = 0; k < 3 * FIBRE_FAMILIES; k++) {
        if (s->family)
            w->family[k / 3][k % 3] = s->family + k * cells;
        if (s->mixfamily)
            w->mixfamily[k / 3][k % 3] = s->mixfamily + k * cells;
    }
}
