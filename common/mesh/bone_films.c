#include "mesh/bone_films.h"

#include "base/mem.h"
#include "base/pose.h"
#include "mesh/element_motion.h"
#include "mesh/lattice.h"
#include "mesh/rigid_body.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void bone_films_free(bone_films *f)
{
    free(f->normal);
    free(f->slope);
    *f = (bone_films){.count = 0};
}

/* ---- rows */

/* How thin a film may be, in sides of an element: attach makes none that is thinner than a sixteenth. */
static const double thinnest = 1e-6;

static int check_sizes(const bone_films *f, const element_mesh *mesh, err *e)
{
    const double *h = mesh->side, least = thinnest * fmin(h[0], fmin(h[1], h[2]));
    for (int64_t i = 0; i < f->count; i++) {
        if (!(f->depth[i] > 0) || !(f->area[i] > 0))
            return err_set(e, NULL, 0, "bone.depth and bone.area, row %lld, are %g and %g; expected both above 0",
                           (long long)i, f->depth[i], f->area[i]);
        if (f->depth[i] < least)
            return err_set(e, NULL, 0, "bone.depth, row %lld, is %g m; expected at least a millionth of a voxel, %g m",
                           (long long)i, f->depth[i], least);
    }
    return 0;
}

static int borrow(bone_films *f, const element_mesh *mesh, const model *m, err *e)
{
    const model_array *element = model_need(m, "bone.element", e), *anchor = model_need(m, "bone.anchor", e);
    const model_array *point = model_need(m, "bone.point", e), *depth = model_need(m, "bone.depth", e);
    const model_array *area = model_need(m, "bone.area", e), *body = model_find(m, "bone.body");
    const model_array *products = model_find(m, "bone.products");
    if (!element || !anchor || !point || !depth || !area || !model_need(m, "bone.normal", e))
        return -1;
    *f = (bone_films){.count = element->rows,
                      .element = element->i32,
                      .anchor = anchor->i32,
                      .body = body ? body->i32 : NULL,
                      .point = point->f64,
                      .depth = depth->f64,
                      .area = area->f64,
                      .products = products ? products->f32 : NULL};
    return check_sizes(f, mesh, e);
}

/* Unit normals as they are used: those of a model may be off in length by a little. */
static int take_normals(bone_films *f, const model *m, err *e)
{
    const float *of = model_find(m, "bone.normal")->f32;
    f->normal = mem_array(f->count, 3 * sizeof *f->normal, "the films", e);
    for (int64_t i = 0; f->normal && i < f->count; i++) {
        const double x = (double)of[3 * i], y = (double)of[3 * i + 1], z = (double)of[3 * i + 2];
        const double length = sqrt(x * x + y * y + z * z);
        if (!(length > 0))
            return err_set(e, NULL, 0, "bone.normal, row %lld, is 0 0 0; expected a unit normal", (long long)i);
        f->normal[3 * i] = x / length;
        f->normal[3 * i + 1] = y / length;
        f->normal[3 * i + 2] = z / length;
    }
    return f->normal ? 0 : -1;
}

/* How far from an element's box a point may be, in its sides: attach takes those that are half a voxel away. */
static const double farthest = 1;

/* The place of a film's point in its element, in its sides from the first corner. */
static int place_of(const bone_films *f, const element_mesh *mesh, int64_t film, double at[3], err *e)
{
    const int32_t *node = mesh->node + 8 * (int64_t)f->element[film];
    for (int a = 0; a < 3; a++) {
        at[a] = (f->point[3 * film + a] - mesh->rest[3 * (int64_t)node[0] + a]) / mesh->side[a];
        if (!(at[a] >= -farthest && at[a] <= 1 + farthest))
            return err_set(e, NULL, 0, "bone.point, row %lld, is away from its element, %d; expected it near to that",
                           (long long)film, (int)f->element[film]);
    }
    return 0;
}

/* Means over a film of its coordinates in its element, -1 to 1 there, and of their products. */
static void moments_of(const bone_films *f, int64_t film, const double at[3], double m[CUT_MOMENTS])
{
    for (int a = 0; a < 3; a++)
        m[a] = 2 * at[a] - 1;
    const double products[CUT_MOMENTS - 3] = {m[0] * m[1], m[1] * m[2], m[2] * m[0], m[0] * m[1] * m[2]};
    for (int i = 3; i < CUT_MOMENTS; i++)
        m[i] = f->products ? (double)f->products[(CUT_MOMENTS - 3) * film + i - 3] : products[i - 3];
}

/* g of a corner. */
static void slope_of(const bone_films *f, const double side[3], int64_t film, const double m[CUT_MOMENTS], int corner,
                     double g[3])
{
    const double x = 2 * lattice_vtk[corner][0] - 1, y = 2 * lattice_vtk[corner][1] - 1;
    const double z = 2 * lattice_vtk[corner][2] - 1, *n = f->normal + 3 * film;
    const double share =
        (1 + x * m[0] + y * m[1] + z * m[2] + x * y * m[3] + y * z * m[4] + z * x * m[5] + x * y * z * m[CUT_XYZ]) / 8;
    const double grad[3] = {x * (1 + y * m[1] + z * m[2] + y * z * m[4]) / (4 * side[0]),
                            y * (1 + z * m[2] + x * m[0] + z * x * m[5]) / (4 * side[1]),
                            z * (1 + x * m[0] + y * m[1] + x * y * m[3]) / (4 * side[2])};
    const double along = grad[0] * n[0] + grad[1] * n[1] + grad[2] * n[2];
    for (int a = 0; a < 3; a++)
        g[a] = share / f->depth[film] * n[a] + (grad[a] - along * n[a]) / 2;
}

static int find_slopes(bone_films *f, const element_mesh *mesh, err *e)
{
    double at[3] = {0}, moments[CUT_MOMENTS];
    f->slope = mem_array(f->count, 24 * sizeof *f->slope, "the films", e);
    if (!f->slope)
        return -1;
    for (int64_t i = 0; i < f->count; i++) {
        if (place_of(f, mesh, i, at, e))
            return -1;
        moments_of(f, i, at, moments);
        for (int c = 0; c < 8; c++)
            slope_of(f, mesh->side, i, moments, c, f->slope + 24 * i + 3 * (int64_t)c);
    }
    return 0;
}

int bone_films_make(bone_films *to, const element_mesh *mesh, const model *m, err *e)
{
    *to = (bone_films){.count = 0};
    if (!model_find(m, "bone.element") && !model_find(m, "film.element"))
        return 0;
    if (!mesh->is_lattice)
        return err_set(e, NULL, 0, "bone.element is of elements without a lattice; expected a lattice's boxes");
    const model_array *film = model_find(m, "film.element");
    if (film && film->rows && !(model_find(m, "bone.element") && model_find(m, "bone.element")->rows))
        return err_set(e, NULL, 0, "film.element has %lld rows and bone.element none; expected some of both",
                       (long long)film->rows);
    return borrow(to, mesh, m, e) || take_normals(to, m, e) || find_slopes(to, mesh, e) ? -1 : 0;
}

/* ---- what films leave */

/* Films take at most this share of an element, so that each of its nodes still hangs on something. */
static const double most_of = .9;

/* What taking goes by, borrowed. */
typedef struct taking {
    const model_array *element;
    const float *share, *moments, *whole;
    const borders *laminates;
} taking;

void film_rest_free(film_rest *r)
{
    free(r->fraction);
    free(r->cut_element);
    free(r->cut_moments);
    *r = (film_rest){NULL, NULL, NULL};
}

static int check_rows(const model_array *element, err *e)
{
    for (int64_t i = 1; i < element->rows; i++)
        if (element->i32[i] <= element->i32[i - 1])
            return err_set(e, NULL, 0, "film.element, row %lld is %d after %d; expected ascending numbers",
                           (long long)i, (int)element->i32[i], (int)element->i32[i - 1]);
    return 0;
}

static void take_shares(const film_rest *r, int64_t elements, const taking *t)
{
    for (int64_t i = 0; i < elements; i++)
        r->fraction[i] = t->whole ? t->whole[i] : 1;
    for (int64_t i = 0; i < t->element->rows; i++) {
        const double whole = (double)r->fraction[t->element->i32[i]];
        r->fraction[t->element->i32[i]] = (float)(whole - fmin((double)t->share[i], most_of * whole));
    }
}

/* The moments of what is left of an element: whole - part, by their means and shares. */
static void moments_left(const float *whole, double share, const float *part, double taken, float *to)
{
    const double left = fmax(share - taken, (1 - most_of) * share);
    for (int k = 0; k < CUT_MOMENTS; k++) {
        const double of_whole = whole ? (double)whole[k] : 0;
        const double of_part = taken < most_of * share ? (double)part[k] : of_whole;
        const double rest = share * of_whole - fmin(taken, most_of * share) * of_part;
        to[k] = (float)fmax(-1, fmin(1, rest / left));
    }
}

/* The next row from k on of an element that is no laminate: of those what films leave has the share alone. */
static int64_t next_cut(const taking *t, int64_t k)
{
    while (k < t->element->rows && t->laminates->count && borders_at(t->laminates, t->element->i32[k]) >= 0)
        k++;
    return k;
}

/* Rows of elements that are cut, by the model or by films; those of both are in order. */
static int join_cuts(film_rest *r, const taking *t, cut_moments *cut, err *e)
{
    const cut_moments of = *cut;
    const int64_t rows = t->element->rows, room = of.count + rows;
    int64_t count = 0;
    r->cut_element = mem_array(room, sizeof *r->cut_element, "the films", e);
    r->cut_moments = r->cut_element ? mem_array(room, CUT_MOMENTS * sizeof *r->cut_moments, "the films", e) : NULL;
    if (!r->cut_moments)
        return -1;
    for (int64_t i = 0, k = next_cut(t, 0); i < of.count || k < rows; count++) {
        const int32_t is_cut = i < of.count ? of.element[i] : INT32_MAX;
        const int32_t film = k < rows ? t->element->i32[k] : INT32_MAX;
        const int32_t at = is_cut < film ? is_cut : film;
        const float *whole = of.of + CUT_MOMENTS * i;
        float *to = r->cut_moments + CUT_MOMENTS * count;
        r->cut_element[count] = at;
        if (film == at)
            moments_left(is_cut == at ? whole : NULL, t->whole ? (double)t->whole[at] : 1, t->moments + CUT_MOMENTS * k,
                         (double)t->share[k], to);
        else
            memcpy(to, whole, CUT_MOMENTS * sizeof *to);
        i += is_cut == at;
        k = film == at ? next_cut(t, k + 1) : k;
    }
    *cut = (cut_moments){r->cut_element, r->cut_moments, count};
    return 0;
}

int film_rest_make(film_rest *to, const model *m, int64_t elements, const float *whole, const borders *laminates,
                   cut_moments *cut, err *e)
{
    const model_array *element = model_need(m, "film.element", e);
    const model_array *share = element ? model_need(m, "film.share", e) : NULL;
    const model_array *moments = share ? model_need(m, "film.moments", e) : NULL;
    *to = (film_rest){NULL, NULL, NULL};
    if (!moments || check_rows(element, e))
        return -1;
    const taking t = {element, share->f32, moments->f32, whole, laminates};
    to->fraction = mem_array(elements, sizeof *to->fraction, "the films", e);
    if (!to->fraction)
        return -1;
    take_shares(to, elements, &t);
    return cut->count ? join_cuts(to, &t, cut, e) : 0;
}

/* ---- how they are strained */

/* What a film's gradient has of the bone: R - I - (R - I) T / 2 - u n / d. */
static void of_bone(const bone_films *f, int64_t film, const film_bone *bone, double h[9])
{
    const double *n = f->normal + 3 * film;
    for (int i = 0; i < 3; i++) {
        const double *turn = bone->turn[i], along = turn[0] * n[0] + turn[1] * n[1] + turn[2] * n[2];
        for (int k = 0; k < 3; k++)
            h[3 * i + k] = (turn[k] + along * n[k]) / 2 - bone->u[i] / f->depth[film] * n[k];
    }
}

void bone_films_gradient(const bone_films *f, int64_t film, const film_bone *bone, const double *moved,
                         const int32_t *at, double h[9])
{
    const double *slope = f->slope + 24 * film;
    of_bone(f, film, bone, h);
    for (int c = 0; c < 8; c++)
        for (int i = 0; i < 9; i++)
            h[i] += moved[3 * (int64_t)at[c] + i / 3] * slope[3 * c + i % 3];
}

void bone_films_moved(const bone_films *f, const frame *of, film_bone *to)
{
    const model_array *moved = frame_find(of, "bone.displacement");
    for (int64_t i = 0; i < f->count; i++) {
        to[i] = (film_bone){.u = {0}};
        if (!moved)
            continue;
        memcpy(to[i].u, moved->f64 + 3 * i, sizeof to[i].u);
        if (!f->body || f->body[i] < 0)
            continue;
        const pose at = rigid_body_pose(of, f->body[i]);
        double r[9];
        pose_matrix(at.quaternion, r);
        for (int k = 0; k < 9; k++)
            to[i].turn[k / 3][k % 3] = r[k] - (k % 4 == 0);
    }
}
