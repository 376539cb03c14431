#include "surface/surface.h"

#include "base/chars.h"
#include "model/known.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* "NAME/what" into full, of MODEL_NAME bytes. Returns 0, or -1 where no name is that long. */
static int join(const char *name, const char *what, char *full)
{
    int n = snprintf(full, MODEL_NAME, "%s/%s", name, what);
    return n < 0 || n >= MODEL_NAME ? -1 : 0;
}

model_array *surface_part(const model *m, const char *name, const char *what)
{
    char full[MODEL_NAME];
    return join(name, what, full) || known_users(full) ? NULL : model_find(m, full);
}

bool surface_there(const model *m, const char *name)
{
    char axis[MODEL_NAME];
    return !join(name, "vertex", axis) && !known_users(axis) && model_count(m, axis) >= 0;
}

/* The same, or NULL with e filled. */
static model_array *need(const model *m, const char *name, const char *what, err *e)
{
    model_array *a = surface_part(m, name, what);
    if (!a)
        err_set(e, NULL, 0, "the model has no %.250s/%s; expected a model from voxelise or bind", name, what);
    return a;
}

int surface_of(const model *m, const char *name, surface *s, err *e)
{
    const model_array *position = need(m, name, "vertex.position", e);
    const model_array *start = position ? need(m, name, "face.start", e) : NULL;
    const model_array *group = start ? need(m, name, "face.group", e) : NULL;
    const model_array *vertex = group ? need(m, name, "face.vertex", e) : NULL;
    const model_array *group_name = vertex ? need(m, name, "group.name", e) : NULL;
    if (!group_name)
        return -1;
    *s = (surface){.name = name,
                   .position = position->f64,
                   .vertices = position->rows,
                   .start = start->i64,
                   .group = group->i32,
                   .faces = start->rows,
                   .vertex = vertex->i32,
                   .corners = vertex->rows,
                   .group_name = group_name->str,
                   .groups = group_name->rows};
    return 0;
}

static int add_axis(model *m, const char *name, const char *what, int64_t count, err *e)
{
    char full[MODEL_NAME];
    if (join(name, what, full))
        return err_set(e, NULL, 0, "surface '%.60s': its name is too long", name);
    return model_axis_add(m, full, count, e);
}

static model_array *add_array(model *m, const char *name, const char *what, err *e)
{
    char full[MODEL_NAME];
    if (!join(name, what, full))
        return model_add(m, full, e);
    err_set(e, NULL, 0, "surface '%.60s': its name is too long", name);
    return NULL;
}

static int add_positions(model *m, const char *name, const obj *o, double scale, err *e)
{
    model_array *a = add_array(m, name, "vertex.position", e);
    for (int64_t i = 0; a && i < 3 * o->vertices; i++)
        a->f64[i] = surface_metres(o->position[i], scale);
    return a ? 0 : -1;
}

static int add_faces(model *m, const char *name, const obj *o, err *e)
{
    model_array *start = add_array(m, name, "face.start", e);
    if (!start)
        return -1;
    if (o->faces)
        memcpy(start->i64, o->face_start, (size_t)o->faces * sizeof *start->i64);
    model_array *group = add_array(m, name, "face.group", e);
    if (!group)
        return -1;
    if (o->faces)
        memcpy(group->i32, o->face_group, (size_t)o->faces * sizeof *group->i32);
    model_array *vertex = add_array(m, name, "face.vertex", e);
    if (!vertex)
        return -1;
    if (o->corners)
        memcpy(vertex->i32, o->corner_vertex, (size_t)o->corners * sizeof *vertex->i32);
    return 0;
}

static int add_groups(model *m, const char *name, const obj *o, err *e)
{
    model_array *a = add_array(m, name, "group.name", e);
    if (!a)
        return -1;
    for (int32_t g = 0; g < o->groups; g++)
        if (model_set_text(a, g, o->group[g], e))
            return -1;
    return 0;
}

int surface_add(model *m, const char *name, const obj *o, double scale, err *e)
{
    if (add_axis(m, name, "vertex", o->vertices, e) || add_axis(m, name, "face", o->faces, e) ||
        add_axis(m, name, "corner", o->corners, e) || add_axis(m, name, "group", o->groups, e))
        return -1;
    return add_positions(m, name, o, scale, e) || add_faces(m, name, o, e) || add_groups(m, name, o, e) ? -1 : 0;
}

static bool is_at(const double *coordinates, double scale, const double *metres)
{
    for (int a = 0; a < 3; a++)
        if (surface_metres(coordinates[a], scale) != metres[a])
            return false;
    return true;
}

int surface_is(const surface *s, const obj *o, double scale, err *e)
{
    if (s->vertices != o->vertices)
        return err_set(e, o->name, 0,
                       "%" PRId64 " vertices, but the model's surface %s has %" PRId64 "; expected the same OBJ",
                       o->vertices, s->name, s->vertices);
    for (int64_t v = 0; v < o->vertices; v++) {
        const double *p = &o->position[3 * v], *q = &s->position[3 * v];
        if (is_at(p, scale, q))
            continue;
        return err_set(e, o->name, obj_line_number(o, o->v[v].from),
                       "vertex %" PRId64
                       " is %.9g %.9g %.9g, but %.9g %.9g %.9g in the model's surface %s; expected the same "
                       "OBJ in the same unit",
                       v + 1, p[0], p[1], p[2], q[0] / scale, q[1] / scale, q[2] / scale, s->name);
    }
    return 0;
}

void surface_name(const char *path, char *name, size_t size)
{
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    size_t n = strlen(base);
    if (!strcmp(path, "-"))
        base = "stdin", n = 5;
    if (n > 3 && !strcasecmp(base + n - 3, ".gz"))
        n -= 3;
    if (n > 4 && !strncasecmp(base + n - 4, ".obj", 4))
        n -= 4;
    n = n > SURFACE_NAME_MOST ? SURFACE_NAME_MOST : n;
    n = n < size ? n : size - 1;
    for (size_t i = 0; i < n; i++) {
        char c = base[i];
        bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.';
        name[i] = plain ? c : '_';
    }
    name[n] = 0;
    if (known_users(name))
        name[1] = '_';
}

void surface_nameless(const model *m, const obj *o, double scale, char *name, size_t size)
{
    surface s;
    for (int at = 0; model_surface(m, &at, name, size);) {
        err ignored = {0};
        if (!surface_of(m, name, &s, &ignored) && !surface_is(&s, o, scale, &ignored))
            return;
    }
    int number = 1;
    do
        snprintf(name, size, "surface_%d", number++);
    while (surface_there(m, name));
}

static bool matches(const char *name, size_t n, const char *pattern)
{
    size_t m = strlen(pattern);
    if (m && pattern[m - 1] == '*')
        return chars_means(pattern, m - 1, name, n, CHARS_ANY_CASE | CHARS_BEGINS);
    return chars_means(pattern, m, name, n, CHARS_ANY_CASE);
}

bool surface_in_group(const char *names, const char *pattern)
{
    while (*names) {
        size_t n = strcspn(names, " ");
        if (n && matches(names, n, pattern))
            return true;
        names += n + (names[n] != 0);
    }
    return false;
}
