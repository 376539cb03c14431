#include "bind/touch.h"

#include "bind/touch_depth.h"

#include <math.h>
#include <string.h>

static int write_samples(model *m, const touch_depth *d, int64_t samples, bool blended, err *e)
{
    if (model_axis_add(m, "contact", samples, e) || !model_add(m, "contact.element", e) ||
        !model_add(m, "contact.weight", e) || (blended && !model_add(m, "contact.blended", e)))
        return -1;
    memcpy(model_find(m, "contact.element")->i32, d->element, (size_t)samples * sizeof *d->element);
    memcpy(model_find(m, "contact.weight")->f64, d->weight, 3 * (size_t)samples * sizeof *d->weight);
    if (blended)
        memset(model_find(m, "contact.blended")->u8, 1, (size_t)samples);
    return 0;
}

static int write_nodes(model *m, const touch_depth *d, err *e)
{
    if (model_axis_add(m, "skin", d->nodes, e) || !model_add(m, "skin.node", e) || !model_add(m, "skin.distance", e))
        return -1;
    memcpy(model_find(m, "skin.node")->i32, d->node, (size_t)d->nodes * sizeof *d->node);
    for (int64_t n = 0; n < d->nodes; n++)
        model_find(m, "skin.distance")->f32[n] = (float)d->distance[n];
    return 0;
}

int touch_make(model *m, const side *sides, const touch_skin_options *o, int threads, pool *by, touch_found *found,
               notes *warnings, err *e)
{
    const double *h = sides->to->grid.spacing;
    touch_skin_options with = *o;
    touch_skin skin = {.vertices = 0};
    touch_depth depth = {.nodes = 0};
    if (!(with.apart > 0))
        with.apart = fmin(h[0], fmin(h[1], h[2]));
    int failed =
        touch_skin_make(&skin, m, sides, &with, by, e) || touch_depth_make(&depth, m, sides, &skin, threads, by, e);
    *found = (touch_found){skin.samples, depth.nodes, depth.worst};
    model_axis_drop(m, "contact", warnings);
    model_axis_drop(m, "skin", warnings);
    failed = failed || write_samples(m, &depth, skin.samples, o->blended, e) || write_nodes(m, &depth, e);
    touch_skin_free(&skin);
    touch_depth_free(&depth);
    return failed ? -1 : 0;
}
