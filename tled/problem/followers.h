/* Pressure on bound surfaces, which follows them: p pushes each triangle (a, b, c) of a curve's, where it is now,
 * against its normal, and each of its vertices gets a third of that, which is exact for a linear triangle,
 *     f = -p/6 (b - a) x (c - a);
 * the nodes of the element that the vertex is bound to get its force by their shares in the vertex. So the power of the
 * nodes' forces is that of the pressure on the surface, and on a closed surface forces and moments sum to 0.
 *
 * Forces join the elements' in the sums that a node's step takes, as contact's do (collider.h). All is computed in
 * double, node by node in one order: the same bytes for any number of threads.
 *
 * The load stiffness, df/du, raises the highest frequency. The change of (b - a) x (c - a) is at most
 * |c - a| |db - da| + |b - a| |dc - da|, and the displacement of a vertex is the sum of its nodes', by shares. That
 * gives, for each node, the sums of the absolute values of its row and of its column. The largest of half of both, over
 * the node's mass, is not below the largest eigenvalue of the load stiffness's symmetric part over the masses
 * (Gershgorin; a closed surface's has no other part). The sums are made at rest for p = 1; they grow at most as edges
 * do.
 */
#ifndef SINEW_FOLLOWERS_H
#define SINEW_FOLLOWERS_H

#include "base/pool.h"
#include "tled/problem/state.h"

typedef struct followers {
    int64_t vertices, triangles, nodes; /* of all curves, one curve after the other; nodes: those with a share */
    int64_t shares;                     /* that nodes have in vertices, but for 0 */
    double *rest;                       /* vertices x 3, m; owned, as is all below */
    int32_t *vertex_curve;              /* vertices: the script's curve */
    int32_t *share_start;               /* vertices + 1: those of vertex v are share_start[v] and on */
    int32_t *share_node;                /* shares: a place in `node` */
    double *share;                      /* shares */
    int32_t *corner;                    /* triangles x 3: vertices */
    double *part;                       /* triangles: of each, which counts (script.h) */
    int32_t *around_start, *around;     /* vertices + 1; 3 x triangles: the triangles at each vertex, ascending */
    int32_t *node;                      /* nodes: of the model, ascending */
    uint8_t *is_pushed;                 /* nodes: by more than whole surfaces, which are in balance */
    int32_t *pull_start;                /* nodes + 1: the same shares by node, then by vertex: pull_start[n] and on */
    int32_t *pull_vertex;               /* shares */
    double *pull_share;                 /* shares */
    double *pull_bound;                 /* shares: 1/(s2 Pa): that share's part of its node's sums */
    double *most;                       /* the script's curves x 3, Pa: the largest pressure, then what is not read */
} followers;

/* Makes p->followers, NULL where the script has no pressure; masses are known. -1 with e filled. */
int followers_make(tled_problem *p, const model *m, err *e);
void followers_free(followers *f);

/* Whether a node of the model is pushed by a part of a surface. f may be NULL. */
bool followers_push(const followers *f, int64_t node);

/* What forces are computed in. The creator owns it. */
typedef struct followers_work {
    const followers *f;
    const double *value; /* borrowed: the curves' values */
    double *moved;       /* nodes x 3, m: displacements, the caller's to fill */
    double *at, *force;  /* vertices x 3: m, N */
    double *normal;      /* triangles x 3, m2: twice the area, of that part of it that counts */
} followers_work;

/* w, zeroed, for the followers f, which may be NULL. -1 with e filled and w to be freed all the same. */
int followers_room(followers_work *w, const followers *f, err *e);
void followers_room_free(followers_work *w);
int64_t followers_bytes(const followers *f);

/* Fills w->moved from the displacements of all nodes (x 3). */
void followers_move(followers_work *w, const double *displacement);

/* Computes what vertices are pushed with where w->moved has them, at the curves' values; then the sum of a node's. */
void followers_press(followers_work *w, pool *threads, const double *value);
void followers_pull(const followers_work *w, int64_t i, double force[3]);

/* 1/s2: by how much the load stiffness raises the square of the highest frequency: at the largest pressures of the
 * script, at rest; and where w->moved has the vertices, at the curves' values, which leaves no forces in w. Without
 * followers, 0. */
double followers_square_at_rest(const tled_problem *p);
double followers_square(followers_work *w, pool *threads, const double *value);

/* A stable step, s, with it. */
double followers_step(double square, double step);

#endif
