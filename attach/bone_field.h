/* Distance fields of bone, sampled at corners of voxels: on which nodes slide (slide.h), and which skin may not enter
 * (contact.h). A field is of rigid surfaces that move together. The creator owns a list of them; begin with a zeroed
 * one.
 */
#ifndef SINEW_BONE_FIELD_H
#define SINEW_BONE_FIELD_H

#include "mesh/lattice.h"
#include "model/model.h"
#include "rigid.h"
#include "surface/distance_field.h"

enum { BONE_BEYOND = 8 /* voxels that a field goes beyond what it is for */ };

typedef struct bone_field {
    int32_t body; /* that it moves with, or -1 */
    bool touches; /* skin may not enter it */
    bool *is;     /* rigid surfaces: whether it is of each */
    distance_box box;
    float *value; /* m: above 0 in the tissue */
} bone_field;

typedef struct bone_fields {
    bone_field *of;
    int64_t count, room;
} bone_fields;

/* One more, of no surface yet; or NULL with e filled. */
bone_field *bone_field_add(bone_fields *to, const rigid *r, int32_t body, err *e);

/* Takes the last one back. */
void bone_field_drop(bone_fields *to);
void bone_fields_free(bone_fields *f);

/* In `is`, the rigid surfaces that the names between commas stand for. -1 with e filled, in the option's name. */
int bone_surfaces(const rigid *r, const char *option, const char *text, bool *is, err *e);

/* Where the tissue is that bone is looked at from. */
typedef struct bone_view {
    const uint8_t *chosen; /* nodes: those that tell which side of the bone they are on */
    const double *beside;  /* nodes x 3, m: bone_beside */
    int64_t nodes;
} bone_view;

/* The triangles of these surfaces. Each surface faces the tissue beside the chosen nodes, by more than half of these,
 * or, where it has none, as it is. d is zeroed, and to be freed all the same. -1 with e filled where there is no
 * triangle, or they face different sides. */
int bone_triangles(distance_triangles *d, const rigid *r, const bool *is, const bone_view *from, const char *option,
                   err *e);

/* Of each node the mean of the middles of its elements (x 3, m): in the tissue. NULL with e filled. */
double *bone_beside(const model *m, err *e);

/* The box around lattice corners from low to high, and BONE_BEYOND. */
void bone_field_box(bone_field *f, const lattice *l, const int32_t low[3], const int32_t high[3]);

/* Samples it there. -1 with e filled on no memory. */
int bone_field_sample(bone_field *f, const distance_triangles *d, pool *threads, err *e);

/* Writes the axes field and distance. with_bodies: the model has bodies. */
int bone_fields_write(model *m, const bone_fields *f, bool with_bodies, err *e);

#endif
