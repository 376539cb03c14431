/* An OBJ of any bytes is read or refused; what was read is written again the same, and with every vertex moved it is
 * still an OBJ of as many vertices, whose polygons cut into triangles.
 */
#include "surface/obj.h"
#include "surface/triangulate.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static int read_bytes(obj *o, const void *bytes, size_t size)
{
    err e = {0};
    in *s = in_memory(bytes, size, "fuzz.obj", &e);
    int code = s ? obj_read(o, s, &e) : -1;
    in_close(s);
    if ((code != 0) != (e.status != 0))
        abort();
    return code;
}

/* As it was, to the byte. */
static void write_same(const obj *o)
{
    err e = {0};
    out *to = out_memory(&e);
    size_t size;
    if (!to)
        abort();
    obj_write(o, o->position, o->normal, to);
    const unsigned char *bytes = out_bytes(to, &size);
    if ((int64_t)size != o->size || memcmp(bytes, o->text, size))
        abort();
    out_discard(to);
}

static void write_moved(const obj *o)
{
    err e = {0};
    obj again;
    size_t size;
    out *to = out_memory(&e);
    double *moved = calloc(3 * (size_t)o->vertices + 1, sizeof *moved);
    if (!to || !moved)
        abort();
    for (int64_t i = 0; i < 3 * o->vertices; i++)
        moved[i] = o->position[i] / 2 + 1;
    obj_write(o, moved, NULL, to);
    const unsigned char *bytes = out_bytes(to, &size);
    if (read_bytes(&again, bytes, size) || again.vertices != o->vertices || again.corners != o->corners ||
        again.normals != o->normals)
        abort();
    obj_free(&again);
    free(moved);
    out_discard(to);
}

static void cut(const obj *o)
{
    err e = {0};
    for (int64_t f = 0; f < o->faces; f++) {
        int64_t count = o->face_start[f + 1] - o->face_start[f];
        if (count < 3)
            continue;
        int32_t *triangle = malloc(3 * (size_t)(count - 2) * sizeof *triangle);
        if (!triangle || triangulate(o->position, o->corner_vertex + o->face_start[f], count, triangle, &e))
            abort();
        for (int64_t i = 0; i < 3 * (count - 2); i++)
            if (triangle[i] < 0 || triangle[i] >= count)
                abort();
        free(triangle);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    obj o;
    if (read_bytes(&o, bytes, size))
        return 0;
    write_same(&o);
    write_moved(&o);
    cut(&o);
    obj_free(&o);
    return 0;
}
