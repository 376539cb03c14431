#include "volume/volume.h"

#include "base/mem.h"
#include "base/num.h"
#include "volume/metaimage.h"
#include "volume/nrrd.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

size_t volume_type_size(volume_type t)
{
#define TYPE_SIZE(name, of, nrrd, meta, low, high) sizeof(of),
    static const size_t size[] = {VOLUME_TYPES(TYPE_SIZE)};
    return size[t];
}

void volume_free(volume *v)
{
    for (int i = 0; i < v->labels; i++)
        free(v->label[i].name);
    free(v->label);
    free(v->data);
    *v = (volume){0};
}

int volume_make(volume *v, err *e)
{
    v->data = mem_array(volume_count(v), volume_type_size(v->type), "a volume's voxels", e);
    return v->data ? 0 : -1;
}

int volume_read(volume *v, in *s, const char *path, const volume_budget *b, err *e)
{
    *v = (volume){0};
    int first = in_peek(s, e), status = -1;
    char *line;
    if (first == -2)
        return -1;
    if (first == -1)
        return err_set(e, in_name(s), 0, "no volume in it (0 bytes); expected NRRD or MetaImage");
    if (!isalpha(first))
        return err_set(e, in_name(s), 0, "is not a volume of a known format; expected NRRD or MetaImage");
    if (in_line(s, &line, NULL, e) < 0)
        return -1;
    if (nrrd_is(line))
        status = nrrd_read(v, s, path, b, e);
    else if (metaimage_is(line))
        status = metaimage_read(v, s, line, path, b, e);
    else
        err_set(e, in_name(s), 1, "'%.40s' begins no volume of a known format; expected NRRD or MetaImage", line);
    if (status)
        volume_free(v);
    return status;
}

int volume_load(volume *v, const char *path, const volume_budget *b, err *e)
{
    bool standard = !path || !strcmp(path, "-");
    *v = (volume){0};
    in *s = in_open(path, e);
    const char *file = standard ? NULL : path;
    int status = s ? volume_read(v, s, file, b, e) : -1;
    in_close(s);
    return status;
}

/* ---- memory */

double volume_memory(const volume *v)
{
    return (double)v->size[0] * (double)v->size[1] * (double)v->size[2] * (double)volume_type_size(v->type);
}

int volume_afford(const volume_budget *b, const volume *v, const char *place, err *e)
{
    char need[NUM_TEXT], most[NUM_TEXT];
    if (b && b->check && b->check(v, place, e))
        return -1;
    if (!b || !b->most)
        return 0;
    const double peak = b->peak ? b->peak(v, b->context) : volume_memory(v);
    if (peak <= (double)b->most)
        return 0;
    return err_set(e, place, 0, "%lld x %lld x %lld voxels of %d byte%s take %s of memory here; --memory allows %s",
                   (long long)v->size[0], (long long)v->size[1], (long long)v->size[2], (int)volume_type_size(v->type),
                   volume_type_size(v->type) == 1 ? "" : "s", num_size_text(peak, need),
                   num_size_text((double)b->most, most));
}

/* ---- geometry */

double volume_spacing(const volume *v, int axis)
{
    const double *a = v->axis[axis];
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

double volume_handed(const volume *v)
{
    const double *x = v->axis[0], *y = v->axis[1], *z = v->axis[2];
    return x[0] * (y[1] * z[2] - y[2] * z[1]) + x[1] * (y[2] * z[0] - y[0] * z[2]) + x[2] * (y[0] * z[1] - y[1] * z[0]);
}

int volume_check(const volume *v, const char *place, int64_t line, err *e)
{
    /* Beyond these the numbers are a slip, and their products would be too large or small to tell. */
    const double least = 1e-6, most = 1e9;
    double cube = 1;
    for (int a = 0; a < 3; a++) {
        double spacing = volume_spacing(v, a);
        if (v->size[a] < 1)
            return err_set(e, place, line, "%lld voxels along axis %d; expected 1 or more", (long long)v->size[a], a);
        if (!(spacing >= least && spacing <= most))
            return err_set(e, place, line, "voxels %g mm apart along axis %d; expected %g to %g", spacing, a, least,
                           most);
        if (!(fabs(v->origin[a]) <= most))
            return err_set(e, place, line, "an origin at %g mm; expected at most %g", v->origin[a], most);
        cube *= spacing;
    }
    if (!(fabs(volume_handed(v)) > 1e-3 * cube))
        return err_set(e, place, line, "axes that lie in a plane, or almost; expected axes that span a space");
    return 0;
}

void volume_place(const volume *v, const double voxel[3], double place[3])
{
    for (int a = 0; a < 3; a++)
        place[a] =
            (v->origin[a] + v->axis[0][a] * voxel[0] + v->axis[1][a] * voxel[1] + v->axis[2][a] * voxel[2]) / 1e3;
}

volume_finder volume_finder_of(const volume *v)
{
    volume_finder f;
    double d = volume_handed(v);
    for (int a = 0; a < 3; a++) {
        const double *y = v->axis[(a + 1) % 3], *z = v->axis[(a + 2) % 3];
        f.origin[a] = v->origin[a] / 1e3;
        for (int b = 0; b < 3; b++) {
            int c = (b + 1) % 3, n = (b + 2) % 3;
            f.row[a][b] = 1e3 * (y[c] * z[n] - y[n] * z[c]) / d;
        }
    }
    return f;
}

int64_t volume_nearest(const volume *v, const volume_finder *f, const double place[3])
{
    double at[3];
    int64_t index = 0;
    volume_voxel(f, place, at);
    for (int a = 2; a >= 0; a--) {
        double whole = floor(at[a] + .5);
        if (!(whole >= 0 && whole < (double)v->size[a]))
            return -1;
        index = index * v->size[a] + (int64_t)whole;
    }
    return index;
}

/* ---- labels */

const char *volume_label_of(const volume *v, int64_t value)
{
    for (int i = 0; i < v->labels; i++)
        if (v->label[i].value == value)
            return v->label[i].name;
    return NULL;
}

int volume_name(volume *v, int64_t value, const char *name, err *e)
{
    char *copy = mem_text(name, e);
    int at = 0;
    if (!copy)
        return -1;
    while (at < v->labels && v->label[at].value < value)
        at++;
    if (at < v->labels && v->label[at].value == value) {
        free(v->label[at].name);
        v->label[at].name = copy;
        return 0;
    }
    volume_label *more = realloc(v->label, (size_t)(v->labels + 1) * sizeof *more);
    if (!more) {
        free(copy);
        return err_memory(e, "labels");
    }
    v->label = more;
    memmove(&more[at + 1], &more[at], (size_t)(v->labels - at) * sizeof *more);
    more[at] = (volume_label){value, copy};
    v->labels++;
    return 0;
}
