#include "base/mem.h"
#include "cli/numbered.h"
#include "render/placed.h"
#include "render/showing_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void put_face(scene_mesh *mesh, const placed *p, int column, int row)
{
    const int64_t face = mesh->faces++;
    const int64_t pixel = (int64_t)p->channels * ((int64_t)row * p->columns + column);
    const uint32_t across = (uint32_t)p->columns + 1, first = (uint32_t)row * across + (uint32_t)column;
    const uint32_t corner[4] = {first, first + 1, first + across + 1, first + across};
    uint8_t srgb[3];
    for (int k = 0; k < 3; k++)
        srgb[k] = p->pixel[pixel + (p->channels == 3 ? k : 0)];
    memcpy(mesh->corner + 4 * face, corner, sizeof corner);
    showing_linear(srgb, mesh->face_colour + 3 * face);
}

/* A quadrilateral a pixel; around a fan there is none. */
static int make_mesh(scene_mesh *mesh, const placed *p, err *e)
{
    const int64_t across = p->columns + 1, pixels = (int64_t)p->columns * p->rows;
    *mesh = (scene_mesh){.corners = 4, .vertices = across * (p->rows + 1)};
    mesh->label = mem_text("the slice", e);
    mesh->position = mem_array(3 * mesh->vertices, sizeof *mesh->position, "a slice", e);
    mesh->corner = mem_array(4 * pixels, sizeof *mesh->corner, "a slice", e);
    mesh->face_colour = mem_array(3 * pixels, sizeof *mesh->face_colour, "a slice", e);
    if (!mesh->label || !mesh->position || !mesh->corner || !mesh->face_colour)
        return -1;
    for (int64_t i = 0; i < mesh->vertices; i++) {
        const int64_t c = i % across, r = i / across;
        for (int a = 0; a < 3; a++)
            mesh->position[3 * i + a] =
                (float)(p->origin[a] + p->column[a] * ((double)c - .5) + p->row[a] * ((double)r - .5));
    }
    for (int row = 0; row < p->rows; row++)
        for (int column = 0; column < p->columns; column++)
            if (placed_shows(p, column, row))
                put_face(mesh, p, column, row);
    return 0;
}

/* The file for the frame, where the name is a pattern. The caller frees it. */
static char *slice_file(const showing_want *want, err *e)
{
    numbered names;
    if (!strchr(want->slice, '%'))
        return mem_text(want->slice, e);
    if (numbered_of(&names, want->slice, "", e))
        return NULL;
    return numbered_name(&names, want->moved ? want->moved->index : 0, e);
}

int showing_slice(showing *b, const showing_want *want, err *e)
{
    placed p = {0};
    scene_mesh mesh = {0};
    if (!want->slice)
        return 0;
    char *file = slice_file(want, e);
    in *s = file ? in_open(file, e) : NULL;
    free(file);
    int failed = !s || placed_read(&p, s, e) || make_mesh(&mesh, &p, e) ? -1 : 0;
    if (failed)
        scene_mesh_free(&mesh);
    else
        failed = showing_add(b, &mesh, NULL, e);
    in_close(s);
    placed_free(&p);
    return failed;
}
