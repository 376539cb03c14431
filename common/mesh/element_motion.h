/* How the elements of a model move in a frame: the displacement gradient of each, its volume at rest and its hourglass
 * modes, from the displacements of its nodes: of a box of the lattice, of any other hexahedron, of a tetrahedron. The
 * gradients are those of tled-run (element.h, element_any.h). Borrows the arrays of the model and of the frame.
 */
#ifndef SINEW_ELEMENT_MOTION_H
#define SINEW_ELEMENT_MOTION_H

#include "mesh/cut_moments.h"
#include "model/materials.h"
#include "physics/element_any.h"
#include "physics/element_laminate.h"

typedef struct element_mesh {
    const int32_t *node; /* elements x corners, VTK order */
    int corners;         /* 8 or 4 */
    int64_t elements;
    const double *rest;    /* nodes x 3, m */
    bool is_lattice;       /* hexahedra, all boxes of `side` */
    double side[3];        /* m */
    cut_moments cut;       /* of boxes: whose gradient is its mean over what is enclosed */
    borders borders;       /* of boxes that are laminates */
    const float *fraction; /* elements: what is enclosed of them; or NULL */
} element_mesh;

typedef struct element_motion {
    element_tensor
        h;         /* grad u: at the centre; its mean over an element that is no box, or over the part of a cut one */
    double volume; /* m3, at rest */
    /* Of hexahedra: */
    hourglass_modes modes;
    element_modes along[3]; /* of boxes: of each component, m */
    double squares;         /* 1/m2: sum of B^2 over corners and axes */
    element_any any;        /* where it is no box */
} element_motion;

/* -1 with e filled where the model lacks what it takes. */
int element_mesh_of(element_mesh *to, const model *m, err *e);

/* u: nodes x 3, m. Not finite where a tetrahedron is flat. */
element_motion element_motion_of(const element_mesh *m, int64_t element, const double *u);

/* The state of the two parts of a laminate element (element_laminate.h). */
typedef struct laminate_motion {
    enum form form;
    double c[2][FORM_NUMBERS]; /* coefficients of the parts, by their shares */
    element_law law;           /* between the two, with modes' stiffness as it is at the mean F */
    laminate_state is;
} laminate_motion;

/* False: the element is none. control: of the run that moved it. */
bool laminates_at(const element_mesh *mesh, const materials_map *map, hourglass_control control, int64_t element,
                  const element_motion *motion, laminate_motion *to);

/* P (Pa) times F^T, of both parts: over J at the mean F their Cauchy stress, by the volumes that they have now. */
element_tensor laminates_stress(const laminate_motion *of);

/* Of part 0 or 1, J/m3, by the volume of the whole at rest. */
double laminates_energy(const laminate_motion *of, int part);

#endif
