#include "plan/stand.h"

#include "surface/scale.h"

#include <math.h>
#include <string.h>

/* ---- what there is */

int stand_volume(stand *s, const char *path, err *e)
{
    s->has_volume = true;
    return volume_load(&s->image, path, NULL, e);
}

int stand_surface(stand *s, const char *path, num_unit unit, notes *warnings, err *e)
{
    in *source = in_open(path, e);
    const int failed = !source || obj_read(&s->file, source, e) ? -1 : 0;
    in_close(source);
    if (failed || trimesh_of(&s->mesh, &s->file, scale_of(unit), e))
        return -1;
    obj_notes(&s->file, warnings);
    if (!s->mesh.triangles)
        return err_set(e, s->file.name, 0, "no polygon; expected a surface");
    s->has_surface = true;
    s->tree = triangle_tree_create(s->mesh.position, s->mesh.corner, s->mesh.triangles, e);
    if (!s->tree ||
        pseudonormal_of(&s->normal, s->mesh.position, s->mesh.vertices, s->mesh.corner, s->mesh.triangles, e))
        return -1;
    if (!s->normal.border && s->normal.volume < 0)
        notes_add(warnings, "%s faces inward: its normals are taken the other way", s->file.name);
    return 0;
}

void stand_free(stand *s)
{
    volume_free(&s->image);
    if (s->tree)
        triangle_tree_destroy(s->tree);
    pseudonormal_free(&s->normal);
    trimesh_free(&s->mesh);
    obj_free(&s->file);
    *s = (stand){.unit = 0};
}

/* ---- numbers */

static num_unit unit_of(const stand *s)
{
    return s->unit ? s->unit : num_unit_of("m");
}

int stand_length(const stand *s, const keyfile *k, const char *text, double *to, err *e)
{
    num_length length;
    if (num_length_of(text, &length))
        return keyfile_error(k, e, "'%.100s': expected a length, such as 4mm", text);
    *to = num_length_in(length, unit_of(s), num_unit_of("m"));
    return 0;
}

int stand_lengths(const stand *s, const keyfile *k, const char *text, double to[3], err *e)
{
    num_length list[3];
    if (num_lengths_of(text, list, 3) != 3)
        return keyfile_error(k, e, "'%.100s': expected three lengths X,Y,Z", text);
    for (int a = 0; a < 3; a++)
        to[a] = num_length_in(list[a], unit_of(s), num_unit_of("m"));
    return 0;
}

/* ---- vectors */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Makes its length 1. Returns whether it had one. */
static bool unit(double v[3])
{
    const double most = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (!(most > 0) || !isfinite(most))
        return false;
    for (int a = 0; a < 3; a++)
        v[a] /= most;
    const double length = sqrt(dot(v, v));
    for (int a = 0; a < 3; a++)
        v[a] /= length;
    return true;
}

static void cross(const double a[3], const double b[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* ---- places */

/* A place, and, where it is on the surface, what of that it is on. */
typedef struct spot {
    double at[3]; /* m */
    bool is_on_surface;
    triangle_hit hit;
} spot;

static int need(const keyfile *k, bool has, const char *text, const char *option, err *e)
{
    return has ? 0 : keyfile_error(k, e, "'%.100s': expected --%s, which has it", text, option);
}

static void take_nearest(const stand *s, const double q[3], spot *to)
{
    to->hit = triangle_tree_nearest(s->tree, q, -1);
    to->is_on_surface = true;
    memcpy(to->at, to->hit.point, sizeof to->at);
}

static int take_vertex(const stand *s, const keyfile *k, const char *text, spot *to, err *e)
{
    int64_t number;
    if (num_int(text, 1, s->mesh.vertices, &number))
        return keyfile_error(k, e, "vertex:%.100s: expected a number from 1 to %lld", text,
                             (long long)s->mesh.vertices);
    take_nearest(s, s->mesh.position + 3 * (number - 1), to);
    return 0;
}

static int take_voxel(const stand *s, const keyfile *k, const char *text, spot *to, err *e)
{
    double voxel[3];
    if (num_list(text, voxel, 3) != 3)
        return keyfile_error(k, e, "voxel:%.100s: expected three numbers I,J,K", text);
    for (int a = 0; a < 3; a++)
        if (!(voxel[a] >= -.5 && voxel[a] <= (double)s->image.size[a] - .5))
            return keyfile_error(k, e, "voxel:%.100s is outside of the volume; expected at most %lld,%lld,%lld", text,
                                 (long long)s->image.size[0] - 1, (long long)s->image.size[1] - 1,
                                 (long long)s->image.size[2] - 1);
    volume_place(&s->image, voxel, to->at);
    return 0;
}

static int take_place(const stand *s, const keyfile *k, const char *text, spot *to, err *e)
{
    double q[3];
    *to = (spot){.is_on_surface = false};
    if (!strncmp(text, "voxel:", 6))
        return need(k, s->has_volume, text, "volume", e) ? -1 : take_voxel(s, k, text + 6, to, e);
    if (!strncmp(text, "vertex:", 7))
        return need(k, s->has_surface, text, "surface", e) ? -1 : take_vertex(s, k, text + 7, to, e);
    if (strncmp(text, "surface:", 8) != 0)
        return stand_lengths(s, k, text, to->at, e);
    if (need(k, s->has_surface, text, "surface", e) || stand_lengths(s, k, text + 8, q, e))
        return -1;
    take_nearest(s, q, to);
    return 0;
}

/* ---- axes */

/* Into the surface where the spot is on it: against the pseudonormal of what it lies on, which faces outward. */
static int take_normal(const stand *s, const keyfile *k, const spot *at, double axis[3], err *e)
{
    if (!at->is_on_surface)
        return keyfile_error(k, e,
                             "the axis 'normal' of a place that is not on a surface; expected into AXIS, or a "
                             "place surface:X,Y,Z or vertex:N");
    const double sign = !s->normal.border && s->normal.volume < 0 ? 1 : -1;
    pseudonormal_at(&s->normal, &at->hit, axis);
    for (int a = 0; a < 3; a++)
        axis[a] *= sign;
    return unit(axis) ? 0 : keyfile_error(k, e, "the surface has no normal there; expected into AXIS");
}

/* "x", "-k": of the model, or of the volume. Whether it is one. */
static bool is_named(const char *text, int *which, double *sign)
{
    static const char names[] = "xyzijk";
    *sign = *text == '-' ? -1 : 1;
    text += *text == '-';
    const char *at = *text && !text[1] ? strchr(names, *text) : NULL;
    *which = at ? (int)(at - names) : -1;
    return at != NULL;
}

static int take_axis(const stand *s, const keyfile *k, const char *text, const spot *at, double axis[3], err *e)
{
    int which;
    double sign;
    if (!strcmp(text, "normal"))
        return take_normal(s, k, at, axis, e);
    if (is_named(text, &which, &sign)) {
        if (which > 2 && need(k, s->has_volume, text, "volume", e))
            return -1;
        for (int a = 0; a < 3; a++)
            axis[a] = sign * (which > 2 ? s->image.axis[which - 3][a] : a == which);
        unit(axis);
        return 0;
    }
    if (num_list(text, axis, 3) != 3 || !unit(axis))
        return keyfile_error(k, e,
                             "'%.100s': expected an axis: normal, x, y, z, i, j, k, one of these with - before "
                             "it, or X,Y,Z",
                             text);
    return 0;
}

/* The columns are made to lie across the axis into the tissue. */
static int turn_to(const keyfile *k, const double into[3], const double columns[3], pose *to, err *e)
{
    double axis[3][3];
    const double along = dot(into, columns);
    for (int a = 0; a < 3; a++) {
        axis[2][a] = into[a];
        axis[0][a] = columns[a] - along * into[a];
    }
    if (!(dot(axis[0], axis[0]) > 1e-6) || !unit(axis[0]))
        return keyfile_error(k, e, "the columns lie along the axis into the tissue; expected them across it");
    cross(axis[2], axis[0], axis[1]);
    pose_axes(axis, to->quaternion);
    return 0;
}

/* Where no columns are named: x, or y, where the axis into the tissue is nearly that. */
static void usual_columns(const double into[3], double columns[3])
{
    const bool is_along = fabs(into[0]) > .9;
    columns[0] = !is_along;
    columns[1] = is_along;
    columns[2] = 0;
}

int stand_take(const stand *s, const keyfile *k, int at, int *next, pose *to, err *e)
{
    spot here;
    double into[3] = {0}, columns[3] = {0};
    bool has_into = false, has_columns = false;
    if (at >= k->count)
        return keyfile_error(k, e, "%s without a place; expected X,Y,Z, voxel:I,J,K, surface:X,Y,Z or vertex:N",
                             k->word[0]);
    if (take_place(s, k, k->word[at], &here, e))
        return -1;
    for (at++; at + 1 < k->count; at += 2) {
        const bool is_into = !strcmp(k->word[at], "into"), is_columns = !strcmp(k->word[at], "columns");
        if (!is_into && !is_columns)
            break;
        if (take_axis(s, k, k->word[at + 1], &here, is_into ? into : columns, e))
            return -1;
        has_into |= is_into;
        has_columns |= is_columns;
    }
    if (!has_into && take_normal(s, k, &here, into, e))
        return -1;
    if (!has_columns)
        usual_columns(into, columns);
    memcpy(to->position, here.at, sizeof here.at);
    *next = at;
    return turn_to(k, into, columns, to, e);
}
