#include "base/mem.h"
#include "base/path.h"
#include "mesh/rigid_body.h"
#include "render/showing_parts.h"
#include "surface/obj.h"
#include "volume/body.h"

#include <stdlib.h>
#include <string.h>

/* Polygons as fans of triangles; points and lines are nothing to be seen. */
static int64_t triangles(const obj *o, uint32_t *to)
{
    int64_t count = 0;
    for (int64_t f = 0; f < o->faces; f++)
        for (int64_t k = o->face_start[f] + 2; k < o->face_start[f + 1]; k++, count++)
            if (to) {
                to[3 * count] = (uint32_t)o->corner_vertex[o->face_start[f]];
                to[3 * count + 1] = (uint32_t)o->corner_vertex[k - 1];
                to[3 * count + 2] = (uint32_t)o->corner_vertex[k];
            }
    return count;
}

/* In the volume's frame, which is the model's: the OBJ's positions become so too; moved: how its rigid body
 * has moved. */
static int make_mesh(scene_mesh *mesh, obj *o, const body *all, const body_part *part, const pose *moved, err *e)
{
    static const float colour[3] = {.55F, .42F, .35F};
    *mesh = (scene_mesh){.corners = 3, .vertices = o->vertices, .faces = triangles(o, NULL)};
    memcpy(mesh->colour, colour, sizeof colour);
    mesh->label = mem_text(part->file, e);
    mesh->position = mem_array(3 * o->vertices, sizeof *mesh->position, "a surface", e);
    mesh->corner = mem_array(3 * mesh->faces, sizeof *mesh->corner, "a surface", e);
    if (!mesh->label || !mesh->position || !mesh->corner)
        return -1;
    triangles(o, mesh->corner);
    body_place(all, part, o->position, o->vertices);
    for (int64_t v = 0; part->rigid && v < o->vertices; v++)
        pose_apply(moved, o->position + 3 * v, o->position + 3 * v);
    for (int64_t i = 0; i < 3 * o->vertices; i++)
        mesh->position[i] = (float)o->position[i];
    return scene_smooth(mesh, 40, e);
}

static int show_part(showing *b, const model *m, const showing_want *want, const body *all, const body_part *part,
                     err *e)
{
    scene_mesh mesh = {0};
    obj o = {0};
    const int32_t rigid = part->rigid ? rigid_body_find(m, part->rigid, want->body, part->line, e) : 0;
    if (rigid < 0)
        return -1;
    const pose moved = rigid_body_pose(part->rigid ? want->moved : NULL, rigid);
    char *path = path_beside(want->body, part->file, want->body, e);
    in *s = path ? in_open(path, e) : NULL;
    free(path);
    int failed = !s || obj_read(&o, s, e) || make_mesh(&mesh, &o, all, part, &moved, e) ? -1 : 0;
    if (failed)
        scene_mesh_free(&mesh);
    else
        failed = showing_add(b, &mesh, NULL, e);
    in_close(s);
    obj_free(&o);
    return failed;
}

int showing_body(showing *b, const model *m, const showing_want *want, err *e)
{
    body all = {0};
    if (!want->body)
        return 0;
    int failed = body_open(&all, want->body, e);
    for (int i = 0; !failed && i < all.parts; i++)
        failed = show_part(b, m, want, &all, &all.part[i], e);
    body_free(&all);
    return failed;
}
