/* What msds-run solves, as flat arrays: the problem, which no executor changes, made from a tetrahedral model. The
 * caller owns the problem; it borrows the model's arrays, which must outlive it. Who computes it: msds_executor.h.
 *
 * The solvers are the mass-spring-damper system of PST's appendix, and their FEM: isotropic linear elasticity with
 * Cauchy's strain, quasi-static, by conjugate gradients from the frame before, or exactly.
 */
#ifndef SINEW_PROBLEM_H
#define SINEW_PROBLEM_H

#include "model/model.h"
#include "msds/problem/cavity.h"
#include "msds/problem/simplex.h"
#include "probe/probe.h"

typedef enum msds_method { MSDS_SPRINGS, MSDS_FEM, MSDS_EXACT, MSDS_TISSUE } msds_method;

typedef struct msds_spring {
    int32_t node[2];                /* ascending */
    double rest, stiffness, damper; /* m, N/m, N s/m */
} msds_spring;

/* What the command line says of the problem. */
typedef struct msds_options {
    double scale;      /* m: a spring's stiffness over its tetrahedron's Young's modulus; 0: by the mesh (auto) */
    double damping;    /* s: a spring's damping over its stiffness */
    double gravity[3]; /* m/s2 */
    double repulsion;  /* contact stiffness of a node over that of its springs together */
    double friction;   /* Coulomb's, of the FEM's and tissue's contact */
    bool penalty;      /* the FEM's contact is a penalty of that stiffness; else the displacement is prescribed */
} msds_options;

typedef struct msds_problem {
    int64_t nodes, elements, springs;
    const double *position;      /* nodes x 3, m */
    const int32_t *element_node; /* elements x 4 */
    const int32_t *volume;       /* elements: the model's volume that each is of */
    simplex *element;            /* elements; owned, as is all below */
    double *young;               /* elements, Pa */
    uint8_t *fixed;              /* nodes */
    double *repulsion;           /* nodes, N/m: of contact, by springs or a penalty */
    double *weight;              /* nodes, kg: lumped masses, which gravity acts on */
    double mass_factor;          /* inertia over weight */
    msds_spring *spring;         /* springs, by their nodes */
    double *displacement;        /* nodes x 3, m: at the start */
    double *velocity;            /* nodes x 3, m/s */
    double side;                 /* m: that a cell of five tetrahedra has in the mean */
    double scale;                /* m: what was taken */
    double slight;               /* N2: the square of a load that is as good as none, which strains by 1e-8 */
    msds_options options;
    const msds_cavity *cavity; /* cavities; the caller's, which outlive states: only their pressures change */
    int cavities;
} msds_problem;

/* How far a step that takes long has come. */
typedef struct msds_progress {
    const char *what; /* "solving" */
    double share;     /* of that, 0 to 1 */
    int solve;        /* of the frame, from 1; 0: none yet */
    double residual;  /* after the solve before; nan: not known yet */
    int64_t contacts; /* nodes near the probe */
} msds_progress;

/* Whom a step tells of it meanwhile, in the thread that steps. The exact frames of a card are one launch, and tell
 * nothing. */
typedef struct msds_listener {
    void (*at)(void *context, const msds_progress *now);
    void *context;
} msds_listener;

typedef struct msds_plan {
    msds_method method;
    bool warp;      /* the FEM takes each element's rotation out */
    double dt;      /* s: of one step of springs */
    double elapsed; /* s: that the move takes; 0: not known */
    bool touched;
    probe_placed probe;            /* where touched */
    const msds_listener *listener; /* NULL: nobody */
} msds_plan;

/* What the monitor reads of a state. */
typedef struct msds_reading {
    double force[3];  /* N: on the probe */
    double torque[3]; /* N m: on it, about its frame's origin */
    int64_t contacts; /* nodes that it presses */
    double residual;  /* |external - internal forces| over the largest of |external|, |internal| and a force that is
                       * slight for the tissue; or nan */
    double largest;   /* m: the largest displacement */
    int64_t inverted; /* tetrahedra of no volume, or less; -1: not counted */
    int solves;       /* that an exact frame took */
    bool finite;
    bool met; /* the probe has pressed a node in some step since the state was made */
} msds_reading;

/* Makes p (zeroed) of the model at rest. -1 with e filled, and p to be freed all the same, for a model of other
 * elements, an element that is inverted or flat, and materials that are no such. */
int msds_problem_make(msds_problem *p, const model *m, const msds_options *o, err *e);
void msds_problem_free(msds_problem *p);

/* Takes other options. The springs stay where they are, so that others may read their nodes meanwhile. */
void msds_problem_change(msds_problem *p, const msds_options *o);

/* Starts from a frame: its displacement and velocity (none: at rest). */
int msds_problem_start(msds_problem *p, const frame *f, err *e);

#endif
