#include "held_report.h"

#include "fibre_rule.h"

#include <math.h>
#include <stdio.h>

/* The last primitive after which the run that begins at i ends: faces that follow one another and hold no node. */
static int64_t run_end(const rigid *r, int64_t i)
{
    const rigid_primitive *p = r->primitive;
    while (i + 1 < r->primitives && p[i + 1].idle && p[i + 1].surface == p[i].surface && p[i + 1].of == p[i].of &&
           p[i + 1].face == p[i].face + 1)
        i++;
    return i;
}

/* One line: from i on, a few runs of faces of one surface that hold no node. Returns where the next line begins. */
static int64_t report_run(const tool *t, const rigid *r, int64_t which, int64_t i)
{
    enum { FEW = 20 };
    char text[FEW * 44] = "";
    int n = 0;
    const rigid_primitive *first = &r->primitive[i], *p = first;
    for (int runs = 0; i < r->primitives && runs < FEW && p->surface == which && p->of == first->of; runs += p->idle) {
        int64_t last = p->idle ? run_end(r, i) : i;
        if (p->idle)
            n += snprintf(text + n, sizeof text - (size_t)n, "%s%lld", n ? ", " : "", (long long)p->face + 1);
        if (last > i)
            n += snprintf(text + n, sizeof text - (size_t)n, "-%lld", (long long)r->primitive[last].face + 1);
        i = last + 1;
        p = i < r->primitives ? &r->primitive[i] : p;
    }
    if (n)
        tool_say(t, "%s: these faces of %s hold no node: %s", r->surface[which].name, first->of, text);
    return i;
}

/* The first line, and with -v however many there are. */
static void report_idle(const tool *t, const rigid *r, int64_t which)
{
    int64_t i = 0, left = 0;
    while (i < r->primitives && (r->primitive[i].surface != which || !r->primitive[i].idle))
        i++;
    for (bool more = true; more && i < r->primitives && r->primitive[i].surface == which; more = t->common->verbose)
        i = report_run(t, r, which, i);
    for (; i < r->primitives && r->primitive[i].surface == which; i++)
        left += r->primitive[i].idle;
    if (left)
        tool_say(t, "%s: %lld more faces hold no node; -v lists them", r->surface[which].name, (long long)left);
}

int held_report_surfaces(const tool *t, const rigid *r, err *e)
{
    static const char *const heads[] = {"<surface", ">nodes\nheld", ">primitives", ">without\na node", NULL};
    text_table *rows = text_table_create(heads, e);
    if (!rows)
        return -1;
    for (int64_t i = 0; i < r->surfaces; i++) {
        text_table_cell(rows, "%s", r->surface[i].name);
        text_table_count(rows, r->surface[i].nodes);
        text_table_count(rows, r->surface[i].primitives);
        text_table_count(rows, r->surface[i].idle);
    }
    const int rc = tool_table(t, rows, e, "%lld rigid surface%s", (long long)r->surfaces, r->surfaces == 1 ? "" : "s");
    text_table_free(rows);
    for (int64_t i = 0; !rc && i < r->surfaces; i++)
        if (r->surface[i].idle < r->surface[i].primitives)
            report_idle(t, r, i);
    return rc;
}

/* ---- muscles */

/* The rule that gave the fibres, and how many elements have another rule or no fibre. */
static void add_rule(text_table *rows, const muscle *m)
{
    const char *const name = fibre_rules[m->rule].name, *const axis = fibre_rules[MUSCLE_AXIS].name;
    const int64_t by_rule = m->elements - m->without - m->by_axis;
    if (m->without == m->elements)
        text_table_cell(rows, "none");
    else if (m->without)
        text_table_cell(rows, "%s, %lld none", by_rule ? name : axis, (long long)m->without);
    else if (by_rule && m->by_axis)
        text_table_cell(rows, "%s, %lld axis", name, (long long)m->by_axis);
    else
        text_table_cell(rows, "%s", by_rule ? name : axis);
}

static void add_centre(text_table *rows, const double *centre, int decimals)
{
    for (int a = 0; a < 3; a++)
        text_table_number(rows, 1e3 * centre[a], decimals);
}

/* The attachments of a muscle, if it has several. */
static void add_attachments(text_table *rows, const muscles *list, int64_t which, const rigid *r, int decimals)
{
    int64_t number = 0, all = 0;
    for (int64_t i = 0; i < list->attached.count; i++)
        all += list->attached.of[i].muscle == which;
    for (int64_t i = 0; all > 1 && i < list->attached.count; i++) {
        const attachment *a = &list->attached.of[i];
        if (a->muscle != which)
            continue;
        text_table_cell(rows, "  %lld of %lld: %s", (long long)++number, (long long)all,
                        a->anchor < 0 ? "no anchor" : r->surface[a->anchor].name);
        text_table_cell(rows, "%s", "");
        text_table_cell(rows, "%s", "");
        text_table_count(rows, a->nodes);
        add_centre(rows, a->centre, decimals);
        text_table_cell(rows, "%s", "");
    }
}

/* Decimals of millimetres. */
static int find_decimals(const muscles *list)
{
    double largest = 0;
    for (int64_t i = 0; i < list->count; i++)
        for (int a = 0; a < 3; a++)
            largest = fmax(largest, fabs(list->of[i].centre[a])); /* not of nan */
    return text_table_decimals(1e3 * largest, 5);
}

int held_report_muscles(const tool *t, const muscles *list, const rigid *r, err *e)
{
    static const char *const heads[] = {"<muscle", ">elements", "<fibres", ">rigid\nnodes", ">centre x\nmm", ">y\nmm",
                                        ">z\nmm",  "<",         NULL};
    const int decimals = find_decimals(list);
    text_table *rows = text_table_create(heads, e);
    if (!rows)
        return -1;
    for (int64_t i = 0; i < list->count; i++) {
        const muscle *m = &list->of[i];
        text_table_cell(rows, "%s", m->name);
        text_table_count(rows, m->elements);
        add_rule(rows, m);
        text_table_count(rows, m->rigid_nodes);
        add_centre(rows, m->centre, decimals);
        text_table_cell(rows, "%s", muscle_contracts(m) ? "" : "!");
        add_attachments(rows, list, i, r, decimals);
    }
    const int rc = tool_table(t, rows, e, "%lld muscle%s", (long long)list->count, list->count == 1 ? "" : "s");
    text_table_free(rows);
    return rc;
}
