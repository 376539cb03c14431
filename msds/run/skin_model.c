#include "msds/run/skin_model.h"

#include "frames/frame_queue.h"

#include <stdio.h>
#include <string.h>

int skin_model_carry(model *m, const skin_source *from, bool nameless, char name[SURFACE_NAME_MOST + 1],
                     notes *warnings, err *e)
{
    obj o = {0};
    surface there;
    const double scale = from->scale;
    in *source = in_open(from->path, e);
    int result = source ? obj_read(&o, source, e) : -1;
    in_close(source);
    if (!result)
        obj_notes(&o, warnings);
    if (!result && from->part)
        body_place(from->around, from->part, o.position, o.vertices);
    if (!result && nameless)
        surface_nameless(m, &o, scale, name, SURFACE_NAME_MOST + 1);
    else
        surface_name(from->path, name, SURFACE_NAME_MOST + 1);
    if (!result && surface_there(m, name))
        result = surface_of(m, name, &there, e) || surface_is(&there, &o, scale, e) ? -1 : 0;
    else if (!result)
        result = surface_add(m, name, &o, scale, e);
    obj_free(&o);
    return result;
}

/* Its array of a frame. */
static void array_name(const skin *s, const char *what, char to[MODEL_NAME])
{
    snprintf(to, MODEL_NAME, "%s/vertex.%s", s->shape.name, what);
}

int skin_model_offer(const skin *s, frame_choice *c, err *e)
{
    char u[MODEL_NAME], n[MODEL_NAME];
    array_name(s, "displacement", u);
    array_name(s, "normal", n);
    return frame_choice_offer(c, u, 0, e) || frame_choice_offer(c, n, 0, e) ? -1 : 0;
}

int skin_model_start(skin *s, const frame *f, err *e)
{
    char name[MODEL_NAME];
    array_name(s, "displacement", name);
    const model_array *u = frame_find(f, name);
    if (!u)
        return err_set(e, NULL, 0, "frame %lld has no %s; expected it, to go on from there, or a model without frames",
                       (long long)f->index, name);
    memcpy(s->u, u->f64, 3 * (size_t)s->vertices * sizeof *s->u);
    return 0;
}

int skin_model_put(const skin *s, frame *f, const model *m, err *e)
{
    char name[MODEL_NAME];
    array_name(s, "displacement", name);
    model_array *u = frame_queue_array(f, m, name, e);
    if (!u)
        return -1;
    memcpy(u->f64, s->u, 3 * (size_t)s->vertices * sizeof *s->u);
    array_name(s, "normal", name);
    model_array *n = frame_queue_array(f, m, name, e);
    if (!n)
        return -1;
    skin_normals(s, n->f64);
    return 0;
}
