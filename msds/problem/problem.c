#include "msds/problem/problem.h"

#include "base/mem.h"
#include "model/finite.h"
#include "model/material_elements.h"
#include "model/materials.h"
#include "msds/problem/springs.h"

#include <stdlib.h>
#include <string.h>

/* Lattices of five tetrahedra a cell with springs of k a tetrahedron act as E = 8.615 k / h, h the cell's side. */
static const double lattice_stiffness = 8.615;

/* Rounding leaves strains of some 1e-16, so that tissue back at rest never comes to a share of what it still pulls
 * with: a strain of this size counts as load. */
static const double slight = 1e-8;

/* A tetrahedron flatter than this share of its longest edge cubed has no shape to speak of. */
static const double flat = 1e-9;

static int check_arrays(msds_problem *p, const model *m, err *e)
{
    const model_array *position = model_need(m, "node.position", e);
    const model_array *node = position ? model_need(m, "element.node", e) : NULL;
    if (!node)
        return -1;
    if (node->columns != 4)
        return err_set(
            e, m->stream, m->stream ? node->line : 0,
            "elements of %d nodes; expected tetrahedra (msds-mesh makes them of a box, an image or a voxel model)",
            (int)node->columns);
    if (node->rows < 1 || node->rows > INT32_MAX / 16)
        return err_set(e, m->stream, 0, "%lld elements; expected 1 to %d", (long long)node->rows, INT32_MAX / 16);
    if (finite_elements(m, m->stream, e))
        return -1;
    p->nodes = position->rows;
    p->elements = node->rows;
    p->position = position->f64;
    p->element_node = node->i32;
    return 0;
}

static double longest_edge(const msds_problem *p, int64_t t)
{
    static const int corner[6][2] = SIMPLEX_EDGES;
    double longest = 0;
    for (int i = 0; i < 6; i++) {
        const double *a = p->position + 3 * (int64_t)p->element_node[4 * t + corner[i][0]];
        const double *b = p->position + 3 * (int64_t)p->element_node[4 * t + corner[i][1]];
        longest = fmax(longest,
                       (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]) + (b[2] - a[2]) * (b[2] - a[2]));
    }
    return sqrt(longest);
}

static int make_shapes(msds_problem *p, const model *m, err *e)
{
    double volume = 0;
    p->element = mem_array(p->elements, sizeof *p->element, "elements", e);
    if (!p->element)
        return -1;
    for (int64_t t = 0; t < p->elements; t++) {
        const int32_t *n = p->element_node + 4 * t;
        const double *x = p->position;
        simplex *s = &p->element[t];
        simplex_shape(x + 3 * (int64_t)n[0], x + 3 * (int64_t)n[1], x + 3 * (int64_t)n[2], x + 3 * (int64_t)n[3], s);
        double longest = longest_edge(p, t);
        if (!(s->volume > flat * longest * longest * longest))
            return err_set(e, m->stream, m->stream ? model_line(model_find(m, "element.node"), t) : 0,
                           "element %lld is %s, its volume %.6g m3; expected its nodes in VTK order, a volume above 0",
                           (long long)t, s->volume < 0 ? "inverted" : "flat", s->volume);
        volume += s->volume;
    }
    p->side = cbrt(5 * volume / (double)p->elements);
    return 0;
}

/* The linear law's E and nu are those of small strains of the neo-Hookean, too. share: of the element, that is
 * enclosed. */
static int take_material(msds_problem *p, int64_t t, const material *a, double share)
{
    p->young[t] = material_young(a) * share;
    simplex_material(p->young[t], material_poisson(a), &p->element[t]);
    for (int c = 0; c < 4; c++)
        p->weight[p->element_node[4 * t + c]] += a->density * share * p->element[t].volume / 4;
    return 0;
}

/* What elements have shares of; each or NULL. */
typedef struct shares {
    const float *fraction, *mixture;
    const int32_t *mix;
    material_elements own;
} shares;

static int find_shares(const model *m, shares *s, err *e)
{
    const model_array *fraction = model_find(m, "element.fraction"), *mix = model_find(m, "element.mix");
    const model_array *mixture = mix ? model_need(m, "element.mixture", e) : NULL;
    if (mix && !mixture)
        return -1;
    *s = (shares){.own = material_elements_of(m)};
    if (fraction)
        s->fraction = fraction->f32;
    if (mix) {
        s->mixture = mixture->f32;
        s->mix = mix->i32;
    }
    return 0;
}

/* Two of one form, which both have E and nu. */
static material mixed(const material *a, const material *b, double share)
{
    const material_numbers first = material_numbers_of(a), second = material_numbers_of(b);
    const material_numbers numbers = material_mixed(&first, &second, share);
    material to = *a;
    to.value[LAW_E] = law_young(numbers.at_rest);
    to.value[LAW_nu] = law_poisson(numbers.at_rest);
    to.density = numbers.density;
    return to;
}

/* Element t's of its volume, or of the two that it is mixed of; of one that a surface cuts, so much as is enclosed. */
static int take_element(msds_problem *p, const shares *s, int64_t t, int32_t volume, const material *list,
                        const char *stream, err *e)
{
    const int32_t mix = s->mix ? s->mix[t] : -1;
    material own = list[volume];
    material_elements_put(&s->own, t, &own);
    if (mix >= 0 && !(s->mixture[t] >= 0 && s->mixture[t] <= 1))
        return err_set(e, stream, 0, "element.mixture, row %lld is %g; expected a share from 0 to 1", (long long)t,
                       (double)s->mixture[t]);
    if (s->fraction && !(s->fraction[t] > 0 && s->fraction[t] <= 1))
        return err_set(e, stream, 0, "element.fraction, row %lld is %g; expected above 0, and at most 1", (long long)t,
                       (double)s->fraction[t]);
    if (mix >= 0 && material_form(&list[mix]) == material_form(&own))
        own = mixed(&own, &list[mix], (double)s->mixture[t]);
    return take_material(p, t, &own, s->fraction ? (double)s->fraction[t] : 1);
}

/* Whether linear elasticity of the same moduli at rest stands for it at small strains. */
static bool is_small_strain(const law_row *of)
{
    return !of->fibres && (of->form == FORM_LINEAR || of->form == FORM_NEO_HOOKEAN);
}

/* Of volume i. */
static int read_material(const model *m, int64_t i, material *to, err *e)
{
    const model_array *name = model_find(m, "volume.name");
    if (materials_of(m, model_find(m, "volume.material")->i32[i], to, e))
        return -1;
    if (!is_small_strain(to->law))
        return err_set(e, NULL, 0, "volume '%s' has the law '%s'; expected linear, or neo-hookean at small strains",
                       name ? name->str[i] : "", to->law->name);
    if (!material_is_directed(to))
        return 0;
    return err_set(e, NULL, 0,
                   "volume '%s' has fibres that resist being stretched; expected none, as springs and "
                   "small strains have no direction",
                   name ? name->str[i] : "");
}

static int make_materials(msds_problem *p, const model *m, err *e)
{
    const model_array *of = model_need(m, "element.volume", e);
    const model_array *table = of ? model_need(m, "volume.material", e) : NULL;
    material *list = table ? mem_array(table->rows, sizeof *list, "materials", e) : NULL;
    p->young = mem_array(p->elements, sizeof *p->young, "elements", e);
    p->weight = mem_array(p->nodes, sizeof *p->weight, "nodes", e);
    shares share;
    int result = list && p->young && p->weight ? find_shares(m, &share, e) : -1;
    for (int64_t i = 0; !result && i < table->rows; i++)
        result = read_material(m, i, &list[i], e);
    result = result ? result : material_elements_check(m, list, e);
    p->volume = of ? of->i32 : NULL;
    for (int64_t t = 0; !result && t < p->elements; t++)
        result = take_element(p, &share, t, of->i32[t], list, m->stream, e);
    free(list);
    return result;
}

static int make_nodes(msds_problem *p, const model *m, err *e)
{
    const model_array *rigid = model_find(m, "node.rigid");
    p->fixed = mem_array(p->nodes, 1, "nodes", e);
    p->displacement = mem_array(p->nodes, 3 * sizeof *p->displacement, "nodes", e);
    p->velocity = mem_array(p->nodes, 3 * sizeof *p->velocity, "nodes", e);
    if (!p->fixed || !p->displacement || !p->velocity)
        return -1;
    for (int64_t n = 0; n < p->nodes; n++) {
        p->fixed[n] = rigid && rigid->u8[n];
        if (!(p->weight[n] > 0)) /* of no element: it stays where it is */
            p->fixed[n] = 1;
    }
    return 0;
}

/* Adds to zeros. */
static void fill_repulsion(msds_problem *p)
{
    for (int64_t i = 0; i < p->springs; i++)
        for (int c = 0; c < 2; c++)
            p->repulsion[p->spring[i].node[c]] += p->options.repulsion * p->spring[i].stiffness;
}

static int make_repulsion(msds_problem *p, err *e)
{
    p->repulsion = mem_array(p->nodes, sizeof *p->repulsion, "nodes", e);
    if (p->repulsion)
        fill_repulsion(p);
    return p->repulsion ? 0 : -1;
}

static double slight_load(const msds_problem *p)
{
    double sum = 0;
    for (int64_t t = 0; t < p->elements; t++) {
        const simplex *s = &p->element[t];
        const double stress = slight * (3 * s->lambda + 2 * s->mu) * s->volume;
        for (int c = 0; c < 4; c++)
            for (int a = 0; a < 3; a++)
                sum += stress * stress * s->gradient[c][a] * s->gradient[c][a];
    }
    return sum;
}

static double scale_of_springs(const msds_problem *p)
{
    return p->options.scale > 0 ? p->options.scale : p->side / lattice_stiffness;
}

int msds_problem_make(msds_problem *p, const model *m, const msds_options *o, err *e)
{
    p->options = *o;
    p->mass_factor = 1;
    if (check_arrays(p, m, e) || make_shapes(p, m, e) || make_materials(p, m, e) || make_nodes(p, m, e))
        return -1;
    p->slight = slight_load(p);
    p->scale = scale_of_springs(p);
    return springs_make(p, p->scale, o->damping, e) || make_repulsion(p, e) ? -1 : 0;
}

void msds_problem_change(msds_problem *p, const msds_options *o)
{
    p->options = *o;
    p->scale = scale_of_springs(p);
    springs_change(p, p->scale, o->damping);
    memset(p->repulsion, 0, (size_t)p->nodes * sizeof *p->repulsion);
    fill_repulsion(p);
}

int msds_problem_start(msds_problem *p, const frame *f, err *e)
{
    const model_array *u = frame_find(f, "node.displacement"), *v = frame_find(f, "node.velocity");
    if (!u)
        return err_set(e, NULL, 0, "frame %lld has no node.displacement; expected it, to go on from there",
                       (long long)f->index);
    memcpy(p->displacement, u->f64, 3 * (size_t)p->nodes * sizeof *p->displacement);
    if (v)
        memcpy(p->velocity, v->f64, 3 * (size_t)p->nodes * sizeof *p->velocity);
    for (int64_t n = 0; n < p->nodes; n++)
        for (int a = 0; a < 3 && p->fixed[n]; a++)
            p->velocity[3 * n + a] = 0;
    return 0;
}

void msds_problem_free(msds_problem *p)
{
    free(p->element);
    free(p->young);
    free(p->fixed);
    free(p->repulsion);
    free(p->weight);
    free(p->spring);
    free(p->displacement);
    free(p->velocity);
    *p = (msds_problem){0};
}
