#include "voxelise/report.h"

#include <math.h>

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

void report_volume(out *o, const volumes_volume *v, const check_result *r, int64_t open, const char *unit)
{
    out_format(o, "volume %s\n", v->name);
    line(o, "surfaces");
    out_format(o, "%s\n", v->surfaces);
    line(o, "level, priority");
    out_format(o, "%d, %d\n", v->level, v->priority);
    line(o, "closed");
    if (open)
        out_format(o, "no: %lld open edges\n", (long long)open);
    else
        out_text(o, "yes\n");
    if (r)
        say_numbers(o, r, unit);
}

void report_warn(notes *n, const char *what, const char *name, const check_result *r)
{
    if (r->met)
        notes_add(n, "%s %s crosses itself (%lld pairs of triangles): what is inside twice is outside", what, name,
                  (long long)r->met);
    if (r->thin > 0.5)
        notes_add(n, "%s %s is thinner than a voxel over %.3g %% of its area: it has voxels there by chance", what,
                  name, 100 * r->thin);
}

/* ---- the size of all */

static const double least = 3e-3,
                    most = 3; /* m: the longest side of a body, or of a part of one that somebody models */

void report_sides(const obj *o, double side[3])
{
    double low[3], high[3];
    obj_box(o, low, high);
    for (int a = 0; a < 3; a++)
        side[a] = high[a] - low[a];
}

static double in_metres(double length, num_unit unit)
{
    return num_length_in((num_length){length, unit}, unit, num_unit_of("m"));
}

static bool fits(double side, num_unit unit)
{
    return in_metres(side, unit) >= least && in_metres(side, unit) <= most;
}

/* The unit in which it would fit: that of most OBJ first. NULL: none. */
static const char *better(double side)
{
    static const char *const units[] = {"mm", "m", "cm", "in", "um"};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (fits(side, num_unit_of(units[i])))
            return units[i];
    return NULL;
}

void report_size(notes *n, const obj *o, num_unit unit)
{
    double d[3];
    report_sides(o, d);
    double side = fmax(d[0], fmax(d[1], d[2]));
    if (!(side > 0) || fits(side, unit))
        return;
    const char *name = better(side), *what = in_metres(side, unit) > most ? "beyond 3 m" : "below 3 mm";
    num_unit other = name ? num_unit_of(name) : unit;
    if (name)
        notes_add(n, "%s is %.4g x %.4g x %.4g m with --unit %s, %s; with --unit %s it is %.4g x %.4g x %.4g m",
                  o->name, in_metres(d[0], unit), in_metres(d[1], unit), in_metres(d[2], unit), num_unit_name(unit),
                  what, name, in_metres(d[0], other), in_metres(d[1], other), in_metres(d[2], other));
    else
        notes_add(n, "%s is %.4g x %.4g x %.4g m with --unit %s, %s; no other unit makes a body of it", o->name,
                  in_metres(d[0], unit), in_metres(d[1], unit), in_metres(d[2], unit), num_unit_name(unit), what);
}
