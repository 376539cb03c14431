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
