#include "msds/mesh/mesh_way.h"

#include "msds/mesh/mesh_shape.h"

enum {
    STEPS = 8,    /* of a search along a line */
    HALVINGS = 24 /* of a step that crosses the border */
};

double mesh_way(const mesh_field *f, const double from[3], const double along[3], double most, int steps)
{
    const int region = f->region(f->context, from);
    double low = 0, high = 0, place[3];
    bool crossed = false;
    for (int i = 1; i <= steps && !crossed; i++) {
        low = high;
        high = most * i / steps;
        for (int a = 0; a < 3; a++)
            place[a] = from[a] + high * along[a];
        crossed = f->region(f->context, place) != region;
    }
    for (int h = 0; crossed && h < HALVINGS; h++) {
        const double middle = .5 * (low + high);
        for (int a = 0; a < 3; a++)
            place[a] = from[a] + middle * along[a];
        if (f->region(f->context, place) == region)
            low = middle;
        else
            high = middle;
    }
    return crossed ? .5 * (low + high) : (double)INFINITY;
}

bool mesh_way_foot(const mesh_field *f, const double unit[3][3], const bool stays[3], const double from[3], double way,
                   double to[3])
{
    const double far = 3 * way;
    double along[3] = {0};
    for (int a = 0; a < 3; a++) {
        double back[3];
        for (int i = 0; i < 3; i++)
            back[i] = -unit[a][i];
        if (stays[a])
            continue;
        const double up = mesh_way(f, from, unit[a], far, STEPS), down = mesh_way(f, from, back, far, STEPS);
        for (int i = 0; i < 3; i++)
            along[i] += (up < down ? 1 / up : -1 / down) * unit[a][i];
    }
    shape_unit(along);
    const double length = shape_dot(along, along) > 0 ? mesh_way(f, from, along, 1.5 * way, STEPS) : (double)INFINITY;
    for (int i = 0; i < 3; i++)
        to[i] = from[i] + length * along[i];
    return isfinite(length);
}
