#include "slide.h"

#include "base/mem.h"
#include "mesh/lattice.h"
#include "surface/scale.h"
#include "surface/surface_region.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KEEPS = 1, LIFTS };

typedef struct slider {
    model *m;
    const rigid *r;
    const lattice *grid;
    const double *position;
    uint8_t *rigid;
    int32_t *anchor, *body; /* body: NULL without bodies */
    int64_t nodes;
    uint8_t *mark;  /* nodes: 0, KEEPS or LIFTS */
    double *beside; /* nodes x 3, m: the mean of the middles of its elements */
    pool *threads;
    err *e;
} slider;

/* ---- which nodes */

static int mark_nodes(slider *s, const char *option, const char *text, const bool *is, const uint8_t *inside, int as)
{
    int64_t held = 0, marked = 0;
    for (int64_t n = 0; n < s->nodes; n++) {
        if (!s->rigid[n] || s->anchor[n] < 0 || !is[s->anchor[n]])
            continue;
        held++;
        if (!inside[n])
            continue;
        s->mark[n] = (uint8_t)as;
        marked++;
    }
    if (!held)
        return err_set(s->e, NULL, 0, "%s '%.200s': no node is held there; expected a surface that holds some", option,
                       text);
    if (!marked)
        return err_set(s->e, NULL, 0,
                       "%s '%.200s': the region has none of the %" PRId64
                       " nodes that are held; expected one around some, in the model's place and unit",
                       option, text, held);
    return 0;
}

static int take_option(slider *s, const char *option, const char *text, int as)
{
    const char *colon = strchr(text, ':');
    const num_unit unit = colon ? scale_unit(NULL, s->m, s->e) : num_unit_of("m");
    if (!unit)
        return -1;
    if (!*text || colon == text || (colon && !colon[1]))
        return err_usage(s->e, "%s '%.200s': expected SURFACE,...[:REGION], such as skull:lips.obj", option, text);
    bool *is = mem_array(s->r->surfaces + 1, sizeof *is, "the rigid surfaces", s->e);
    uint8_t *inside = is ? mem_array(s->nodes, 1, "the nodes", s->e) : NULL;
    const int failed = !inside || bone_surfaces(s->r, option, text, is, s->e) ||
                       surface_region_of_option(option, colon ? colon + 1 : NULL, unit, s->position, s->nodes,
                                                s->threads, inside, s->e) ||
                       mark_nodes(s, option, text, is, inside, as);
    free(inside);
    free(is);
    return failed ? -1 : 0;
}

/* ---- a field */

static bool is_in(const slider *s, int64_t node, int32_t body)
{
    return s->mark[node] && (s->body ? s->body[node] : -1) == body;
}

/* Which surfaces hold the nodes of the field, and the box of these; `chosen` gets which they are. false: there is none.
 */
static bool field_bounds(const slider *s, bone_field *f, uint8_t *chosen)
{
    int32_t low[3] = {INT32_MAX, INT32_MAX, INT32_MAX}, high[3] = {INT32_MIN, INT32_MIN, INT32_MIN};
    bool any = false;
    for (int64_t n = 0; n < s->nodes; n++) {
        chosen[n] = is_in(s, n, f->body);
        if (!chosen[n])
            continue;
        any = f->is[s->anchor[n]] = true;
        for (int a = 0; a < 3; a++) {
            const double at = (s->position[3 * n + a] - s->grid->origin[a]) / s->grid->spacing[a];
            const int32_t corner = (int32_t)lround(at);
            low[a] = corner < low[a] ? corner : low[a];
            high[a] = corner > high[a] ? corner : high[a];
        }
    }
    if (any)
        bone_field_box(f, s->grid, low, high);
    return any;
}

/* The most that a node of the field is away from the bone, in voxels' longest sides; tells how many are more than half
 * of one away. */
static double find_worst(const slider *s, const uint8_t *chosen, const distance_triangles *by, int64_t *far)
{
    const double *h = s->grid->spacing, voxel = fmax(h[0], fmax(h[1], h[2]));
    double worst = 0;
    int64_t guess = -1;
    for (int64_t n = 0; n < s->nodes; n++) {
        if (!chosen[n])
            continue;
        const double away = fabs(distance_at(by, s->position + 3 * n, &guess)) / voxel;
        worst = fmax(worst, away);
        *far += away > .5 * (1 + 1e-6);
    }
    return worst;
}

/* ---- arrays */

static int add_slides(const slider *s, const bone_fields *of, int64_t first, int64_t nodes)
{
    model *m = s->m;
    if (model_axis_add(m, "slide", nodes, s->e))
        return -1;
    model_array *node = model_add(m, "slide.node", s->e), *at = node ? model_add(m, "slide.field", s->e) : NULL;
    model_array *lifts = at ? model_add(m, "slide.lifts", s->e) : NULL;
    int64_t k = 0;
    if (!lifts)
        return -1;
    node = model_find(m, "slide.node"), at = model_find(m, "slide.field");
    for (int64_t n = 0; n < s->nodes; n++)
        for (int64_t f = first; f < of->count; f++)
            if (is_in(s, n, of->of[f].body)) {
                node->i32[k] = (int32_t)n;
                at->i32[k] = (int32_t)f;
                lifts->u8[k++] = s->mark[n] == LIFTS;
            }
    return 0;
}

/* ---- all */

static int fill_field(const slider *s, bone_field *f, const uint8_t *chosen, slide_found *found, int64_t *far)
{
    const bone_view from = {chosen, s->beside, s->nodes};
    distance_triangles d = {.tree = NULL};
    const int failed =
        bone_triangles(&d, s->r, f->is, &from, "--slide", s->e) || bone_field_sample(f, &d, s->threads, s->e);
    if (!failed)
        found->worst = fmax(found->worst, find_worst(s, chosen, &d, far));
    distance_triangles_free(&d);
    return failed ? -1 : 0;
}

static int make_fields(slider *s, bone_fields *of, uint8_t *chosen, slide_found *found, notes *warnings)
{
    const model_array *bodies = s->body ? model_find(s->m, "body.name") : NULL;
    const int64_t count = bodies ? bodies->rows : 0;
    int64_t far = 0;
    for (int64_t b = -1; b < count; b++) {
        bone_field *f = bone_field_add(of, s->r, (int32_t)b, s->e);
        if (!f)
            return -1;
        if (!field_bounds(s, f, chosen)) {
            bone_field_drop(of);
            continue;
        }
        found->fields++;
        if (fill_field(s, f, chosen, found, &far))
            return -1;
    }
    if (far)
        notes_add(warnings,
                  "%" PRId64 " of %" PRId64
                  " sliding nodes are more than half a voxel away from the bone, the furthest "
                  "%.3g voxels; they keep that distance from it",
                  far, found->nodes, found->worst);
    return 0;
}

static void let_go(slider *s)
{
    for (int64_t n = 0; n < s->nodes; n++)
        if (s->mark[n]) {
            s->rigid[n] = 0;
            s->anchor[n] = -1;
            if (s->body)
                s->body[n] = -1;
        }
}

static int make_all(slider *s, bone_fields *fields, slide_found *found, notes *warnings)
{
    const int64_t first = fields->count;
    for (int64_t n = 0; n < s->nodes; n++)
        found->nodes += s->mark[n] != 0;
    uint8_t *chosen = mem_array(s->nodes, 1, "the nodes", s->e);
    s->beside = chosen ? bone_beside(s->m, s->e) : NULL;
    const int failed =
        !s->beside || make_fields(s, fields, chosen, found, warnings) || add_slides(s, fields, first, found->nodes);
    free(chosen);
    if (!failed)
        let_go(s);
    return failed ? -1 : 0;
}

static int begin(slider *s, lattice *grid)
{
    model *m = s->m;
    const model_array *position = model_need(m, "node.position", s->e), *held = model_need(m, "node.rigid", s->e);
    const model_array *anchor = model_need(m, "node.anchor", s->e), *body = model_find(m, "node.body");
    if (!position || !held || !anchor || lattice_of(m, grid, s->e))
        return -1;
    s->grid = grid;
    s->position = position->f64;
    s->rigid = held->u8;
    s->anchor = anchor->i32;
    s->body = body ? body->i32 : NULL;
    s->nodes = position->rows;
    s->mark = mem_array(s->nodes, 1, "the nodes", s->e);
    return s->mark ? 0 : -1;
}

int slide_make(model *m, const rigid *r, const slide_options *o, pool *threads, bone_fields *fields, slide_found *found,
               notes *warnings, err *e)
{
    lattice grid;
    slider s = {.m = m, .r = r, .threads = threads, .e = e};
    *found = (slide_found){.nodes = 0};
    model_axis_drop(m, "slide", warnings);
    if (!o->keep->count && !o->off->count)
        return 0;
    int failed = begin(&s, &grid);
    for (int i = 0; i < o->keep->count && !failed; i++)
        failed = take_option(&s, "--slide", o->keep->value[i], KEEPS);
    for (int i = 0; i < o->off->count && !failed; i++)
        failed = take_option(&s, "--slide-off", o->off->value[i], LIFTS);
    failed = failed || make_all(&s, fields, found, warnings);
    free(s.mark);
    free(s.beside);
    return failed ? -1 : 0;
}
