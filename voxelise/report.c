#include "voxelise/report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void line(out *o, const char *what)
{
    out_format(o, "  %-32s", what);
}

static void count(out *o, const char *what, int64_t number)
{
    line(o, what);
    out_format(o, "%lld\n", (long long)number);
}

/* Whether a surface bounds a volume. */
static bool bounds(const volumes *plan, int32_t surface, int32_t volume)
{
    for (int64_t m = 0; m < plan->members; m++)
        if (plan->member[m].surface == surface && plan->member[m].volume == volume)
            return true;
    return false;
}

static void say_volumes(out *o, const volumes *plan, int32_t surface)
{
    int said = 0;
    line(o, "bounds");
    for (int32_t v = 0; v < plan->volumes; v++)
        if (bounds(plan, surface, v))
            out_format(o, "%s%s", said++ ? ", " : "", plan->volume[v].name);
    out_text(o, said ? "\n" : "no volume\n");
}

static void say_numbers(out *o, const check_result *r, const char *unit)
{
    count(o, "polygons", r->polygons);
    count(o, "triangles", r->triangles);
    count(o, "vertices", r->vertices);
    line(o, "box");
    out_format(o, "%.9g %.9g %.9g to %.9g %.9g %.9g %s\n", r->low[0], r->low[1], r->low[2], r->high[0], r->high[1],
               r->high[2], unit);
    line(o, "area");
    out_format(o, "%.6g %s^2\n", r->area, unit);
    line(o, "encloses");
    if (r->open)
        out_text(o, "nothing: it is open\n");
    else
        out_format(o, "%.6g %s^3%s\n", r->volume, unit, r->met ? " if nothing crossed" : "");
    count(o, "shells", r->shells);
    count(o, "edges of one polygon (open)", r->open);
    count(o, "edges of more than two", r->crowded);
    count(o, "edges where facing turns", r->turned);
    count(o, "polygons given again", r->repeated);
    count(o, "triangles without area", r->degenerate);
    count(o, "pairs of triangles that cross", r->met);
    if (r->met) {
        line(o, "deepest of these");
        out_format(o, "%.3g %s\n", r->deepest, unit);
    }
    if (!isnan(r->thin)) {
        line(o, "thinner than a voxel");
        out_format(o, "%.3g %% of its area\n", 100 * r->thin);
    }
}

void report_surface(out *o, const volumes *plan, int32_t surface, const check_result *r, const char *unit)
{
    out_format(o, "surface %s\n", plan->surface[surface].name);
    say_volumes(o, plan, surface);
    say_numbers(o, r, unit);
}

void report_volume(out *o, const volumes_volume *v, const check_result *r, int64_t open, const double at[3],
                   const char *unit)
{
    out_format(o, "volume %s\n", v->name);
    line(o, "surfaces");
    out_format(o, "%s\n", v->surfaces);
    line(o, "level, priority");
    out_format(o, "%d, %d\n", v->level, v->priority);
    line(o, "closed");
    if (open)
        out_format(o, "no: %lld open edges, the first at %.6g%s,%.6g%s,%.6g%s\n", (long long)open, at[0], unit, at[1],
                   unit, at[2], unit);
    else
        out_text(o, "yes\n");
    if (r)
        say_numbers(o, r, unit);
}

/* ---- tables */

text_table *report_surfaces(bool sized, err *e)
{
    const char *const last = sized ? "<" : NULL;
    const char *const heads[] = {
        "<surface",      ">polygons",     ">edges\nopen",           ">edges\n> 2", ">edges\nturned",
        ">poly.\nagain", ">pairs\ncross", sized ? ">thin\n%" : "<", last,          NULL};
    return text_table_create(heads, e);
}

/* Whether report_warn() warns of it. An open surface may be closed by another: that is asked of the volume. */
static bool is_wrong(const check_result *r)
{
    return r->met || r->thin > 0.5;
}

void report_surface_row(text_table *t, const char *name, const check_result *r, bool sized)
{
    text_table_cell(t, "%s", name);
    text_table_count(t, r->polygons);
    text_table_count(t, r->open);
    text_table_count(t, r->crowded);
    text_table_count(t, r->turned);
    text_table_count(t, r->repeated);
    text_table_count(t, r->met);
    if (sized)
        text_table_number(t, 100 * r->thin, 0);
    text_table_cell(t, "%s", is_wrong(r) ? "!" : "");
}

text_table *report_volumes(err *e)
{
    static const char *const heads[] = {"<volume", ">level", ">priority", ">edges\nopen", "<", "<surfaces", NULL};
    return text_table_create(heads, e);
}

void report_volume_row(text_table *t, const volumes_volume *v, int64_t open)
{
    text_table_cell(t, "%s", v->name);
    text_table_count(t, v->level);
    text_table_count(t, v->priority);
    text_table_count(t, open);
    text_table_cell(t, "%s", open ? "!" : "");
    text_table_cell(t, "%s", v->surfaces);
}

static int put_table(out *to, const text_table *rows, err *e)
{
    char *lines = text_table_lines(rows, e);
    out_text(to, lines ? lines : "");
    free(lines);
    return lines ? 0 : -1;
}

int report_write(const tool *t, const text_table *of_surfaces, const text_table *of_volumes, out *detail, err *e)
{
    size_t size;
    out *to = out_open(t->common->output, t->common->gzip, e);
    int status = to ? put_table(to, of_surfaces, e) : -1;
    if (!status) {
        out_text(to, "\n");
        status = put_table(to, of_volumes, e);
    }
    if (status) {
        out_discard(to);
        return -1;
    }
    const unsigned char *all = out_bytes(detail, &size);
    if (t->common->verbose) {
        out_text(to, "\n");
        out_write(to, all, size);
    }
    return out_close(to, e);
}

void report_warn(notes *n, listing *thin, const char *what, const char *name, const check_result *r)
{
    if (r->met)
        notes_add(n, "%s %s crosses itself (%lld pairs of triangles): a place that is enclosed twice counts as outside",
                  what, name, (long long)r->met);
    if (r->thin > 0.5)
        listing_add(thin, "%s%s (%.3g %%)", strcmp(what, "surface") != 0 ? "volume " : "", name, 100 * r->thin);
}

void report_thin(notes *n, listing *thin)
{
    const bool one = thin->count == 1;
    const char *verb = one ? " is" : "s are";
    const char *whose = one ? "its" : "their";
    if (thin->count)
        notes_add(n,
                  "%lld surface%s thinner than a voxel over more than half of %s area: %s; whether %s voxels there is "
                  "chance, so use smaller or flatter voxels (-s)",
                  (long long)thin->count, verb, whose, listing_text(thin), one ? "it has" : "they have");
}

/* ---- the size of all */

void report_sides(const obj *o, double side[3])
{
    double low[3], high[3];
    obj_box(o, low, high);
    for (int a = 0; a < 3; a++)
        side[a] = high[a] - low[a];
}

/* The extents that the polygons would have in m if the OBJ were in mm, and if it were in m; what else it may be in is
 * for the user to know. */
int report_ask_for_unit(const obj *o, err *e)
{
    double d[3];
    report_sides(o, d);
    return err_usage(
        e,
        "%s: an OBJ does not say its unit: with --unit mm it is %.4g x %.4g x %.4g m, with --unit m %.4g x %.4g x "
        "%.4g m; expected --unit mm|cm|m|in|um",
        o->name, d[0] / 1e3, d[1] / 1e3, d[2] / 1e3, d[0], d[1], d[2]);
}

/* ---- gaps that elements fill */

/* "2 mm", or "2 x 2 x 1 mm": the voxel's sides times a factor. */
static void put_voxel(char *to, size_t size, const grid *g, double factor, num_unit unit)
{
    const double *h = g->spacing;
    if (h[0] == h[1] && h[1] == h[2])
        snprintf(to, size, "%.3g %s", h[0] * factor, num_unit_name(unit));
    else
        snprintf(to, size, "%.3g x %.3g x %.3g %s", h[0] * factor, h[1] * factor, h[2] * factor, num_unit_name(unit));
}

/* By centres one of them lies in every gap that is as wide as a voxel; by shares a voxel lies in it far enough not to
 * be an element, wherever the gap is, from twice the rest of a share on. */
static double voxel_for(double width, double least)
{
    return isnan(least) || least >= .5 ? width : width / (2 * (1 - least));
}

/* What all lines across a gap stand for: a voxel's side each. */
static double gaps_area(const gaps *found, const grid *g)
{
    double sum = 0;
    for (int64_t i = 0; i < found->count; i++) {
        const int axis = found->gap[i].axis;
        sum += g->spacing[(axis + 1) % 3] * g->spacing[(axis + 2) % 3];
    }
    return sum;
}

void report_gaps(notes *n, const gaps *found, const grid *g, double least, num_unit unit)
{
    if (!found->count)
        return;
    const gap *middle = &found->gap[found->count / 2];
    const char *name = num_unit_name(unit);
    double at[3];
    char voxel[100];
    for (int a = 0; a < 3; a++)
        at[a] = grid_place(g, a, middle->middle[a]);
    put_voxel(voxel, sizeof voxel, g, voxel_for(middle->width, least), unit);
    notes_add(n,
              "elements fill gaps between surfaces in %lld place%s of a voxel's width, %.4g %s^2, as at "
              "%.6g%s,%.6g%s,%.6g%s, where the gap is %.3g %s wide along %c: both sides move as one there; voxels of "
              "at most %s separate them in half of these places%s, and --slits on parts them",
              (long long)found->count, found->count == 1 ? "" : "s", gaps_area(found, g), name, at[0], name, at[1],
              name, at[2], name, middle->width * g->spacing[middle->axis], name, 'x' + middle->axis, voxel,
              isnan(least) ? "" : ", and so may a larger --least");
}

/* ---- layers */

/* Each voxel is of a layer or not, by its centre alone. */
void report_layer(notes *n, const layers *l, int64_t layer, int32_t volume, const voxels *x, const grid *g,
                  num_unit unit)
{
    const double thickness = layers_thickness(l, layer), side = grid_longest(g);
    const double kept = (double)x->count[volume].kept;
    const char *name = num_unit_name(unit), *which = l->layer[layer].name;
    char what[256] = "no voxel centre is in it, so it has no element";
    int64_t r = 0;
    while (r < x->runs && x->run[r].volume != volume)
        r++;
    if (r < x->runs)
        snprintf(what, sizeof what,
                 "it has %.0f elements (%.3g %% of all), in stripes where voxel centres happen to lie in it, the first "
                 "at %.6g%s,%.6g%s,%.6g%s",
                 kept, 100 * kept / (double)x->elements, grid_place(g, 0, x->run[r].from), name,
                 grid_place(g, 1, x->run[r].j), name, grid_place(g, 2, x->run[r].k), name);
    notes_add(n, "layer %s is %.4g %s thick, less than a voxel of %.4g %s: %s; voxels of at most %.4g %s resolve it",
              which, thickness, name, side, name, what, thickness, name);
}

/* What is wrong with a layer by shares, other than that it is divided; "" if nothing is. */
static void say_share(char *to, size_t size, const climb_count *count, bool thin, bool laminates, double in_samples)
{
    *to = 0;
    if (!count->inside)
        snprintf(to, size, "no sample of the voxels is in it, so it has no element");
    else if (!count->kept && !count->mixed && !count->divided)
        snprintf(to, size, "it has no element, as two other volumes have more of each voxel");
    else if (thin && !laminates)
        snprintf(to, size,
                 "its elements have moduli between those of what they are mixed of, so it is too soft along itself, "
                 "which --mixed laminate mends");
    else if (in_samples < .5)
        snprintf(to, size,
                 "it is less than half as thick as samples of voxels are apart, so it is too soft; more samples "
                 "(--fraction %d at most) mend that",
                 SHARES_MOST);
}

bool report_layer_share(notes *n, const layers *l, int64_t layer, const climb_count *count, bool laminates,
                        int64_t samples, const grid *g, num_unit unit)
{
    const double thickness = layers_thickness(l, layer), side = grid_longest(g);
    const bool thin = layers_is_thin(l, layer, g);
    const char *name = num_unit_name(unit), *which = l->layer[layer].name;
    char why[256];
    say_share(why, sizeof why, count, thin, laminates, thickness * (double)samples / side);
    if (*why && thin)
        notes_add(n,
                  "layer %s is %.4g %s thick, less than a voxel of %.4g %s: %s; voxels of at most %.4g %s resolve it",
                  which, thickness, name, side, name, why, thickness, name);
    else if (*why)
        notes_add(n, "layer %s is %.4g %s thick: %s", which, thickness, name, why);
    if (count->divided)
        notes_add(n,
                  "layer %s is %.4g %s thick, and %lld elements of three layers and more are laminates of the stiffest "
                  "and the softest, which keep its stiffness in shear but not its density; smaller voxels keep the "
                  "layers apart",
                  which, thickness, name, (long long)count->divided);
    return *why || count->divided;
}

static const char *plural_of(int64_t count)
{
    return count == 1 ? "" : "s";
}

void report_slits(const tool *t, const slits *s)
{
    if (s->elements)
        tool_say(t, "slits are open: %lld more node%s, and %lld more element%s, of voxels in several parts",
                 (long long)s->nodes, plural_of(s->nodes), (long long)s->elements, plural_of(s->elements));
    else if (s->nodes)
        tool_say(t, "slits are open: %lld more node%s", (long long)s->nodes, plural_of(s->nodes));
}
