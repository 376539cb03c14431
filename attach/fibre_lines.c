#include "fibre_lines.h"

#include "attach/shape/line_field.h"
#include "base/mem.h"
#include "base/near.h"
#include "mesh/lattice.h"
#include "surface/scale.h"
#include "surface/surface.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 256 }; /* elements */

typedef struct work {
    const model *m;
    const line_field *lines;
    bool *wanted; /* volumes */
    const double *position;
    const int32_t *node, *volume, *mix; /* elements; mix may be NULL */
    int32_t columns;
    const float *normal;     /* elements x 3; NULL: there are none */
    float *fibre, *mixfibre; /* elements x 3; mixfibre may be NULL */
    bool by_normal;          /* only elements that have a normal */
} work;

/* ---- the file */

/* The lines' segments: end has 6 numbers of each, m, and belongs to the caller. Returns how many, or -1 with e. */
static int64_t take_lines(const obj *o, double scale, double **end, err *e)
{
    int64_t count = 0;
    *end = mem_array(6 * o->faces, sizeof **end, "lines", e);
    for (int64_t f = 0; *end && f < o->faces; f++) {
        const int32_t *corner = &o->corner_vertex[o->face_start[f]];
        if (o->face_start[f + 1] - o->face_start[f] != 2)
            continue;
        for (int k = 0; k < 6; k++)
            (*end)[6 * count + k] = surface_metres(o->position[3 * (int64_t)corner[k / 3] + k % 3], scale);
        count++;
    }
    return *end ? count : -1;
}

static line_field *read_lines(const char *file, const model *m, double step, err *e)
{
    obj o = {0};
    double *end = NULL;
    line_field *made = NULL;
    const num_unit unit = scale_unit(NULL, m, e);
    in *source = unit ? in_open(file, e) : NULL;
    const int64_t count = source && !obj_read(&o, source, e) ? take_lines(&o, scale_of(unit), &end, e) : -1;
    if (count == 0)
        err_set(e, in_name(source), 0, "no lines; expected lines of l, each with two vertices or more");
    else if (count > 0)
        made = line_field_create(end, count, step, e);
    in_close(source);
    obj_free(&o);
    free(end);
    return made;
}

/* ---- volumes */

/* Wants the volumes that a name stands for. */
static int want_named(work *w, const char *name, err *e)
{
    const model_array *names = model_find(w->m, "volume.name"), *muscle = model_find(w->m, "volume.muscle");
    bool any = false;
    for (int64_t v = 0; v < names->rows; v++) {
        if (!surface_in_group(names->str[v], name))
            continue;
        any = true;
        w->wanted[v] = !muscle || !muscle->u8[v];
        if (!w->wanted[v])
            return err_option(e, "--fibre-lines-in",
                              "%.200s is a muscle, whose fibres --fibre is for; expected a volume "
                              "that is none",
                              names->str[v]);
    }
    return any ? 0
               : near_option(e, "--fibre-lines-in", "volume", name, (const char *const *)names->str,
                             names->rows < INT32_MAX ? (int)names->rows : INT32_MAX);
}

static int want_list(work *w, const char *list, err *e)
{
    char name[MODEL_NAME];
    for (const char *p = list; *p;) {
        const size_t n = strcspn(p, ",");
        snprintf(name, sizeof name, "%.*s", (int)(n < sizeof name ? n : 0), p);
        if (*name && want_named(w, name, e))
            return -1;
        p += n + (p[n] == ',');
    }
    return 0;
}

/* All that are no muscles, but only in elements with a normal. */
static int want_layers(work *w, err *e)
{
    const model_array *muscle = model_find(w->m, "volume.muscle");
    w->by_normal = true;
    if (!w->normal)
        return err_option(e, "--fibre-lines",
                          "the model has no layers of skin (element.normal); expected a model of "
                          "voxelise --layers, or volumes by --fibre-lines-in");
    for (int64_t v = 0; v < model_count(w->m, "volume"); v++)
        w->wanted[v] = !muscle || !muscle->u8[v];
    return 0;
}

static int choose_volumes(work *w, const opt_list *volumes, err *e)
{
    w->wanted = mem_array(model_count(w->m, "volume"), sizeof *w->wanted, "volumes", e);
    if (!w->wanted)
        return -1;
    if (!volumes->count)
        return want_layers(w, e);
    for (int i = 0; i < volumes->count; i++)
        if (want_list(w, volumes->value[i], e))
            return -1;
    return 0;
}

/* ---- elements */

static bool has_normal(const work *w, int64_t element)
{
    const float *n = w->normal ? w->normal + 3 * element : NULL;
    return n && (n[0] != 0 || n[1] != 0 || n[2] != 0);
}

static void set_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    const work *w = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        const bool first = w->wanted[w->volume[i]], second = w->mix && w->mix[i] >= 0 && w->wanted[w->mix[i]];
        double centre[3] = {0}, normal[3] = {0}, along[3];
        if ((!first && !second) || (w->by_normal && !has_normal(w, i)))
            continue;
        for (int k = 0; k < 3 * w->columns; k++)
            centre[k % 3] += w->position[3 * (int64_t)w->node[w->columns * i + k / 3] + k % 3] / w->columns;
        for (int a = 0; a < 3 && w->normal; a++)
            normal[a] = (double)w->normal[3 * i + a];
        line_field_at(w->lines, centre, normal, along);
        for (int a = 0; a < 3; a++) {
            if (first)
                w->fibre[3 * i + a] = (float)along[a];
            if (second)
                w->mixfibre[3 * i + a] = (float)along[a];
        }
    }
}

/* What muscle_fibres and voxelise left in the model. */
static void find_arrays(work *w)
{
    const model *m = w->m;
    const model_array *node = model_find(m, "element.node"), *mix = model_find(m, "element.mix");
    const model_array *normal = model_find(m, "element.normal"), *mixfibre = model_find(m, "element.mixfibre");
    w->position = model_find(m, "node.position")->f64;
    w->node = node->i32;
    w->columns = node->columns;
    w->volume = model_find(m, "element.volume")->i32;
    w->mix = mix ? mix->i32 : NULL;
    w->normal = normal ? normal->f32 : NULL;
    w->fibre = model_find(m, "element.fibre")->f32;
    w->mixfibre = mixfibre ? mixfibre->f32 : NULL;
}

int fibre_lines_apply(model *m, const char *file, const opt_list *volumes, pool *threads, err *e)
{
    work w = {.m = m};
    lattice grid;
    line_field *lines = NULL;
    find_arrays(&w);
    int rc = lattice_of(m, &grid, e) || choose_volumes(&w, volumes, e) ? -1 : 0;
    if (!rc &&
        !(w.lines = lines = read_lines(file, m, fmin(grid.spacing[0], fmin(grid.spacing[1], grid.spacing[2])) / 2, e)))
        rc = -1;
    if (!rc)
        pool_run(threads, model_count(m, "element"), CHUNK, set_some, &w);
    line_field_free(lines);
    free(w.wanted);
    return rc;
}
