/* What tled-run solves, as flat arrays: the problem, which no executor changes, made from a model. The caller owns
 * the problem; it borrows the model's arrays and the script, which must outlive it. Who computes it: tled_executor.h.
 *
 * Each node sums the forces of its elements in the order in which these stand in the lattice, x fastest, so that the
 * sum is the same whoever computes it in whatever order, and however the model numbers its elements.
 */
#ifndef SINEW_STATE_H
#define SINEW_STATE_H

#include "base/pool.h"
#include "mesh/cut_moments.h"
#include "mesh/fibres.h"
#include "physics/forms.h"
#include "physics/hourglass_numbers.h"
#include "physics/muscle_numbers.h"
#include "solve/fields.h"
#include "tled/problem/moves.h"
#include "tled/problem/script.h"

/* What holds one component of a node: nothing, its place at the start, or a curve of the script (moves.h). */
enum { HOLD_FREE = -1, HOLD_STILL = -2 };

/* What an element is made of: a volume, or two. With s the share of the second, density is (1 - s) rho1 + s rho2, mu is
 * mu1^(1-s) mu2^s and K likewise (material_between), and coefficients lie between (form_between). */
typedef struct tled_law {
    double c[FORM_NUMBERS]; /* Pa: the coefficients of the problem's form */
    double mu, bulk;        /* Pa: at rest */
    double density;         /* kg/m3 */
    double hourglass[HOURGLASS_NUMBERS];
    double twists; /* 1/s2: no less than the square of the highest frequency of its hourglass modes at rest */
} tled_law;

typedef struct tled_volume {
    const char *name; /* borrowed */
    tled_law law;
    double peak, optimum;          /* Pa; the stretch at which its muscle is strongest */
    double muscle[MUSCLE_NUMBERS]; /* its curves (muscle_curves.h); all 0: the active one alone, strongest at rest */
    bool curved;                   /* that they are not */
    bool serial;                   /* that its muscle is in series with a spring (muscle_series.h) */
    double square;                 /* 1/s2: of the highest frequency of an element of it at rest (step.h) */
    int64_t elements;              /* of it */
    int64_t contract;              /* curve that sets its level, or -1 */
    const struct law_row *row;     /* its material's law, in the table of laws */
} tled_volume;

typedef struct tled_problem {
    pool *threads; /* that make it and look at it before a run, borrowed; NULL: the caller's thread alone */
    int64_t nodes, elements;
    int32_t volumes;
    enum form form;                /* that all laws are expressed in */
    double side[3];                /* m: of every element; without a lattice, a cube's of the mean volume */
    struct conforming *conforming; /* elements that are no lattice's (conforming.h), owned; NULL: boxes of `side` */
    hourglass_control control;
    const double *position;        /* nodes x 3, m */
    const int32_t *element_node;   /* elements x 8, VTK order */
    const int32_t *element_volume; /* elements */
    const float *fibre;            /* elements x 3, or NULL */
    const float *fraction; /* elements: the share that is tissue, by which mass and all forces go; NULL: all 1 */
    cut_moments cut;       /* elements whose strain is its mean over that share (cut.h); of none: none is */
    const int32_t *mix;    /* elements: the second volume of those that are mixed, -1 in others; NULL: none is */
    const float *mixture;  /* elements: its share of the tissue, 0 to 1; where mix is not NULL */
    borders borders;       /* mixed elements that are laminates (cut.h); of none: none is */
    double *border;        /* of each of these LAMINATE_NUMBERS; owned, or NULL */
    const float *mixfibre; /* elements x 3: its fibre; or NULL */
    fibres_view fibres;    /* that resist being stretched; of NULL: there are none */
    int32_t *mixed;        /* elements: which of `law` is its own, or -1; NULL: none is. Owned, as is all below */
    tled_law *law;         /* of the elements that are mixed, or have values in place of their material's, in order */
    int32_t *own_mix;   /* what mix and mixture are where elements have such values: those go the way of mixed ones, */
    float *own_mixture; /* as mixed of their volume, and of no share of it again; else NULL */
    int64_t laws;
    bool own_values;       /* some elements have values in place of their material's */
    tled_volume *volume;   /* volumes */
    int32_t *corner;       /* nodes x 8: element * 8 + corner, in the lattice's order, then elements * 8 */
    int32_t *corner_start; /* nodes + 1; or NULL. Without a lattice: node n's are
                       * corner[corner_start[n]] and on, in the elements' order */
    double *mass;          /* nodes: kg */
    double *weight; /* nodes, kg: what gravity acts on, where elements are cut (cut.h) or have films; NULL: the mass */
    int32_t *hold;  /* nodes x 3, then films x 3: HOLD_*, or as moves.h says */
    int64_t held;   /* nodes with any component held */
    int32_t *force_start;  /* nodes + 1: entries of node n are force_start[n] to force_start[n + 1] - 1 */
    int32_t *force_curve;  /* entries: the curve whose value the node gets a share of */
    int32_t *force_spring; /* entries: the curve of a spring's factor, or -1 (loads.h) */
    double *force_share;   /* entries: 1 for a force, m2 for a traction, in all; N/m for a spring */
    bool curved;           /* that any volume's muscle has curves of its own */
    bool serial;           /* that any is in series with a spring: the state then has contractile elements */
    const script *script;
    int64_t gravity;                         /* its curve, or -1 */
    double start;                            /* s: the model's time at the start */
    int32_t spare_curves, spare_nodes;       /* live: room that an executor may keep for what lines add; 0: none */
    fields fields;                           /* what a state consists of */
    field_values at_start;                   /* and the one that the run begins from: m, m/s */
    const struct collider *collider;         /* what presses (collider.h), or NULL */
    struct bodies *bodies;                   /* the model's rigid bodies (bodies.h), owned; NULL: none */
    struct films *films;                     /* of tissue on bone (films.h), owned; NULL: none */
    struct followers *followers;             /* the script's pressures (followers.h), owned; NULL: none */
    struct sliding *sliding;                 /* nodes that slide on bone (contact/sliding.h); NULL: none does */
    const struct self_contact *self_contact; /* skin that touches itself (contact/self_contact.h); NULL: none does */
    const int32_t *slide;                    /* slides: these nodes, borrowed; and: */
    const uint8_t *slide_lifts;              /* which of them may come off; NULL: none may */
    int64_t slides;
} tled_problem;

/* A run of steps: after step i of them (from 1) the time is origin + (first + i) / rate. A rate, since a whole
 * number of steps a second then gives times that are exact. */
typedef struct tled_plan {
    double origin, rate; /* s, 1/s: dt = 1 / rate */
    int64_t first;
    double damping; /* 1/s: alpha of the force -alpha M v */
} tled_plan;

static inline double tled_time(const tled_plan *plan, int64_t i)
{
    return plan->origin + (double)(plan->first + i) / plan->rate;
}

/* What get() gives, as doubles: field i of the table, of which these are the first, nodes x 3: m, m/s; and internal
 * forces, nodes x 3, N: the sum of the elements' pulls at the displacement, less what a probe and pressures push with
 * (where a step or create led to the state; not right after restore). Where muscles are in series with springs there
 * are elements x 1 of their volume's contractile elements, c - 1 (muscle_series.h), and where second volumes have
 * fibres of theirs. */
enum { TLED_DISPLACEMENT, TLED_VELOCITY, TLED_CONTRACTILE, TLED_MIXCONTRACTILE, TLED_INTERNAL = FIELDS_MOST };

/* What a pass over the model does, in any executor: ends a step, begins the next, writes the internal forces instead of
 * displacements. */
enum { PASS_FINISH = 1, PASS_BEGIN = 2, PASS_INTERNAL = 4 };

/* Makes p (zeroed but for its threads) of the model, at rest at time 0: all its elements must be its lattice's boxes,
 * or it has no lattice. control: of hourglass modes. -1 with e filled and p to be freed all the same. */
int tled_problem_make(tled_problem *p, const model *m, const script *s, hourglass_control control, err *e);
void tled_problem_free(tled_problem *p);

/* Takes over curves that came to the script or left it: what forces, holds and contracts, but not the elements. States
 * of the problem have to take that over too (tled_executor's reload), and what else has a curve's values. -1 with e
 * filled. */
int tled_problem_reload(tled_problem *p, const model *m, err *e);

/* What a state of a model of so many nodes and elements consists of; without contractile elements. */
fields tled_fields(int64_t nodes, int64_t elements);

/* From here on velocities are in no frame, so no executor copies them for one; checkpoints have them all the same. */
void tled_problem_still(tled_problem *p);

/* Starts from a frame: its time and its fields, with a note of those that it lacks and a run can begin without. */
int tled_problem_start(tled_problem *p, const frame *f, notes *warnings, err *e);

/* The share of an element that is tissue. */
static inline double tled_fraction(const tled_problem *p, int64_t element)
{
    return p->fraction ? (double)p->fraction[element] : 1;
}

/* The moments of an element that is cut (cut.h), or NULL. */
static inline const float *tled_cut(const tled_problem *p, int64_t element)
{
    return p->cut.count ? cut_moments_at(&p->cut, element) : NULL;
}

/* What gravity acts on, kg. */
static inline double tled_weight(const tled_problem *p, int64_t node)
{
    return p->weight ? p->weight[node] : p->mass[node];
}

/* The same in parts of the node's mass. */
static inline double tled_weight_part(const tled_problem *p, int64_t node)
{
    return tled_weight(p, node) / p->mass[node];
}

/* The second volume of an element, or -1. */
static inline int32_t tled_mix(const tled_problem *p, int64_t element)
{
    return p->mix ? p->mix[element] : -1;
}

/* Its share of the tissue; 0 where there is none. */
static inline double tled_mixture(const tled_problem *p, int64_t element)
{
    return tled_mix(p, element) < 0 ? 0 : (double)p->mixture[element];
}

/* What is known of the border in an element that is a laminate: LAMINATE_NUMBERS (element_laminate.h); or NULL. */
static inline const double *tled_border(const tled_problem *p, int64_t element)
{
    const int64_t row = p->borders.count ? borders_at(&p->borders, element) : -1;
    return row < 0 ? NULL : p->border + LAMINATE_NUMBERS * row;
}

/* The law of an element: its volume's, or one between its two volumes'. */
static inline tled_law tled_law_of(const tled_problem *p, int64_t element)
{
    return p->mixed && p->mixed[element] >= 0 ? p->law[p->mixed[element]] : p->volume[p->element_volume[element]].law;
}

/* The activation of the muscle that a volume is, 0 to 1; 0 where none contracts. */
double tled_activation(const tled_problem *p, int32_t volume, const double *value);

/* The active stress of a volume (Pa): activation times peak, over the optimum; value: of all curves. */
double tled_tension(const tled_problem *p, int32_t volume, const double *value);

/* What the contractile element of a volume's muscle may lose of the fibre's stretch in a step of dt (s). */
static inline double tled_contractile_most(const tled_volume *v, double dt)
{
    return v->muscle[MUSCLE_FASTEST] * dt;
}

/* The sum of what acts on node n from outside (N, 3): gravity, forces, tractions and springs. value: all curves'
 * values, 3 a curve; u: its displacement (3, m). */
void tled_external(const tled_problem *p, const double *value, const double *u, int64_t n, double *force);

/* The values of all curves at a time, 3 a curve. */
void tled_curves(const tled_problem *p, double time, double *value);

#endif
