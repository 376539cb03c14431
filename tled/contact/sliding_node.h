/* The maths of a node that slides on bone, one source for every executor; its equations are in sliding.h. In double.
 * Owns nothing.
 */
#ifndef SINEW_SLIDING_NODE_H
#define SINEW_SLIDING_NODE_H

#include "tled/problem/moves.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#define SLIDING_FUNCTION MOVES_FUNCTION

enum { SLIDING_FREE = -1 }; /* HOLD_FREE of state.h */

/* Where a field's bone is: x = turn X + to. */
typedef struct sliding_bone {
    double turn[3][3], to[3];
} sliding_bone;

typedef struct sliding_field {
    int64_t start;      /* of its samples */
    int32_t samples[3]; /* along x, y, z */
    double first[3];    /* m: where its first sample is */
    int32_t hold;       /* the script's first curve of its body, or -1: it stays */
    sliding_bone still; /* where it then is: at rest, or where a frame has it */
} sliding_field;

/* What nodes slide on. Borrows all. */
typedef struct sliding_ground {
    const sliding_field *field;
    const float *value; /* m: phi, at the samples of all fields */
    double spacing[3];  /* m: of samples */
    double per[3];      /* 1/m: 1 over that: few divisions, for which a card takes long */
    double friction;    /* mu */
} sliding_ground;

/* A node that slides. */
typedef struct sliding_node {
    double position[3], rest; /* m: X, phi0 */
    int32_t hold[3];          /* of its components: SLIDING_FREE, or what holds it (moves.h) */
    int32_t of;               /* its field */
    bool lifts;               /* whether it may come off */
} sliding_node;

/* How far a node is off at x (m), and n: a unit vector. The bone's point there, at rest, is where. */
typedef struct sliding_touch {
    double off, normal[3], where[3];
} sliding_touch;

/* Of a distance, whose slope is 1 but where the bone on two sides is as near. */
#define SLIDING_SLOPE .5

/* As near to the bone as counts as touching it, in its least spacing. */
#define SLIDING_TOUCH 1e-4

enum { SLIDING_TURNS = 3 }; /* in which a node is put back */

/* ---- the field */

/* phi at X, and its gradient; beyond the field, along the gradient at its border. */
SLIDING_FUNCTION double sliding_distance(const sliding_ground *g, int32_t which, const double *where, double *slope)
{
    const sliding_field *f = &g->field[which];
    const int64_t row = f->samples[0], sheet = row * f->samples[1];
    double t[3], over[3], x[4], along[4]; /* along x, at the four edges */
    int64_t at = f->start;
    for (int a = 0; a < 3; a++) {
        const double local = (where[a] - f->first[a]) * g->per[a], most = f->samples[a] - 1;
        const double inside = fmin(fmax(local, 0.), most), cell = fmin(floor(inside), most - 1);
        t[a] = inside - cell;
        over[a] = g->spacing[a] * (local - inside);
        at += (int64_t)cell * (a == 0 ? 1 : a == 1 ? row : sheet);
    }
    for (int k = 0; k < 4; k++) {
        const float *v = g->value + at + k % 2 * row + k / 2 * sheet;
        along[k] = (double)v[1] - (double)v[0];
        x[k] = (double)v[0] + t[0] * along[k];
    }
    const double low = x[0] + t[1] * (x[1] - x[0]), high = x[2] + t[1] * (x[3] - x[2]);
    slope[0] =
        ((1 - t[2]) * ((1 - t[1]) * along[0] + t[1] * along[1]) + t[2] * ((1 - t[1]) * along[2] + t[1] * along[3])) *
        g->per[0];
    slope[1] = ((1 - t[2]) * (x[1] - x[0]) + t[2] * (x[3] - x[2])) * g->per[1];
    slope[2] = (high - low) * g->per[2];
    return low + t[2] * (high - low) + (over[0] * slope[0] + over[1] * slope[1] + over[2] * slope[2]);
}

/* Whether X is beyond its samples. */
SLIDING_FUNCTION bool sliding_beyond(const sliding_ground *g, int32_t which, const double *where)
{
    const sliding_field *f = &g->field[which];
    for (int a = 0; a < 3; a++)
        if (!(where[a] >= f->first[a] && where[a] <= f->first[a] + g->spacing[a] * (f->samples[a] - 1)))
            return true;
    return false;
}

/* value: the curves'. */
SLIDING_FUNCTION sliding_bone sliding_bone_of(const sliding_field *f, const double *value)
{
    sliding_bone b = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};
    if (f->hold < 0)
        return f->still;
    for (int a = 0; a < 3; a++) { /* moves.h: u = b + A X */
        b.to[a] = value[3 * (int64_t)f->hold + a];
        for (int k = 0; k < 3; k++)
            b.turn[a][k] += value[3 * ((int64_t)f->hold + 1 + k) + a];
    }
    return b;
}

/* Where the bone's point X is. */
SLIDING_FUNCTION void sliding_move(const sliding_bone *b, const double *where, double *x)
{
    for (int a = 0; a < 3; a++)
        x[a] = b->to[a] + ((b->turn[a][0] * where[0] + b->turn[a][1] * where[1]) + b->turn[a][2] * where[2]);
}

/* ---- a node */

SLIDING_FUNCTION double sliding_length(const double *v)
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* m: SLIDING_TOUCH. */
SLIDING_FUNCTION double sliding_touching(const sliding_ground *g)
{
    return SLIDING_TOUCH * fmin(g->spacing[0], fmin(g->spacing[1], g->spacing[2]));
}

/* At displacement u. */
SLIDING_FUNCTION sliding_touch sliding_at(const sliding_ground *g, const sliding_node *n, const sliding_bone *bone,
                                          const double *u)
{
    sliding_touch t;
    double slope[3], length = 0;
    for (int a = 0; a < 3; a++) {
        t.where[a] = 0;
        for (int k = 0; k < 3; k++)
            t.where[a] += bone->turn[k][a] * (n->position[k] + u[k] - bone->to[k]);
    }
    const double phi = sliding_distance(g, n->of, t.where, slope);
    for (int a = 0; a < 3; a++)
        length += slope[a] * slope[a];
    length = sqrt(length);
    const double per = length > 0 ? 1 / length : 0;
    t.off = (phi - n->rest) * (length < SLIDING_SLOPE ? 1 / SLIDING_SLOPE : per);
    for (int a = 0; a < 3; a++)
        t.normal[a] = (bone->turn[a][0] * slope[0] + bone->turn[a][1] * slope[1] + bone->turn[a][2] * slope[2]) * per;
    return t;
}

/* n in the components that nothing holds; returns the square of its length there, 0 where that is less than half: what
 * holds the others then holds the node. */
SLIDING_FUNCTION double sliding_free_normal(const sliding_node *n, const double *normal, double *to)
{
    double square = 0;
    for (int a = 0; a < 3; a++) {
        to[a] = n->hold[a] == SLIDING_FREE ? normal[a] : 0;
        square += to[a] * to[a];
    }
    return square >= .25 ? square : 0;
}

/* Takes out of a force (3, N), or an acceleration, what the bone bears of it; in components that are not held. Returns
 * what that was along n: above 0 it is pushed into the bone. t: where the node is. */
SLIDING_FUNCTION double sliding_bear(const sliding_ground *g, const sliding_node *n, const sliding_touch *t,
                                     double *force)
{
    double free_part[3], along = 0;
    const double square = sliding_free_normal(n, t->normal, free_part);
    for (int a = 0; a < 3; a++)
        along += force[a] * free_part[a];
    if (!(square > 0) || (n->lifts && (along > 0 || t->off > sliding_touching(g))))
        return 0;
    for (int a = 0; a < 3; a++)
        force[a] -= along / square * free_part[a];
    return -along / sqrt(square);
}

/* A node's step: as PASS_* of cpu_pass.h and cuda.h; next: the curves' values at its end. */
typedef struct sliding_step {
    double dt, damping;
    bool finishes, begins;
    const double *next;
} sliding_step;

/* Where the bone is a step before now, now, and at the step's end. */
typedef struct sliding_bones {
    sliding_bone past, was, is;
} sliding_bones;

/* Takes from v, along the bone, at most `most` of what is relative to it, whose point there moves from was to is in dt.
 */
SLIDING_FUNCTION void sliding_rub(const sliding_node *n, const sliding_touch *t, const sliding_bone *was,
                                  const sliding_bone *is, double most, double dt, double *v)
{
    double free_part[3], before[3], after[3], slip[3], along = 0;
    const double square = sliding_free_normal(n, t->normal, free_part);
    if (!(square > 0) || !(most > 0))
        return;
    sliding_move(was, t->where, before);
    sliding_move(is, t->where, after);
    for (int a = 0; a < 3; a++) {
        slip[a] = n->hold[a] == SLIDING_FREE ? v[a] - (after[a] - before[a]) / dt : 0;
        along += slip[a] * free_part[a];
    }
    for (int a = 0; a < 3; a++)
        slip[a] -= along / square * free_part[a];
    const double speed = sliding_length(slip), part = speed > most ? most / speed : 1;
    for (int a = 0; a < 3; a++)
        v[a] -= part * slip[a];
}

/* Puts u and v back to the bone after the predictor, and rubs. */
SLIDING_FUNCTION void sliding_place(const sliding_ground *g, const sliding_node *n, const sliding_bones *b,
                                    double borne, double dt, double *u, double *v)
{
    const double touching = sliding_touching(g), most = touching / SLIDING_TOUCH / 2; /* half a voxel a turn */
    double free_part[3], square = 0, pushed = 0;
    sliding_touch t;
    for (int k = 0; k < SLIDING_TURNS; k++) {
        t = sliding_at(g, n, &b->is, u);
        square = sliding_free_normal(n, t.normal, free_part);
        if (!(square > 0) || (n->lifts && t.off > 0) || (k && fabs(t.off) < touching))
            break;
        const double back = fmin(fmax(t.off, -most), most) / square;
        for (int a = 0; a < 3; a++) {
            u[a] -= back * free_part[a];
            v[a] -= back * free_part[a] / dt;
        }
        pushed -= back * sqrt(square) / dt;
    }
    pushed += borne * dt / 2;
    if (g->friction > 0 && pushed > 0) {
        const double slid[3] = {v[0], v[1], v[2]};
        sliding_rub(n, &t, &b->was, &b->is, g->friction * pushed, dt, v);
        for (int a = 0; a < 3; a++)
            u[a] += dt * (v[a] - slid[a]);
    }
}

/* A step of displacement u and velocity v; a: the acceleration by all forces but the bone's. */
SLIDING_FUNCTION void sliding_go(const sliding_ground *g, const sliding_node *n, const sliding_bones *b,
                                 const sliding_step *s, double *a, double *u, double *v)
{
    const double drag = s->damping * s->dt / 2;
    for (int i = 0; i < 3; i++)
        a[i] = n->hold[i] == SLIDING_FREE ? a[i] : 0;
    const sliding_touch t = sliding_at(g, n, &b->was, u);
    const double borne = sliding_bear(g, n, &t, a);
    for (int i = 0; i < 3; i++)
        if (n->hold[i] == SLIDING_FREE && s->finishes)
            v[i] = v[i] * (1 - drag) + s->dt / 2 * a[i];
    if (s->finishes && g->friction > 0)
        sliding_rub(n, &t, &b->past, &b->was, g->friction * borne * s->dt / 2, s->dt, v);
    if (!s->begins)
        return;
    for (int i = 0; i < 3; i++) {
        if (n->hold[i] == SLIDING_FREE) {
            v[i] = (v[i] + s->dt / 2 * a[i]) / (1 + drag);
            u[i] += s->dt * v[i];
        } else if (n->hold[i] >= 0) {
            const double end = moves_to(s->next, n->hold[i], i, n->position);
            v[i] = (end - u[i]) / s->dt;
            u[i] = end;
        }
    }
    sliding_place(g, n, b, borne, s->dt, u, v);
}

/* ---- what a look at it tells */

/* What the bone does to a node, N, where other forces sum up to `net`: along n, and by friction as long as it does not
 * slip. In free components. */
typedef struct sliding_load {
    double normal[3], stuck[3];
    double pressed; /* of what is along n, what presses the node; at least 0 */
} sliding_load;

SLIDING_FUNCTION sliding_load sliding_load_of(const sliding_ground *g, const sliding_node *n, const sliding_bone *bone,
                                              const double *u, const double *net)
{
    const sliding_touch t = sliding_at(g, n, bone, u);
    sliding_load load;
    double left[3];
    for (int a = 0; a < 3; a++)
        load.stuck[a] = left[a] = n->hold[a] == SLIDING_FREE ? net[a] : 0;
    load.pressed = fmax(sliding_bear(g, n, &t, left), 0.);
    const double most = g->friction * load.pressed, along = sliding_length(left),
                 part = along > most ? most / along : 1;
    for (int a = 0; a < 3; a++) {
        load.normal[a] = left[a] - load.stuck[a];
        load.stuck[a] = most > 0 ? -part * left[a] : 0;
    }
    return load;
}

#endif
