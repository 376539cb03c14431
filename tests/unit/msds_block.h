/* A box of tetrahedra as a model in memory, one material, for tests of msds-run's solvers. Memory
 * that is not to be had ends the test program.
 */
#ifndef SINEW_MSDS_BLOCK_H
#define SINEW_MSDS_BLOCK_H

#include "base/mem.h"
#include "model/materials.h"
#include "msds/mesh/mesh_tets.h"
#include "msds/problem/problem.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct tets {
    int32_t nodes[3];
    double size[3]; /* m; the lowest corner is 0 0 0 */
    double young, poisson, density;
    int fixed_axis; /* whose low end's nodes are rigid; -1: none */
    bool all_sides; /* every node on the surface is */
} tets;

static inline void tets_must(bool good, const err *e)
{
    if (good)
        return;
    printf("Bail out! %s\n", e->text);
    exit(1);
}

static inline model_array *tets_array(model *m, const char *name)
{
    err e = {0};
    model_array *a = model_add(m, name, &e);
    tets_must(a != NULL, &e);
    return a;
}

/* The tables that every model has: volumes of one material, the first called tissue. */
static inline void tets_volumes(const tets *b, int volumes, model *m)
{
    err e = {0};
    material of = materials_fallback();
    of.law = law_of_form(FORM_LINEAR), of.value[LAW_E] = b->young, of.value[LAW_nu] = b->poisson,
    of.density = b->density;
    tets_must(!materials_make(m, &of, &e) && !model_axis_add(m, "volume", volumes, &e), &e);
    tets_array(m, "element.volume");
    tets_array(m, "volume.material");
    tets_array(m, "volume.level");
    tets_array(m, "volume.priority");
    tets_must(!model_set_text(tets_array(m, "volume.name"), 0, "tissue", &e), &e);
}

static inline void tets_tables(const tets *b, model *m)
{
    tets_volumes(b, 1, m);
}

/* The caller frees it. */
static inline void tets_make(const tets *b, model *m)
{
    err e = {0};
    mesh_box box = {{b->nodes[0], b->nodes[1], b->nodes[2]},
                    {0, 0, 0},
                    {{b->size[0], 0, 0}, {0, b->size[1], 0}, {0, 0, b->size[2]}}};
    tets_must(!mesh_box_add(m, &box, &e), &e);
    tets_tables(b, m);
    uint8_t *rigid = tets_array(m, "node.rigid")->u8;
    const double *x = model_find(m, "node.position")->f64;
    for (int64_t n = 0; n < model_count(m, "node"); n++)
        for (int a = 0; a < 3; a++) {
            bool low = x[3 * n + a]<1e-9, high = x[3 * n + a]> b->size[a] - 1e-9;
            if ((a == b->fixed_axis && low) || (b->all_sides && (low || high)))
                rigid[n] = 1;
        }
}

/* As PST has it: Algorithm 1's constants, contact by prescribed displacement. */
static inline msds_options tets_options(void)
{
    msds_options o = {.scale = .002, .damping = .1, .repulsion = 1};
    return o;
}

static inline msds_plan tets_plan(msds_method method)
{
    msds_plan plan = {.method = method, .dt = .01};
    return plan;
}

/* A sphere whose lowest point is at x, pressing along -z. */
static inline void tets_press(msds_plan *plan, double radius, double x, double y, double z)
{
    probe shape = probe_sphere(radius);
    pose at = {{x, y, z}, {1, 0, 0, 0}};
    plan->touched = true;
    plan->probe = probe_place(&shape, &at);
}

/* What warped elements leave of gravity at u, over what they pull with: from each element, whatever the solver says. */
static inline double tets_left(const msds_problem *p, const double *u)
{
    err e = {0};
    double *f = mem_array(p->nodes, 3 * sizeof *f, "test", &e), left = 0, pull = 0;
    tets_must(f != NULL, &e);
    for (int64_t t = 0; t < p->elements; t++) {
        const int32_t *node = p->element_node + 4 * t;
        double at[4][3], g[3][3], r[3][3], q[4] = {0, 0, 0, 1}, own[4][3];
        for (int c = 0; c < 4; c++)
            memcpy(at[c], u + 3 * (int64_t)node[c], sizeof at[c]);
        simplex_derivative(&p->element[t], at, g);
        simplex_rotation(g, q, r);
        simplex_warped(&p->element[t], g, r, own);
        for (int i = 0; i < 12; i++)
            f[3 * (int64_t)node[i / 3] + i % 3] += own[i / 3][i % 3];
    }
    for (int64_t i = 0; i < 3 * p->nodes; i++) {
        pull += f[i] * f[i];
        left += p->fixed[i / 3] ? 0 : pow(p->weight[i / 3] * p->options.gravity[i % 3] - f[i], 2);
    }
    free(f);
    return sqrt(left / pull);
}

#endif
