/* The place where a ray has met a face or sphere, with what is needed to shade it. Owns nothing.
 */
#ifndef SINEW_SHADE_H
#define SINEW_SHADE_H

#include "render/view.h"

typedef struct surface {
    vec place;
    vec flat, normal;  /* unit, toward the eye: the face's own, and the smooth one */
    vec colour;        /* linear */
    float line;        /* how much of the pixel an edge covers */
    uint32_t geometry; /* its number: meshes, then sets of spheres; EMBREE_NONE: nothing was met */
} surface;

/* Takes down what ray i of a packet met; x, y: its place in the picture. */
void surface_met(const view *v, const embree_packet *p, int i, float x, float y, surface *to);

/* Its linear RGB. ambient, key: how much of the ambient and of the key light comes through to it. */
vec surface_shade(const view *v, const surface *s, float ambient, float key);

/* 0: opaque. */
float surface_transparency(const view *v, const surface *s);

#endif
