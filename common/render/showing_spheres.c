/* Rigid nodes and contraction centres as spheres. */
#include "base/mem.h"
#include "render/showing_parts.h"

#include <math.h>
#include <stdlib.h>

/* The length of an element's first edge: what spheres are measured by. 0: there are no elements. */
static double side(const model *m)
{
    const model_array *node = model_find(m, "element.node"), *rest = model_find(m, "node.position");
    double square = 0;
    for (int a = 0; node && rest && node->rows && a < 3; a++) {
        double d = rest->f64[3 * (int64_t)node->i32[1] + a] - rest->f64[3 * (int64_t)node->i32[0] + a];
        square += d * d;
    }
    return sqrt(square);
}

static int add(showing *b, float *spheres, int64_t count, const char *label, const uint8_t srgb[3], err *e)
{
    scene_spheres set = {.count = count};
    set.centre_radius = spheres;
    set.label = mem_text(label, e);
    showing_linear(srgb, set.colour);
    return scene_add_spheres(&b->scene, &set, e);
}

static int add_rigid(showing *b, const model *m, const showing_want *w, err *e)
{
    const model_array *rigid = model_need(m, "node.rigid", e), *rest = rigid ? model_need(m, "node.position", e) : NULL;
    const double *u;
    int64_t count = 0;
    float radius = (float)(.35 * side(m));
    if (!rest || showing_moves(w, "rigid nodes", &u, e))
        return -1;
    for (int64_t n = 0; n < rigid->rows; n++)
        count += rigid->u8[n] != 0;
    if (!count)
        return err_set(e, NULL, 0, "the model has no rigid nodes; expected a model from attach with bone in it");
    float *sphere = mem_array(4 * count, sizeof *sphere, "rigid nodes", e), *to = sphere;
    for (int64_t n = 0; sphere && n < rigid->rows; n++)
        if (rigid->u8[n]) {
            showing_place(rest->f64, u, n, to);
            to[3] = radius;
            to += 4;
        }
    b->seen |= SHOWING_RIGID;
    return sphere ? add(b, sphere, count, "rigid nodes", showing_red, e) : -1;
}

/* Centres are marks more than things: they are as large as the eye wants them, whatever the elements. */
static double mark(const showing *b, const model *m)
{
    double low[3], high[3], square = 0;
    for (int a = 0; scene_bounds(&b->scene, low, high) && a < 3; a++)
        square += (high[a] - low[a]) * (high[a] - low[a]);
    return fmax(.016 * sqrt(square), 1.2 * side(m));
}

static int add_centres(showing *b, const model *m, err *e)
{
    const model_array *centre = model_need(m, "muscle.centre", e);
    int64_t count = 0;
    float *sphere = centre ? mem_array(4 * centre->rows, sizeof *sphere, "contraction centres", e) : NULL;
    double radius = mark(b, m);
    if (!sphere)
        return -1;
    for (int64_t n = 0; n < centre->rows; n++) {
        const double *at = &centre->f64[3 * n];
        if (!isfinite(at[0]) || !isfinite(at[1]) || !isfinite(at[2]))
            continue;
        showing_place(centre->f64, NULL, n, &sphere[4 * count]);
        sphere[4 * count++ + 3] = (float)radius;
    }
    if (!count) {
        free(sphere);
        return err_set(e, NULL, 0, "no muscle has a contraction centre; expected rigid nodes in one");
    }
    b->seen |= SHOWING_CENTRES;
    b->marks = b->scene.sphere_sets;
    b->marked = true;
    return add(b, sphere, count, "contraction centres", showing_centre, e);
}

int showing_spheres(showing *b, const model *m, const showing_want *want, err *e)
{
    if (want->things & SHOWING_RIGID && add_rigid(b, m, want, e))
        return -1;
    return want->things & SHOWING_CENTRES ? add_centres(b, m, e) : 0;
}
