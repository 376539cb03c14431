/* sinew-deform: an OBJ as the results of a model move it. */
#include "base/mem.h"
#include "base/num.h"
#include "base/pool.h"
#include "bind/normals.h"
#include "bind/pointcache.h"
#include "cli/frames.h"
#include "cli/numbered.h"
#include "cli/outs.h"
#include "cli/tool.h"
#include "mesh/bone.h"
#include "mesh/bound.h"
#include "model/source.h"
#include "surface/scale.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FORMAT_OBJ, FORMAT_PC2 };

struct options {
    opt_common common;
    const char *frame, *unit;
    opt_lengths within;
    int format;
    bool salvage;
};

#define TO(field) offsetof(struct options, field)
static const opt option_list[] = {
    {OPT_INPUT, 0, "frame", FRAMES_ARG, OPT_TEXT, TO(frame), 0, 0, NULL, 0,
     "all: a file each, -o f_%04d.obj [default last, of pc2 all]"},
    {OPT_ACTION, 0, "within", "D", OPT_LENGTHS, TO(within), 0, 1, NULL, 0,
     "do not move vertices further than D outside the elements [length; default move all]"},
    {OPT_RESULT, 0, "format", "obj|pc2", OPT_CHOICE, TO(format), 0, 0, "obj|pc2", 0,
     "OBJ, or a point cache for Blender [default obj]"},
    {OPT_INPUT, 0, "unit", NUM_UNITS_CHOICES, OPT_TEXT, TO(unit), 0, 0, NULL, 0,
     "unit of the OBJ [default the model's]"},
    {OPT_INPUT, 0, "salvage", NULL, OPT_FLAG, TO(salvage), 0, 0, NULL, OPT_OUTPUT,
     "use the complete frames of an incomplete stream"},
    {0},
};

static const opt_tool table = {
    .name = "sinew-deform",
    .command = "sinew deform",
    .usage = "[options] surface.obj < result > deformed.obj",
    .purpose = "Moves a bound OBJ surface as the results of a model say.",
    .note = "Lengths are in m, unless they have a suffix (" NUM_UNITS_LIST "), e.g. 5cm.",
    .example = "sinew deform face.obj < smile.sinew > smile.obj",
    .operands = "surface.obj",
    .operands_min = 1,
    .operands_max = 1,
    .threaded = true,
    .options = option_list,
};

/* Which frames, and what becomes of them. */
typedef struct plan {
    const tool *t;
    frames_which frames;
    const char *asked; /* --frame, or what it is without */
    int64_t index;     /* FRAMES_ONE */
    bool found;
    bool files;    /* a file a frame */
    double within; /* m; infinite: any */
    numbered names;
    outs written; /* the files so far */
    pointcache cache;
    out *sink; /* of the point cache or the one OBJ */
} plan;

/* The OBJ and where it goes. */
typedef struct mover {
    obj file;
    bound b;
    motion moves;
    bone bone;
    double scale;                   /* metres in the OBJ's unit */
    bool *held;                     /* vertices: too far outside to be moved */
    double *position;               /* vertices x 3, in the OBJ's unit */
    double *normal;                 /* normals x 3 */
    char computed[MODEL_NAME + 20]; /* the array that a solver may have computed of the bound surface */
    char skin[MODEL_NAME];          /* the surface's name, where frames move it themselves; else "" */
    pool *threads;
} mover;

/* What the options ask for, checked before anything is read. */
static int plan_of(plan *p, const struct options *o, const char *path, err *e)
{
    const char *usual = o->format == FORMAT_PC2 ? "all" : "last", *output = o->common.output;
    const char *which = o->frame ? o->frame : usual;
    p->asked = which;
    if (frames_asked(which, &p->frames, &p->index, e))
        return -1;
    p->files = p->frames == FRAMES_ALL && o->format == FORMAT_OBJ;
    p->within = o->within.count ? num_length_in(o->within.value[0], num_unit_of("m"), num_unit_of("m")) : INFINITY;
    if (p->within < 0)
        return err_usage(e, "--within: a distance below 0; expected 0 or more");
    if (!strcmp(path, "-"))
        return err_usage(e, "'-': the model comes on standard input; expected the name of an OBJ file");
    if (o->format == FORMAT_PC2 && (!output || !strcmp(output, "-")))
        return err_usage(e, "a point cache's head is written last; expected -o with a file");
    if (p->files)
        return numbered_of(&p->names, output, ", or --format pc2", e);
    if (numbered_is(output))
        return err_usage(e, "-o '%s': a number in the name is for --frame all and OBJ; expected a file's name", output);
    return 0;
}

static int read_obj(const tool *t, obj *o, const char *path, err *e)
{
    notes warnings = {0};
    in *s = in_open(path, e);
    int code = s ? obj_read(o, s, e) : -1;
    in_close(s);
    if (!code)
        obj_notes(o, &warnings);
    tool_warn(t, &warnings);
    return code;
}

/* Finds the vertices that are too far outside to be moved, and says how many. */
static int hold(mover *w, const tool *t, double within, err *e)
{
    int64_t held = 0;
    double furthest = 0;
    w->held = mem_array(w->file.vertices, sizeof *w->held, "vertices", e);
    if (!w->held)
        return -1;
    for (int64_t v = 0; v < w->file.vertices; v++) {
        double d = w->bone.node[v] < 0 ? bound_outside(&w->b, v) : 0;
        w->held[v] = d > within;
        held += w->held[v];
        furthest = fmax(furthest, d);
    }
    tool_detail(t, "%lld vertices move with a rigid surface", (long long)w->bone.count);
    if (held)
        tool_say(t,
                 "%lld of %lld vertices lie further than %.4g m outside and stay where they are, the furthest %.4g m",
                 (long long)held, (long long)w->file.vertices, within, furthest);
    return 0;
}

/* A surface that is carried and not bound may be a skin, which frames move themselves: the one of that name, or, where
 * the model has none of it, one that is this OBJ. */
static int as_skin(mover *w, const model *m, const char *name, err *e)
{
    surface s;
    char other[MODEL_NAME];
    if (surface_there(m, name)) {
        if (surface_part(m, name, "vertex.element"))
            return 0;
        if (surface_of(m, name, &s, e) || surface_is(&s, &w->file, w->scale, e))
            return -1;
        snprintf(w->skin, sizeof w->skin, "%s", name);
        return 0;
    }
    for (int at = 0; model_surface(m, &at, other, sizeof other);) {
        err ignored = {0};
        if (surface_of(m, other, &s, &ignored) || surface_is(&s, &w->file, w->scale, &ignored))
            continue;
        if (!surface_part(m, other, "vertex.element"))
            snprintf(w->skin, sizeof w->skin, "%s", other);
        return 0;
    }
    return 0;
}

/* The bound surface is known by its array: its name may be another than that of the file. */
static void name_computed(mover *w, const model *m)
{
    char name[MODEL_NAME];
    for (int at = 0; model_surface(m, &at, name, sizeof name);) {
        const model_array *element = surface_part(m, name, "vertex.element");
        if (element && element->i32 == w->b.element)
            snprintf(w->computed, sizeof w->computed, "%s/vertex.displacement", name);
    }
}

static int mover_open(mover *w, const tool *t, const model *m, const char *path, const struct options *o, double within,
                      err *e)
{
    char name[SURFACE_NAME_MOST + 1];
    num_unit unit = scale_unit(o->unit, m, e);
    int threads = unit ? tool_threads(t, e) : -1;
    if (threads < 0 || read_obj(t, &w->file, path, e))
        return -1;
    surface_name(path, name, sizeof name);
    w->scale = scale_of(unit);
    if (as_skin(w, m, name, e))
        return -1;
    if (!*w->skin &&
        (bound_find(&w->b, m, name, &w->file, w->scale, e) || bone_find(&w->bone, &w->b, m, e) ||
         motion_open(&w->moves, &w->b, model_count(m, "node"), model_count(m, "element"), e) || hold(w, t, within, e)))
        return -1;
    if (!*w->skin)
        name_computed(w, m);
    w->position = mem_array(3 * w->file.vertices, sizeof *w->position, "positions", e);
    w->normal = w->position ? mem_array(3 * w->file.normals, sizeof *w->normal, "normals", e) : NULL;
    w->threads = w->normal ? pool_create(threads, e) : NULL;
    return w->threads ? 0 : -1;
}

static void mover_close(mover *w)
{
    obj_free(&w->file);
    bone_free(&w->bone);
    motion_free(&w->moves);
    free(w->held);
    free(w->position);
    free(w->normal);
    if (w->threads)
        pool_destroy(w->threads);
}

/* The displacement is added to what was read: where nothing moved, not a digit changes. */
static void move_some(void *context, int64_t chunk, int64_t from, int64_t to)
{
    mover *w = context;
    (void)chunk;
    for (int64_t v = from; v < to; v++) {
        double d[3] = {0};
        if (!w->held[v])
            bone_displacement(&w->bone, &w->moves, v, d);
        for (int a = 0; a < 3; a++)
            w->position[3 * v + a] = w->file.position[3 * v + a] + d[a] / w->scale;
    }
}

/* A skin's array of a frame; -1 with e filled where it has none. */
static const double *of_skin(const mover *w, const frame *f, const char *what, err *e)
{
    char name[MODEL_NAME + 20];
    snprintf(name, sizeof name, "%s/vertex.%s", w->skin, what);
    const model_array *a = frame_find(f, name);
    if (!a)
        err_set(e, NULL, 0,
                "surface %s is not bound to the elements, and frame %lld has no %s; expected sinew bind before the "
                "run, or msds-run --skin",
                w->skin, (long long)f->index, name);
    return a ? a->f64 : NULL;
}

/* Positions by its displacements. A normal becomes the mean of those that the skin has at the vertices that use it. */
static int move_skin(mover *w, const frame *f, err *e)
{
    const double *u = of_skin(w, f, "displacement", e), *n = u ? of_skin(w, f, "normal", e) : NULL;
    if (!n)
        return -1;
    memset(w->normal, 0, 3 * (size_t)w->file.normals * sizeof *w->normal);
    for (int64_t i = 0; i < 3 * w->file.vertices; i++) {
        w->position[i] = w->file.position[i] + u[i] / w->scale;
        if (!isfinite(w->position[i]))
            return err_set(e, NULL, 0, "frame %lld moves vertex %lld to a place that is not finite",
                           (long long)f->index, (long long)(i / 3));
    }
    for (int64_t c = 0; c < w->file.corners; c++)
        for (int a = 0; a < 3 && w->file.corner_normal[c] >= 0; a++)
            w->normal[3 * (int64_t)w->file.corner_normal[c] + a] += n[3 * (int64_t)w->file.corner_vertex[c] + a];
    for (int64_t i = 0; i < w->file.normals; i++) {
        double *to = w->normal + 3 * i, length = sqrt(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]);
        for (int a = 0; a < 3; a++)
            to[a] = length > 0 ? to[a] / length : w->file.normal[3 * i + a];
    }
    return 0;
}

/* By what the solver has computed of the bound surface (--frames surfaces), where the frame has no nodes. */
static int move_computed(mover *w, const frame *f, err *e)
{
    const char *name = w->computed;
    const model_array *u = frame_find(f, name);
    if (!u)
        return err_set(e, NULL, 0, "frame %lld has no node.displacement, and no %s; expected results of tled-run",
                       (long long)f->index, name);
    for (int64_t i = 0; i < 3 * w->file.vertices; i++) {
        const double d = w->held[i / 3] ? 0 : u->f64[i];
        w->position[i] = w->file.position[i] + d / w->scale;
        if (!isfinite(w->position[i]))
            return err_set(e, NULL, 0, "frame %lld moves vertex %lld to a place that is not finite",
                           (long long)f->index, (long long)(i / 3));
    }
    normals_turn(&w->file, w->position, w->normal);
    return 0;
}

static int move(mover *w, const frame *f, err *e)
{
    if (*w->skin)
        return move_skin(w, f, e);
    const model_array *u = frame_find(f, "node.displacement");
    if (!u)
        return move_computed(w, f, e);
    motion_set(&w->moves, u->f64, w->threads);
    bone_set(&w->bone, f);
    pool_run(w->threads, w->file.vertices, 1024, move_some, w);
    for (int64_t i = 0; i < 3 * w->file.vertices; i++)
        if (!isfinite(w->position[i]))
            return err_set(e, NULL, 0, "frame %lld moves vertex %lld (element %d) to a place that is not finite",
                           (long long)f->index, (long long)(i / 3), w->b.element[i / 3]);
    normals_deform(&w->file, &w->moves, &w->bone, w->held, w->normal);
    return 0;
}

/* One of the numbered files. */
static int write_file(plan *p, const mover *w, int64_t index, err *e)
{
    char *name = numbered_name(&p->names, index, e);
    out *to = name && !tool_check_written(p->t, "-o", name, e) ? outs_open(&p->written, name, e) : NULL;
    free(name);
    if (!to)
        return -1;
    obj_write(&w->file, w->position, w->normal, to);
    return out_close(to, e);
}

/* The undeformed state: what was read, to the byte. */
static void stay(mover *w)
{
    if (w->file.vertices)
        memcpy(w->position, w->file.position, 3 * (size_t)w->file.vertices * sizeof *w->position);
    if (w->file.normals)
        memcpy(w->normal, w->file.normal, 3 * (size_t)w->file.normals * sizeof *w->normal);
}

/* Takes a frame that is wanted; NULL: the undeformed state. */
static int take(plan *p, mover *w, const frame *f, err *e)
{
    const int64_t index = f ? f->index : 0;
    if (!f)
        stay(w);
    else if (move(w, f, e))
        return -1;
    if (p->cache.to)
        return pointcache_add(&p->cache, index, w->position, e);
    return p->files ? write_file(p, w, index, e) : 0;
}

/* Reads to the end, whatever is wanted: only there is it known that the run went well. */
static int take_frames(plan *p, mover *w, source *s, err *e)
{
    int got;
    while ((got = source_next(s, e)) > 0) {
        bool one = p->frames == FRAMES_ONE && s->frame.index == p->index && !p->found;
        if ((one || p->frames == FRAMES_ALL) && take(p, w, &s->frame, e))
            return -1;
        p->found |= one;
    }
    if (got < 0)
        return -1;
    if (p->frames == FRAMES_REST)
        return take(p, w, NULL, e);
    if (!s->frames || (p->frames == FRAMES_ONE && !p->found))
        return source_no_frame(s, s->frames ? p->asked : NULL, e);
    return p->frames == FRAMES_LAST ? take(p, w, &s->frame, e) : 0;
}

static int open_sink(plan *p, const struct options *o, int64_t vertices, err *e)
{
    if (p->files)
        return 0;
    p->sink = out_open(o->common.output, false, e);
    if (!p->sink)
        return -1;
    if (o->format == FORMAT_OBJ)
        return 0;
    if (!out_is_file(p->sink))
        return err_set(e, o->common.output, 0, "not a regular file; expected one for a point cache");
    pointcache_begin(&p->cache, p->sink, (int32_t)vertices);
    return 0;
}

static int finish(plan *p, const mover *w, err *e)
{
    if (p->files)
        return outs_commit(&p->written, e);
    if (p->cache.to && pointcache_end(&p->cache, e))
        return -1;
    if (!p->cache.to)
        obj_write(&w->file, w->position, w->normal, p->sink);
    out *sink = p->sink;
    p->sink = NULL;
    return out_close(sink, e);
}

static void plan_close(plan *p)
{
    out_discard(p->sink);
    outs_free(&p->written);
}

static int run_tool(int argc, char **argv)
{
    struct options o = {0};
    err e = {0};
    tool t = {0};
    source s = {0};
    plan p = {.t = &t};
    mover w = {0};

    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done)
        goto out;
    if (plan_of(&p, &o, argv[1], &e) || source_open_part(&s, NULL, o.salvage, &e) ||
        mover_open(&w, &t, &s.body, argv[1], &o, p.within, &e))
        goto out;
    if (open_sink(&p, &o, w.file.vertices, &e) || take_frames(&p, &w, &s, &e))
        goto out;
    finish(&p, &w, &e);
out:
    plan_close(&p);
    source_end(&s, &e);
    mover_close(&w);
    source_close(&s);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
