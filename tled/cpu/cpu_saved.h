/* States that are saved, gone back to, and put from outside. Part of cpu_loops.h, of its state and its precision.
 */
static int cpu_save(cpu_state *s, err *e)
{
    self_contact_forget(s->skin);
    return copy_out(s, FIELDS_ALL, &s->saved, e);
}

static int cpu_restore(cpu_state *s, err *e)
{
    const number *at = s->saved;
    (void)e;
    self_contact_forget(s->skin);
    for (int i = 0; i < s->p->fields.count; i++) {
        const cpu_layout l = layout_of(s, i);
        memcpy(s->field[i], at, (size_t)(l.columns * l.stride) * sizeof *at);
        at += l.columns * l.stride;
    }
    s->spare_is_internal = false;
    return 0;
}

static int cpu_put(cpu_state *s, const field_values *values, double time, err *e)
{
    (void)e;
    self_contact_forget(s->skin);
    for (int i = 0; i < s->p->fields.count; i++)
        put_in(layout_of(s, i), values->of[i], s->field[i]);
    s->time = time;
    s->spare_is_internal = false;
    return 0;
}
