#include "part.h"

#include "base/mem.h"
#include "base/near.h"
#include "base/path.h"
#include "mesh/lattice.h"
#include "surface/scale.h"
#include "surface/solid.h"
#include "surface/surface_region.h"
#include "surface/triangle_tree.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_MOST = 100 }; /* bytes */

/* Says which of the parts seen so far has a node. */
typedef struct claim {
    int32_t body; /* -1: none */
    bool is_sure; /* by its surface, or inside of a file's */
    double away;  /* m: from the nearest file's surface, where it is not */
} claim;

typedef struct maker {
    model *m;
    const double *position;
    const uint8_t *rigid;
    const int32_t *anchor;
    const model_array *anchors; /* their names */
    const rigid *loose;
    int64_t nodes;
    double reach; /* m */
    char name[64][NAME_MOST + 1];
    double loose_sum[64][3]; /* m: of the vertices of each part's loose surfaces' faces, and how many they are */
    int64_t loose_count[64];
    int32_t bodies;
    claim *of; /* nodes */
} maker;

/* ---- names */

static int no_part(const char *text, err *e)
{
    return err_usage(e,
                     "--part '%.200s': expected NAME=SURFACE,... or NAME=FILE.obj, such as jaw=skull_jaw; a name has "
                     "no blank and no comma",
                     text);
}

static int take_name(maker *k, const char *text, const char **what, err *e)
{
    const char *equals = strchr(text, '=');
    const size_t n = equals ? (size_t)(equals - text) : 0;
    if (!n || n > NAME_MOST || !equals[1] || strcspn(text, " \t,/") < n)
        return no_part(text, e);
    memcpy(k->name[k->bodies], text, n);
    k->name[k->bodies][n] = '\0';
    for (int32_t i = 0; i < k->bodies; i++)
        if (!strcmp(k->name[i], k->name[k->bodies]))
            return err_usage(e, "--part '%.200s': '%s' is named twice; expected all of it in one: NAME=SURFACE,...",
                             text, k->name[i]);
    *what = equals + 1;
    k->bodies++;
    return 0;
}

/* ---- nodes */

/* Both bodies have this node, and others. */
static int refuse_shared(const maker *k, int32_t body, int64_t node, int64_t count, err *e)
{
    const double *x = k->position + 3 * node;
    return err_set(
        e, NULL, 0,
        "--part: '%s' and '%s' share %" PRId64 " rigid node%s, the first at %.4gmm,%.4gmm,%.4gmm; expected parts "
        "that lie apart",
        k->name[k->of[node].body], k->name[body], count, count == 1 ? "" : "s", 1e3 * x[0], 1e3 * x[1], 1e3 * x[2]);
}

/* The nodes that are `mine` become the body's. */
static int claim_sure(maker *k, int32_t body, const uint8_t *mine, err *e)
{
    int64_t shared = 0, first = -1;
    for (int64_t n = 0; n < k->nodes; n++) {
        if (!mine[n])
            continue;
        if (k->of[n].is_sure) {
            first = shared++ ? first : n;
            continue;
        }
        k->of[n] = (claim){.body = body, .is_sure = true};
    }
    return shared ? refuse_shared(k, body, first, shared, e) : 0;
}

/* Adds up where the loose surfaces are that a name stands for. Returns whether there is any. */
static bool take_loose(maker *k, const char *name)
{
    const int32_t b = k->bodies - 1;
    bool any = false;
    for (int64_t i = 0; i < k->loose->primitives; i++) {
        const rigid_primitive *p = &k->loose->primitive[i];
        if (!surface_in_group(k->loose->surface[p->surface].name, name))
            continue;
        any = true;
        for (int64_t c = 0; c < p->corners; c++)
            for (int a = 0; a < 3; a++)
                k->loose_sum[b][a] += p->position[3 * (int64_t)p->vertex[c] + a];
        k->loose_count[b] += p->corners;
    }
    return any;
}

/* Marks the nodes of the surfaces that a name stands for; it is an error where there is none. */
static int mark_surfaces(maker *k, const char *name, uint8_t *mine, err *e)
{
    const model_array *all = k->anchors;
    bool any = false;
    for (int64_t i = 0; i < all->rows; i++)
        any |= surface_in_group(all->str[i], name);
    any |= take_loose(k, name);
    if (!any)
        return near_option(e, "--part", "rigid surface", name, (const char *const *)all->str,
                           all->rows < INT32_MAX ? (int)all->rows : INT32_MAX);
    for (int64_t n = 0; n < k->nodes; n++)
        mine[n] |= k->rigid[n] && k->anchor[n] >= 0 && surface_in_group(all->str[k->anchor[n]], name);
    return 0;
}

static int by_surfaces(maker *k, const char *list, uint8_t *mine, err *e)
{
    char name[MODEL_NAME];
    for (const char *p = list; *p;) {
        const size_t n = strcspn(p, ",");
        snprintf(name, sizeof name, "%.*s", (int)(n < sizeof name ? n : sizeof name - 1), p);
        if (mark_surfaces(k, name, mine, e))
            return -1;
        p += n + (p[n] == ',');
    }
    return claim_sure(k, k->bodies - 1, mine, e);
}

/* Nodes that are inside of no part may still be this one's. */
static void claim_near(maker *k, const triangle_tree *of)
{
    int64_t guess = -1;
    for (int64_t n = 0; n < k->nodes; n++) {
        if (!k->rigid[n] || k->of[n].is_sure)
            continue;
        const triangle_hit hit = triangle_tree_nearest(of, k->position + 3 * n, guess);
        const double away = sqrt(hit.distance2);
        guess = hit.triangle;
        if (away <= k->reach && (k->of[n].body < 0 || away < k->of[n].away))
            k->of[n] = (claim){.body = k->bodies - 1, .away = away};
    }
}

/* The nodes inside of a solid, and near it. */
static int claim_solid(maker *k, const trimesh *b, uint8_t *mine, err *e)
{
    triangle_tree *of = triangle_tree_create(b->position, b->corner, b->triangles, e);
    int failed = of ? 0 : -1;
    for (int64_t n = 0; of && n < k->nodes; n++)
        mine[n] = k->rigid[n] && triangle_tree_holds(of, k->position + 3 * n);
    if (!failed)
        failed = claim_sure(k, k->bodies - 1, mine, e);
    if (!failed)
        claim_near(k, of);
    triangle_tree_destroy(of);
    return failed;
}

static int by_file(maker *k, const char *file, uint8_t *mine, err *e)
{
    trimesh b = {0};
    err found = {0};
    const num_unit unit = scale_unit(NULL, k->m, e);
    if (!unit)
        return -1;
    int failed = solid_read(&b, file, scale_of(unit), &found);
    if (failed)
        err_set(e, NULL, 0, "--part: %.600s", found.text);
    else
        failed = claim_solid(k, &b, mine, e);
    trimesh_free(&b);
    return failed ? -1 : 0;
}

static int take_part(maker *k, const char *text, uint8_t *mine, err *e)
{
    const char *what = text;
    if (take_name(k, text, &what, e))
        return -1;
    memset(mine, 0, (size_t)k->nodes);
    return path_is_obj(what) ? by_file(k, what, mine, e) : by_surfaces(k, what, mine, e);
}

/* ---- arrays */

/* The mean of each body's nodes, and whether each has any; of loose surfaces alone, that of the corners of their faces.
 */
static int find_centres(const maker *k, double *centre, err *e)
{
    int64_t count[64] = {0};
    for (int64_t n = 0; n < k->nodes; n++) {
        const int32_t b = k->of[n].body;
        if (b < 0)
            continue;
        count[b]++;
        for (int a = 0; a < 3; a++)
            centre[3 * b + a] += k->position[3 * n + a];
    }
    for (int32_t b = 0; b < k->bodies; b++) {
        for (int a = 0; a < 3 && !count[b] && k->loose_count[b]; a++)
            centre[3 * b + a] = k->loose_sum[b][a];
        count[b] = count[b] ? count[b] : k->loose_count[b];
        if (!count[b])
            return err_set(
                e, NULL, 0,
                "--part: '%s' has no rigid node; expected bone of it that holds tissue, in the model's place and "
                "unit (attach --report says what is held)",
                k->name[b]);
        for (int a = 0; a < 3; a++)
            centre[3 * b + a] /= (double)count[b];
    }
    return 0;
}

static int add_arrays(const maker *k, err *e)
{
    model *m = k->m;
    if (model_axis_add(m, "body", k->bodies, e))
        return -1;
    model_array *name = model_add(m, "body.name", e);
    for (int32_t b = 0; name && b < k->bodies; b++)
        if (model_set_text(name, b, k->name[b], e))
            return -1;
    model_array *centre = name ? model_add(m, "body.centre", e) : NULL;
    if (!centre || find_centres(k, centre->f64, e))
        return -1;
    model_array *body = model_add(m, "node.body", e);
    for (int64_t n = 0; body && n < k->nodes; n++)
        body->i32[n] = k->of[n].body;
    return body ? 0 : -1;
}

static int find_nodes(maker *k, err *e)
{
    lattice l;
    const model_array *position = model_need(k->m, "node.position", e), *held = model_need(k->m, "node.rigid", e);
    const model_array *anchor = model_need(k->m, "node.anchor", e);
    k->anchors = model_need(k->m, "anchor.name", e);
    if (!position || !held || !anchor || !k->anchors || lattice_of(k->m, &l, e))
        return -1;
    k->position = position->f64;
    k->rigid = held->u8;
    k->anchor = anchor->i32;
    k->nodes = position->rows;
    k->reach =
        sqrt(l.spacing[0] * l.spacing[0] + l.spacing[1] * l.spacing[1] + l.spacing[2] * l.spacing[2]) / 2 * (1 + 1e-9);
    k->of = mem_array(k->nodes, sizeof *k->of, "the nodes", e);
    for (int64_t n = 0; k->of && n < k->nodes; n++)
        k->of[n].body = -1;
    return k->of ? 0 : -1;
}

int32_t part_of_surface(const opt_list *parts, const char *name)
{
    char one[MODEL_NAME];
    for (int32_t i = 0; i < parts->count; i++) {
        const char *p = strchr(parts->value[i], '=');
        if (!p || path_is_obj(p + 1))
            continue;
        for (p++; surface_region_name(&p, one, sizeof one) > 0;)
            if (surface_in_group(name, one))
                return i;
    }
    return -1;
}

int part_make(model *m, const opt_list *parts, const rigid *loose, notes *warnings, err *e)
{
    model_axis_drop(m, "body", warnings);
    if (!parts->count)
        return 0;
    maker *k = mem_array(1, sizeof *k, "the parts", e);
    if (!k)
        return -1;
    k->m = m;
    k->loose = loose;
    int failed = find_nodes(k, e);
    uint8_t *mine = failed ? NULL : mem_array(k->nodes, 1, "the nodes", e);
    failed = !mine;
    for (int i = 0; i < parts->count && !failed; i++)
        failed = take_part(k, parts->value[i], mine, e);
    if (!failed)
        failed = add_arrays(k, e);
    free(mine);
    free(k->of);
    free(k);
    return failed ? -1 : 0;
}
