/* A block of voxels as a model in memory, one volume of one material or two mixed, for tests of the solver. Memory that
 * is not to be had ends the test program.
 */
#ifndef SINEW_TLED_BLOCK_H
#define SINEW_TLED_BLOCK_H

#define PHYSICAL         ((hourglass_control){HOURGLASS_PHYSICAL, 0})
#define ISOTROPIC(kappa) ((hourglass_control){HOURGLASS_ISOTROPIC, kappa})

#include "mesh/lattice.h"
#include "model/model.h"
#include "physics/hourglass_numbers.h"

#include "tled_slit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct block {
    int32_t cells[3];
    double side[3]; /* m */
    double young, poisson, density, peak;
    int fixed_axis, fixed_low, fixed_high; /* whether the nodes at its low and high end are rigid */
    float fibre[3];                        /* not 0: the volume is a muscle named muscle_m */
    float fraction; /* of every element; 0: the model has none. Below 0: they differ, from .05 to 1 */
    bool mixed;     /* some elements are of a second volume, stiffer and denser, and some
                * mixed of both, by different shares */
} block;

static inline model_array *block_array(model *m, const char *name)
{
    err e = {0};
    model_array *a = model_add(m, name, &e);
    if (!a) {
        printf("Bail out! %s\n", e.text);
        exit(1);
    }
    return a;
}

static inline int64_t block_node(const block *b, int32_t i, int32_t j, int32_t k)
{
    return ((int64_t)k * (b->cells[1] + 1) + j) * (b->cells[0] + 1) + i;
}

/* Nodes and elements of a block with slits. */
static inline void block_mesh_slit(const block *b, const lattice *l, const slit_mesh *from, model *m)
{
    double *position = block_array(m, "node.position")->f64;
    uint8_t *rigid = block_array(m, "node.rigid")->u8;
    const int32_t gx = b->cells[0] + 1, gy = b->cells[1] + 1;
    for (int64_t n = 0; n < from->nodes; n++) {
        const int32_t k = from->place[n], at[3] = {k % gx, k / gx % gy, k / gx / gy};
        lattice_corner(l, at, position + 3 * n);
        rigid[n] =
            (b->fixed_low && at[b->fixed_axis] == 0) || (b->fixed_high && at[b->fixed_axis] == b->cells[b->fixed_axis]);
    }
    memcpy(block_array(m, "element.node")->i32, from->node, 8 * (size_t)from->elements * sizeof *from->node);
}

static inline void block_mesh(const block *b, const lattice *l, model *m)
{
    double *position = block_array(m, "node.position")->f64;
    uint8_t *rigid = block_array(m, "node.rigid")->u8;
    int32_t *node = block_array(m, "element.node")->i32, at[3];
    for (at[2] = 0; at[2] <= b->cells[2]; at[2]++)
        for (at[1] = 0; at[1] <= b->cells[1]; at[1]++)
            for (at[0] = 0; at[0] <= b->cells[0]; at[0]++) {
                int64_t n = block_node(b, at[0], at[1], at[2]);
                lattice_corner(l, at, position + 3 * n);
                rigid[n] = (b->fixed_low && at[b->fixed_axis] == 0) ||
                           (b->fixed_high && at[b->fixed_axis] == b->cells[b->fixed_axis]);
            }
    for (at[2] = 0; at[2] < b->cells[2]; at[2]++)
        for (at[1] = 0; at[1] < b->cells[1]; at[1]++)
            for (at[0] = 0; at[0] < b->cells[0]; at[0]++)
                for (int c = 0; c < 8; c++) {
                    const int32_t *o = lattice_vtk[c];
                    *node++ = (int32_t)block_node(b, at[0] + o[0], at[1] + o[1], at[2] + o[2]);
                }
}

/* A second volume: muscle_n, whose fibres run another way, or stiff. */
static inline void block_second(const block *b, bool muscle, model *m)
{
    err e = {0};
    model_set_text(model_find(m, "volume.name"), 1, muscle ? "muscle_n" : "stiff", &e);
    model_find(m, "volume.muscle")->u8[1] = muscle;
    model_find(m, "volume.material")->i32[1] = 1;
    model_set_text(model_find(m, "material.name"), 1, "stiff", &e);
    model_set_text(model_find(m, "material.law"), 1, "neo-hookean", &e);
    model_find(m, "material.E")->f64[1] = 3 * b->young;
    model_find(m, "material.nu")->f64[1] = .4;
    model_find(m, "material.density")->f64[1] = 1.3 * b->density;
    model_find(m, "material.peak")->f64[1] = .4 * b->peak;
}

/* Values that some elements have in place of their material's, mixed ones and others. */
static inline void block_own(const block *b, model *m)
{
    double *young = block_array(m, "element.E")->f64, *density = block_array(m, "element.density")->f64;
    for (int64_t i = 0; i < model_count(m, "element"); i++) {
        young[i] = i % 4 == 2 ? 1.3 * b->young : NAN;
        density[i] = i % 8 == 2 || i % 8 == 3 ? 1.2 * b->density : NAN;
    }
}

/* Which elements are of the second volume, and which are mixed; fibres by volume. */
static inline void block_mix(const block *b, bool muscle, model *m)
{
    static const float none[3] = {0, 0, 0}, way[3] = {.6F, -.64F, .48F};
    const float *along = muscle ? way : none;
    int32_t *volume = model_find(m, "element.volume")->i32, *mix = block_array(m, "element.mix")->i32;
    float *mixture = block_array(m, "element.mixture")->f32, *fibre = model_find(m, "element.fibre")->f32;
    float *mixfibre = block_array(m, "element.mixfibre")->f32;
    block_second(b, muscle, m);
    for (int64_t i = 0; i < model_count(m, "element"); i++) {
        volume[i] = i % 7 == 0 || i % 5 == 1;
        mix[i] = i / 3 % 3 == 0 ? 1 : -1;
        if (i % 5 == 1)
            mix[i] = 0;
        if (i % 7 == 0)
            mix[i] = -1;
        mixture[i] = mix[i] < 0 ? 0 : (float)(i * 3571 % 97) / 96;
        for (int a = 0; a < 3; a++) {
            fibre[3 * i + a] = volume[i] ? along[a] : b->fibre[a];
            mixfibre[3 * i + a] = mix[i] ? along[a] : b->fibre[a];
            if (mix[i] < 0)
                mixfibre[3 * i + a] = 0;
        }
    }
    block_own(b, m);
}

static inline void block_tables(const block *b, model *m)
{
    err e = {0};
    bool muscle = b->fibre[0] != 0 || b->fibre[1] != 0 || b->fibre[2] != 0;
    block_array(m, "element.volume");
    block_array(m, "volume.level");
    block_array(m, "volume.priority");
    block_array(m, "volume.material");
    block_array(m, "volume.muscle")->u8[0] = muscle;
    model_set_text(block_array(m, "volume.name"), 0, muscle ? "muscle_m" : "skin", &e);
    model_set_text(block_array(m, "material.name"), 0, "tissue", &e);
    model_set_text(block_array(m, "material.law"), 0, "neo-hookean", &e);
    block_array(m, "material.E")->f64[0] = b->young;
    block_array(m, "material.nu")->f64[0] = b->poisson;
    block_array(m, "material.density")->f64[0] = b->density;
    block_array(m, "material.peak")->f64[0] = b->peak;
    float *fibre = block_array(m, "element.fibre")->f32;
    for (int64_t i = 0; i < 3 * model_count(m, "element"); i++)
        fibre[i] = b->fibre[i % 3];
    float *fraction = b->fraction != 0 ? block_array(m, "element.fraction")->f32 : NULL;
    for (int64_t i = 0; fraction && i < model_count(m, "element"); i++)
        fraction[i] = b->fraction > 0 ? b->fraction : .05F + .95F * (float)(i * 7919 % 101) / 100;
    if (b->mixed)
        block_mix(b, muscle, m);
}

/* What fibres do by themselves, of both volumes: a kind that resists being stretched, or NULL; k1 is eta of quadratic;
 * the passive curve and the optimum of muscles, and the velocity of those that have a spring. 0: not given. */
typedef struct block_fibres {
    const char *name, *kind[2];
    double k1[2], k2[2], kappa[2], angle[2], passive[2], optimum[2], vmax[2];
    double fung[4]; /* c, bf, bt and bfs of the first volume, whose law is fung then */
} block_fibres;

/* Those of blocks that are made; NULL: none do anything. */
static const block_fibres *in_fibres;

static inline void block_values(model *m, const char *name, const double value[2])
{
    if (value[0] != 0 || value[1] != 0) {
        model_array *a = block_array(m, name);
        for (int64_t i = 0; i < a->rows; i++)
            a->f64[i] = value[i] != 0 ? value[i] : NAN;
    }
}

/* The first volume's law is fung; no element has values of its own. */
static inline void block_fung(const double value[4], model *m)
{
    static const char *const key[] = {"material.c", "material.bf", "material.bt", "material.bfs"};
    model_array *young = model_find(m, "element.E");
    err e = {0};
    model_set_text(model_find(m, "material.law"), 0, "fung", &e);
    model_find(m, "material.E")->f64[0] = NAN;
    for (int i = 0; i < 4; i++) {
        const double both[2] = {value[i], 0};
        block_values(m, key[i], both);
    }
    for (int64_t i = 0; young && i < young->rows; i++)
        young->f64[i] = NAN;
}

/* Directions that differ; some elements have none, if that may be, and of some the normal is along the fibre. */
static inline void block_directions(model *m, bool all)
{
    model_array *mixed = model_find(m, "element.mixfibre"), *mix = model_find(m, "element.mix");
    float *fibre = model_find(m, "element.fibre")->f32, *normal = block_array(m, "element.normal")->f32;
    for (int64_t i = 0; i < model_count(m, "element"); i++) {
        const double a = (double)(i * 7919 % 101), z = cos(3 * a), r = sin(3 * a);
        const double along[3] = {r * cos(a), r * sin(a), z}, across[3] = {-z * cos(a), -z * sin(a), r};
        for (int k = 0; k < 3; k++) {
            fibre[3 * i + k] = i % 17 == 5 && !all ? 0 : (float)along[k];
            normal[3 * i + k] = (float)(i % 13 == 3 ? along[k] : across[k]);
            if (mixed && mix->i32[i] >= 0)
                mixed->f32[3 * i + k] = (float)along[(k + 1) % 3];
        }
    }
}

static inline void block_add_fibres(const block_fibres *f, model *m)
{
    err e = {0};
    const bool hgo[2] = {f->k2[0] > 0, f->k2[1] > 0};
    const double eta[2] = {hgo[0] ? 0 : f->k1[0], hgo[1] ? 0 : f->k1[1]};
    const double k1[2] = {hgo[0] ? f->k1[0] : 0, hgo[1] ? f->k1[1] : 0};
    for (int64_t i = 0; i < model_count(m, "material"); i++)
        model_set_text(i ? model_find(m, "material.fibre") : block_array(m, "material.fibre"), i,
                       f->kind[i] ? f->kind[i] : "none", &e);
    block_values(m, "material.eta", eta);
    block_values(m, "material.k1", k1);
    block_values(m, "material.k2", f->k2);
    block_values(m, "material.kappa", f->kappa);
    block_values(m, "material.angle", f->angle);
    block_values(m, "material.passive", f->passive);
    block_values(m, "material.optimum", f->optimum);
    block_values(m, "material.vmax", f->vmax);
    if (f->fung[0] > 0)
        block_fung(f->fung, m);
    block_directions(m, f->fung[0] > 0);
}

/* Whether elements of blocks that are made are cut: their strain is its mean over their part. */
static bool in_cuts;

/* Every second or third element, of parts that are boxes at one of its corners, some below the least of cut.h. */
static inline bool block_is_cut(int64_t element)
{
    return element % 5 % 2 == 1;
}

static inline void block_part(int64_t element, float *fraction, float *moments)
{
    double share = 1, at[3];
    for (int a = 0; a < 3; a++) {
        const double length = .15 + .85 * (double)((element * 7919 + 131 * a) % 103) / 102;
        share *= length;
        at[a] = ((element >> a) + a) % 2 ? 1 - length : length - 1;
    }
    const double of[7] = {at[0], at[1], at[2], at[0] * at[1], at[1] * at[2], at[2] * at[0], at[0] * at[1] * at[2]};
    *fraction = (float)share;
    for (int k = 0; k < 7; k++)
        moments[k] = (float)of[k];
}

static inline void block_cuts(model *m)
{
    err e = {0};
    const int64_t elements = model_count(m, "element");
    int64_t count = 0;
    for (int64_t i = 0; i < elements; i++)
        count += block_is_cut(i);
    if (model_axis_add(m, "cut", count, &e))
        exit(1);
    const bool whole = !model_find(m, "element.fraction");
    float *fraction = whole ? block_array(m, "element.fraction")->f32 : model_find(m, "element.fraction")->f32;
    int32_t *element = block_array(m, "cut.element")->i32;
    float *moments = block_array(m, "cut.moments")->f32;
    for (int64_t i = 0; whole && i < elements; i++)
        fraction[i] = 1;
    for (int64_t i = 0; i < elements; i++)
        if (block_is_cut(i)) {
            *element++ = (int32_t)i;
            block_part(i, &fraction[i], moments);
            moments += 7;
        }
}

/* Makes the model, with the slits, the fibres and the cuts that are asked for; the caller frees it. */
static inline void block_make(const block *b, model *m)
{
    err e = {0};
    lattice l = {{0, 0, 0}, {b->side[0], b->side[1], b->side[2]}};
    int64_t nodes = (int64_t)(b->cells[0] + 1) * (b->cells[1] + 1) * (b->cells[2] + 1);
    int64_t elements = (int64_t)b->cells[0] * b->cells[1] * b->cells[2];
    slit_mesh mesh = {0};
    if (in_slit) {
        slit_make(&mesh, in_slit, b->cells);
        nodes = mesh.nodes;
        elements = mesh.elements;
    }
    model_axis_add(m, "node", nodes, &e);
    model_axis_add(m, "element", elements, &e);
    model_axis_add(m, "volume", 1 + b->mixed, &e);
    model_axis_add(m, "material", 1 + b->mixed, &e);
    lattice_save(&l, m, &e);
    if (mesh.node)
        block_mesh_slit(b, &l, &mesh, m);
    else
        block_mesh(b, &l, m);
    slit_free(&mesh);
    block_tables(b, m);
    if (in_fibres)
        block_add_fibres(in_fibres, m);
    if (in_cuts)
        block_cuts(m);
    if (e.status) {
        printf("Bail out! %s\n", e.text);
        exit(1);
    }
}

/* A rigid body of the nodes in a box at rest (low corner, high corner; m), rigid or not. */
static inline void block_add_body(model *m, const char *name, const double box[6])
{
    err e = {0};
    if (model_axis_add(m, "body", 1, &e))
        exit(1);
    model_set_text(block_array(m, "body.name"), 0, name, &e);
    const model_array *position = model_find(m, "node.position");
    int32_t *of = block_array(m, "node.body")->i32;
    for (int64_t n = 0; n < position->rows; n++) {
        const double *x = position->f64 + 3 * n;
        bool is_in = true;
        for (int a = 0; a < 3; a++)
            is_in = is_in && x[a] >= box[a] - 1e-9 && x[a] <= box[3 + a] + 1e-9;
        of[n] = is_in ? 0 : -1;
    }
}

#endif
