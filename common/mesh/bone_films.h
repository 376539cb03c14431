/* Films of tissue on bone (attach --surface), in a model: their geometry, their gradients and what they leave of
 * elements, for the solver and for what looks at frames. A film has the area A and the thickness d; on one side it
 * hangs on the bone, on the other on a point x of an element. Where neither moves by the bone's turn alone, with w
 * what the point is displaced by more than the bone, n its normal, T = I - n (x) n and R the turn, the film's mean
 * gradient is
 *     F = R + w (x) n / d + (grad u - (R - I)) T / 2,   w = u(x) - u_bone(x),
 * as bone does not stretch: along the bone the film is strained by half of what the element is there. By the element's
 * shape functions F is linear in u_a,
 *     F = sum_a u_a (x) g_a + what the bone does,   g_a = N_a n / d + T grad N_a / 2,
 * with N_a and grad N_a not those at x, but means over the film, as bone.products gives them: so the force on the
 * film of a constant stress is the one on what is left of the element, whichever way the bone cuts it.
 * Borrows the model; the caller owns the rest.
 */
#ifndef SINEW_BONE_FILMS_H
#define SINEW_BONE_FILMS_H

#include "mesh/cut_moments.h"

typedef struct bone_films {
    int64_t count;                          /* 0: the model has none */
    const int32_t *element, *anchor, *body; /* body: NULL: none has one */
    const double *point, *depth, *area;     /* m; count x 3, count, count */
    const float *products;                  /* count x 4; NULL: those of the point */
    double *normal, *slope;                 /* count x 3; count x 8 x 3: g, 1/m; owned */
} bone_films;

struct element_mesh;

/* mesh: of boxes. -1 with e filled where the model has films that cannot be. */
int bone_films_make(bone_films *to, const struct element_mesh *mesh, const model *m, err *e);
void bone_films_free(bone_films *f);

/* ---- what films leave */

/* Owned: of each element, its share; and the moments of the rest, of elements that the model or films cut. */
typedef struct film_rest {
    float *fraction;
    int32_t *cut_element;
    float *cut_moments;
} film_rest;

/* Finds what films leave of the elements of a model that has films. whole: the elements' shares with films, or NULL: 1.
 * *cut, the model's, becomes that of the rest; of a laminate what films leave has the share alone. */
int film_rest_make(film_rest *to, const model *m, int64_t elements, const float *whole, const borders *laminates,
                   cut_moments *cut, err *e);
void film_rest_free(film_rest *r);

/* ---- how they are strained */

/* How bone is displaced at a film's point, m, and A = R - I. */
typedef struct film_bone {
    double u[3], turn[3][3];
} film_bone;

/* H = F - I of a film, row by row. moved: displacements of nodes (x 3, m); at: 8, where its element's are in it. */
void bone_films_gradient(const bone_films *f, int64_t film, const film_bone *bone, const double *moved,
                         const int32_t *at, double h[9]);

/* How the bone of each film has moved in a frame, as its bone.displacement and body.pose say; at rest without. */
void bone_films_moved(const bone_films *f, const frame *of, film_bone *to);

#endif
