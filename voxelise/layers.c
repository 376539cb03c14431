#include "voxelise/layers.h"

#include "base/keyfile.h"
#include "base/mem.h"
#include "model/materials.h"
#include "surface/triangulate.h"
#include "voxelise/surfaces/outward.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- the file */

enum { KEY_THICKNESS, KEY_MATERIAL, KEYS };

static const char *const key_name[KEYS] = {"thickness", "material"};

/* What is read on the way. */
typedef struct reader {
    keyfile k;
    layers *l;
    num_unit unit;
    const volumes *plan;
    const model *materials;
} reader;

static int check_name(const reader *r, const char *name, err *e)
{
    if (strchr(name, '='))
        return keyfile_error(
            &r->k, e, "'%s' where a layer's name should be; expected NAME thickness=LENGTH material=MATERIAL", name);
    for (int32_t v = 0; v < r->plan->volumes; v++)
        if (strcasecmp(name, r->plan->volume[v].name) == 0)
            return keyfile_error(&r->k, e, "'%s' is a volume; expected another name", name);
    for (int64_t i = 0; i < r->l->layers; i++)
        if (strcasecmp(name, r->l->layer[i].name) == 0)
            return keyfile_error(&r->k, e, "layer '%s' is given twice; expected another name", name);
    return 0;
}

static int take_thickness(const reader *r, const char *value, double *to, err *e)
{
    num_length length;
    if (num_length_of(value, &length) || !(length.value > 0))
        return keyfile_error(&r->k, e, "thickness=%s; expected a length above 0, as 2mm", value);
    *to = num_length_in(length, r->unit, r->unit);
    return 0;
}

static int take_material(const reader *r, const char *value, int32_t *to, err *e)
{
    *to = materials_find(r->materials, value);
    return *to < 0 ? materials_unknown(r->materials, value, r->k.name, r->k.line, e) : 0;
}

static int take_line(reader *r, err *e)
{
    layers *l = r->l;
    const char *name = r->k.word[0];
    layers_layer one = {.material = materials_find(r->materials, name)};
    double thickness = 0;
    uint64_t seen = 0;
    if (check_name(r, name, e))
        return -1;
    for (int i = 1; i < r->k.count; i++) {
        char *value;
        int key = keyfile_pair(&r->k, i, key_name, KEYS, &seen, &value, e);
        if (key < 0 || (key == KEY_THICKNESS ? take_thickness(r, value, &thickness, e)
                                             : take_material(r, value, &one.material, e)))
            return -1;
    }
    if (!(seen & 1u << KEY_THICKNESS))
        return keyfile_error(&r->k, e, "layer '%s' has no thickness; expected thickness=LENGTH", name);
    one.material = one.material < 0 ? 0 : one.material;
    one.thickness = thickness;
    one.depth = thickness + (l->layers ? l->layer[l->layers - 1].depth : 0);
    if (l->layers == DEPTHS_MOST)
        return keyfile_error(&r->k, e, "too many layers; at most %d are possible", DEPTHS_MOST);
    if (mem_grow(&l->layer, &l->capacity, l->layers + 1, sizeof *l->layer, "layers", e))
        return -1;
    one.name = mem_text(name, e);
    if (!one.name)
        return -1;
    l->layer[l->layers++] = one;
    return 0;
}

int layers_read(layers *l, in *file, num_unit unit, const volumes *plan, const model *materials, err *e)
{
    *l = (layers){0};
    reader r = {.l = l, .unit = unit, .plan = plan, .materials = materials};
    int got;
    keyfile_open(&r.k, file);
    while ((got = keyfile_next(&r.k, e)) > 0)
        if (take_line(&r, e))
            return -1;
    if (got == 0 && l->layers == 0)
        return err_set(e, in_name(file), 0, "no layers; expected lines of NAME thickness=LENGTH material=MATERIAL");
    return got;
}

void layers_free(layers *l)
{
    for (int64_t i = 0; i < l->layers; i++)
        free(l->layer[i].name);
    free(l->layer);
    *l = (layers){0};
}

/* ---- the surface */

/* Triangles in the grid's unit, from the corner of its cell 0. */
typedef struct skin {
    double *corner; /* triangles x 9 */
    int64_t triangles, capacity;
    int32_t *cut;
    int64_t cut_capacity;
} skin;

static int32_t lowest_volumes(const volumes *plan)
{
    int32_t count = 0;
    while (count < plan->volumes && plan->volume[count].level == 0)
        count++;
    return count;
}

/* Whether a group's polygons bound level 0 by a surface that is not rigid. */
static bool is_skin(const volumes *plan, int32_t group)
{
    for (int64_t m = plan->group_start[group]; m < plan->group_start[group + 1]; m++)
        if (plan->volume[plan->member[m].volume].level == 0 &&
            !volumes_is_rigid(plan->surface[plan->member[m].surface].name))
            return true;
    return false;
}

static int add_polygon(skin *s, const obj *o, const grid *g, int64_t face, err *e)
{
    const int32_t *corner = &o->corner_vertex[o->face_start[face]];
    int64_t count = o->face_start[face + 1] - o->face_start[face] - 2;
    if (mem_grow(&s->cut, &s->cut_capacity, 3 * count, sizeof *s->cut, "triangles", e) ||
        mem_grow(&s->corner, &s->capacity, 9 * (s->triangles + count), sizeof *s->corner, "triangles", e) ||
        triangulate(o->position, corner, count + 2, s->cut, e))
        return -1;
    double *to = &s->corner[9 * s->triangles];
    for (int64_t c = 0; c < 3 * count; c++)
        for (int a = 0; a < 3; a++)
            to[3 * c + a] = grid_local(g, a, o->position[3 * (int64_t)corner[s->cut[c]] + a]);
    s->triangles += count;
    return 0;
}

static int make_skin(skin *s, const volumes *plan, const obj *o, const grid *g, err *e)
{
    for (int64_t f = 0; f < o->faces; f++)
        if (o->face_start[f + 1] - o->face_start[f] >= 3 && is_skin(plan, o->face_group[f]) &&
            add_polygon(s, o, g, f, e))
            return -1;
    return 0;
}

static void free_skin(skin *s)
{
    free(s->corner);
    free(s->cut);
}

/* ---- voxels and volumes */

typedef struct work {
    const layers *l;
    int32_t lowest; /* volumes of level 0 */
    uint8_t *layer; /* elements: a layer + 1, 0 = none */
} work;

/* Volumes from the first that is not of level 0 on make room for the layers. */
static int32_t moved(const work *w, int32_t volume)
{
    return volume < w->lowest ? volume : volume + (int32_t)w->l->layers;
}

/* The runs again, cut where layers change. */
static int cut_runs(const work *w, voxels *x, err *e)
{
    climb_runs to = {0};
    int64_t voxel = 0;
    for (int64_t r = 0; r < x->runs; r++) {
        climb_run a = x->run[r];
        bool low = a.volume < w->lowest;
        for (int32_t from = a.from, end; from < a.to; from = end) {
            int layer = low ? w->layer[voxel] : 0;
            for (end = from; end < a.to && (!low || w->layer[voxel] == layer); end++)
                voxel++;
            climb_run part = {from, end, a.j, a.k, layer ? w->lowest + layer - 1 : moved(w, a.volume)};
            if (climb_add_run(&to, part, e)) {
                free(to.run);
                return -1;
            }
        }
    }
    free(x->run);
    x->run = to.run;
    x->runs = to.runs;
    return 0;
}

static int move_counts(const work *w, voxels *x, int32_t all, err *e)
{
    climb_count *count = mem_array(all + w->l->layers, sizeof *count, "volumes", e);
    if (!count)
        return -1;
    for (int32_t v = 0; v < all; v++) {
        count[moved(w, v)] = x->count[v];
        count[moved(w, v)].kept = 0;
    }
    for (int64_t r = 0; r < x->runs; r++)
        count[x->run[r].volume].kept += x->run[r].to - x->run[r].from;
    for (int64_t i = w->lowest; i < w->lowest + w->l->layers; i++)
        count[i].inside = count[i].reached = count[i].kept;
    free(x->count);
    x->count = count;
    return 0;
}

static int add_volumes(const work *w, volumes *plan, err *e)
{
    int64_t capacity = plan->volumes, layers_more = w->l->layers;
    int32_t priority = plan->volume[w->lowest - 1].priority;
    if (mem_grow(&plan->volume, &capacity, plan->volumes + layers_more, sizeof *plan->volume, "volumes", e))
        return -1;
    memmove(&plan->volume[w->lowest + layers_more], &plan->volume[w->lowest],
            (size_t)(plan->volumes - w->lowest) * sizeof *plan->volume);
    memset(&plan->volume[w->lowest], 0, (size_t)layers_more * sizeof *plan->volume);
    for (int64_t m = 0; m < plan->members; m++)
        plan->member[m].volume = moved(w, plan->member[m].volume);
    plan->volumes += (int32_t)layers_more;
    for (int64_t i = 0; i < layers_more; i++) {
        volumes_volume *v = &plan->volume[w->lowest + i];
        v->priority = ++priority;
        v->material = w->l->layer[i].material;
        v->name = mem_text(w->l->layer[i].name, e);
        v->surfaces = v->name ? mem_text("(a layer)", e) : NULL;
        if (!v->surfaces)
            return -1;
    }
    return 0;
}

static int find_layers(const work *w, const voxels *x, const skin *s, const grid *g, pool *threads, err *e)
{
    double depth[DEPTHS_MOST];
    voxels_layers at;
    depths_surface surface = {s->corner, s->triangles};
    for (int64_t i = 0; i < w->l->layers; i++)
        depth[i] = w->l->layer[i].depth;
    if (voxels_find_layers(x, &at, e))
        return -1;
    int status = depths_find(w->layer, depth, w->l->layers, x, &at, w->lowest, &surface, g, threads, e);
    voxels_layers_free(&at);
    return status;
}

int layers_apply(const layers *l, voxels *x, volumes *plan, const obj *o, const grid *g, pool *threads, err *e)
{
    skin s = {0};
    work w = {.l = l, .lowest = lowest_volumes(plan)};
    if (x->fraction) /* by shares: voxels have them */
        return add_volumes(&w, plan, e);
    w.layer = mem_array(x->elements, sizeof *w.layer, "layers", e);
    int status = -1;
    if (w.layer && !make_skin(&s, plan, o, g, e) && !find_layers(&w, x, &s, g, threads, e) && !cut_runs(&w, x, e))
        status = move_counts(&w, x, plan->volumes, e) || add_volumes(&w, plan, e) ? -1 : 0;
    free_skin(&s);
    free(w.layer);
    return status;
}

/* ---- by shares */

/* Finds the shear modulus at rest of each volume of level 0 and of each layer; it is nan for all others. */
static double *find_moduli(const layers *l, const volumes *plan, const model *m, err *e)
{
    const int32_t lowest = lowest_volumes(plan), all = plan->volumes + (int32_t)l->layers;
    double *to = mem_array(all, sizeof *to, "volumes", e);
    for (int32_t v = 0; to && v < all; v++) {
        const int64_t layer = v - lowest;
        material of;
        to[v] = NAN;
        if (layer >= l->layers)
            continue;
        if (materials_of(m, layer < 0 ? plan->volume[v].material : l->layer[layer].material, &of, e)) {
            free(to);
            return NULL;
        }
        to[v] = layer < 0 && plan->volume[v].muscle ? (double)NAN : material_mu(&of);
    }
    return to;
}

int layers_sample(layers_samples *to, const layers *l, const volumes *plan, const model *m, const obj *o, const grid *g,
                  int samples, err *e)
{
    skin s = {0};
    const int made = make_skin(&s, plan, o, g, e);
    *to = (layers_samples){.corner = s.corner, .surface = {s.corner, s.triangles}};
    free(s.cut);
    for (int64_t i = 0; i < l->layers; i++)
        to->depth[i] = l->layer[i].depth;
    to->modulus = made ? NULL : find_moduli(l, plan, m, e);
    to->made = to->modulus ? depths_create(to->depth, l->layers, &to->surface, g, samples, e) : NULL;
    to->strata = (voxels_strata){to->made, lowest_volumes(plan), (int32_t)l->layers};
    if (to->made)
        return 0;
    layers_samples_free(to);
    return -1;
}

void layers_samples_free(layers_samples *s)
{
    depths_destroy(s->made);
    free(s->corner);
    free(s->modulus);
    *s = (layers_samples){0};
}

int64_t layers_at(const layers *l, const volumes *plan, int32_t volume)
{
    int64_t layer = volume - (lowest_volumes(plan) - l->layers);
    return layer >= 0 && layer < l->layers ? layer : -1;
}

double layers_thickness(const layers *l, int64_t layer)
{
    return l->layer[layer].thickness;
}

bool layers_is_thin(const layers *l, int64_t layer, const grid *g)
{
    static const double rounding = 1e-9; /* lengths that differ by less than this share are equal */
    return layers_thickness(l, layer) < grid_longest(g) * (1 - rounding);
}

/* ---- normals */

enum { CHUNK = 1024 }; /* elements */

typedef struct normals {
    const outward *skin;
    const bool *is_layer; /* volumes */
    const grid *g;
    const int32_t *lattice, *volume, *mix; /* elements; mix may be NULL */
    float *normal;                         /* elements x 3 */
    int64_t *sense;                        /* chunks: elements that the skin is turned away from, less the others */
} normals;

static bool in_layer(const normals *w, int64_t element)
{
    return w->is_layer[w->volume[element]] || (w->mix && w->mix[element] >= 0 && w->is_layer[w->mix[element]]);
}

static void find_normals(void *context, int64_t chunk, int64_t from, int64_t to)
{
    normals *w = context;
    int64_t guess = -1;
    for (int64_t i = from; i < to; i++) {
        double centre[3], normal[3], away = 0;
        if (!in_layer(w, i))
            continue;
        for (int a = 0; a < 3; a++)
            centre[a] = grid_centre(w->g, a, w->lattice[3 * i + a]);
        const triangle_hit hit = outward_at(w->skin, centre, guess, normal);
        guess = hit.triangle;
        for (int a = 0; a < 3; a++) {
            away += normal[a] * (hit.point[a] - centre[a]);
            w->normal[3 * i + a] = (float)normal[a];
        }
        w->sense[chunk] += (away > 0) - (away < 0);
    }
}

/* Most centres are inside: where most normals point to them, the skin is turned inward. */
static void turn_outward(const normals *w, int64_t elements)
{
    int64_t sum = 0;
    for (int64_t c = 0; c < pool_chunks(elements, CHUNK); c++)
        sum += w->sense[c];
    for (int64_t i = 0; sum < 0 && i < 3 * elements; i++)
        w->normal[i] = w->normal[i] != 0 ? -w->normal[i] : 0;
}

static int add_normals(const skin *s, const bool *is_layer, const grid *g, model *m, pool *threads, err *e)
{
    model_array *to = model_add(m, "element.normal", e);
    const model_array *mix = model_find(m, "element.mix");
    if (!to || !s->triangles)
        return to ? 0 : -1;
    normals w = {.is_layer = is_layer,
                 .g = g,
                 .lattice = model_find(m, "element.lattice")->i32,
                 .volume = model_find(m, "element.volume")->i32,
                 .mix = mix ? mix->i32 : NULL,
                 .normal = to->f32};
    outward *made = outward_create(s->corner, s->triangles, e);
    w.skin = made;
    w.sense = made ? mem_array(pool_chunks(to->rows, CHUNK), sizeof *w.sense, "normals", e) : NULL;
    const int status = w.sense ? 0 : -1;
    if (!status) {
        pool_run(threads, to->rows, CHUNK, find_normals, &w);
        turn_outward(&w, to->rows);
    }
    outward_free(made);
    free(w.sense);
    return status;
}

int layers_normals(const layers *l, const volumes *plan, const obj *o, const grid *g, model *m, pool *threads, err *e)
{
    skin s = {0};
    bool *is_layer = mem_array(plan->volumes, sizeof *is_layer, "volumes", e);
    for (int32_t v = 0; is_layer && v < plan->volumes; v++)
        is_layer[v] = layers_at(l, plan, v) >= 0;
    const int status = is_layer && !make_skin(&s, plan, o, g, e) ? add_normals(&s, is_layer, g, m, threads, e) : -1;
    free_skin(&s);
    free(is_layer);
    return status;
}
