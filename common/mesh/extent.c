#include "mesh/extent.h"

#include <math.h>

static const double smallest = 3e-3,
                    largest = 3; /* m: the longest side of a body, or of a part of one that somebody models */

/* Of a length: what is nearer to a limit reads as that in four digits. */
static const double rounding = 2e-4;

static double in_metres(double length, num_unit unit)
{
    return num_length_in((num_length){length, unit}, unit, num_unit_of("m"));
}

static bool fits(double side, num_unit unit)
{
    const double m = in_metres(side, unit);
    return m >= smallest * (1 - rounding) && m <= largest * (1 + rounding);
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

void extent_note(notes *n, const char *of, const double d[3], num_unit unit)
{
    double side = fmax(d[0], fmax(d[1], d[2]));
    if (!(side > 0) || fits(side, unit))
        return;
    const char *name = better(side), *what = in_metres(side, unit) > largest ? "beyond 3 m" : "below 3 mm";
    num_unit other = name ? num_unit_of(name) : unit;
    if (name)
        notes_add(n, "%s is %.4g x %.4g x %.4g m with --unit %s, %s; with --unit %s it is %.4g x %.4g x %.4g m", of,
                  in_metres(d[0], unit), in_metres(d[1], unit), in_metres(d[2], unit), num_unit_name(unit), what, name,
                  in_metres(d[0], other), in_metres(d[1], other), in_metres(d[2], other));
    else
        notes_add(n, "%s is %.4g x %.4g x %.4g m with --unit %s, %s; no other unit gives it the size of a body", of,
                  in_metres(d[0], unit), in_metres(d[1], unit), in_metres(d[2], unit), num_unit_name(unit), what);
}
