#include "console/around.h"

#include "base/mem.h"
#include "base/path.h"
#include "mesh/rigid_body.h"

#include <stdlib.h>
#include <string.h>

/* Without body.txt: what there is, in millimetres. */
static int place_plainly(body *b, const console_case *is, err *e)
{
    const char *const paths[] = {is->skin, is->bones};
    *b = (body){.volume = pose_none()};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        if (!paths[i])
            continue;
        char *file = mem_text(paths[i] + path_folder(paths[i]), e);
        if (!file || MEM_ROOM(&b->part, &b->room, b->parts + 1, "the parts of a body", e)) {
            free(file);
            return -1;
        }
        b->part[b->parts++] = (body_part){.file = file, .scale = 1e-3, .place = pose_none()};
    }
    return 0;
}

static int read_places(body *b, const console_case *is, err *e)
{
    if (!is->body)
        return place_plainly(b, is, e);
    return body_open(b, is->body, e);
}

/* One that the model has already stays as it is there. */
static int add_surface(const around *a, const body_part *part, const char *path, model *m, err *e)
{
    char name[SURFACE_NAME_MOST + 1];
    obj o = {0};
    surface_name(path, name, sizeof name);
    if (surface_there(m, name))
        return 0;
    in *s = in_open(path, e);
    int failed = s ? obj_read(&o, s, e) : -1;
    in_close(s);
    if (!failed) {
        body_place(&a->places, part, o.position, o.vertices);
        failed = surface_add(m, name, &o, 1, e);
    }
    obj_free(&o);
    return failed;
}

/* body.txt names files beside it; without it the case knows their paths. */
static int add_part(const around *a, const body_part *part, const console_case *is, model *m, err *e)
{
    const bool is_skin = !is->body && is->skin && body_find(&a->places, is->skin) == part;
    char *path =
        is->body ? path_beside(is->body, part->file, is->body, e) : mem_text(is_skin ? is->skin : is->bones, e);
    const int failed = path ? add_surface(a, part, path, m, e) : -1;
    free(path);
    return failed;
}

int around_read(around *a, const console_case *is, model *m, err *e)
{
    *a = (around){.body_path = is->body};
    if (read_places(&a->places, is, e))
        return -1;
    for (int i = 0; i < a->places.parts; i++)
        if (add_part(a, &a->places.part[i], is, m, e))
            return -1;
    if (is->skin && body_find(&a->places, is->skin)) {
        a->skin_path = is->skin;
        surface_name(is->skin, a->skin, sizeof a->skin);
    }
    return 0;
}

int around_attach(const around *a, const model *m, geometry *scene, err *e)
{
    for (int i = 0; i < a->places.parts; i++) {
        const body_part *part = &a->places.part[i];
        char name[SURFACE_NAME_MOST + 1];
        if (!part->rigid)
            continue;
        const int32_t rigid = rigid_body_find(m, part->rigid, a->body_path, part->line, e);
        if (rigid < 0)
            return -1;
        surface_name(part->file, name, sizeof name);
        geometry_attach(scene, name, rigid);
    }
    return 0;
}

void around_free(around *a)
{
    body_free(&a->places);
    *a = (around){0};
}

pose around_pose(const around *a, const pose *at)
{
    return a->skin_path ? around_to_body(a, at) : *at;
}

pose around_to_body(const around *a, const pose *at)
{
    return a->body_path ? pose_compose(&a->places.volume, at) : *at;
}

pose around_from_body(const around *a, const pose *at)
{
    return a->body_path ? pose_relative(&a->places.volume, at) : *at;
}
