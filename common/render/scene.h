/* A scene, as trace() draws it: meshes of triangles or quadrilaterals and sets of spheres, with linear RGB colours (0
 * to 1). A scene owns its arrays, which are made with mem.h (or malloc) and handed over; scene_free frees them. Zeroed
 * members mean: no label, black, opaque, flat, no edges. Faces are seen from both sides, so their winding does not
 * matter.
 */
#ifndef SINEW_RENDER_SCENE_H
#define SINEW_RENDER_SCENE_H

#include "base/err.h"

typedef struct scene_mesh {
    char *label;             /* owned; what it is, for messages; may be NULL */
    int corners;             /* of every face: 3, or 4 (drawn as two triangles, 0 1 3 and 2 3 1) */
    int64_t vertices, faces; /* each under 2^32 */
    float *position;         /* [vertices][3], m */
    float *normal;        /* [faces][corners][3], any length but zero: smooth (scene_smooth makes them); NULL: flat */
    uint32_t *corner;     /* [faces][corners] */
    float colour[3];      /* where neither of the next two is given */
    float *vertex_colour; /* [vertices][3], blended over a face; or NULL */
    float *face_colour;   /* [faces][3], before vertex_colour; or NULL */
    uint8_t *edges;       /* [faces], bit i: the edge from corner i to the next is drawn; NULL: none */
    float edge_colour[3]; /* of those; their width is trace_options' */
    float transparency;   /* 0 opaque, under 1: what is behind shows through */
} scene_mesh;

typedef struct scene_spheres {
    char *label;          /* owned; may be NULL */
    int64_t count;        /* under 2^32 */
    float *centre_radius; /* [count][4]: x y z r, m */
    float colour[3];
    float *sphere_colour; /* [count][3], or NULL */
} scene_spheres;

typedef struct scene {
    scene_mesh *mesh; /* owned, and what is in them */
    int64_t meshes, mesh_capacity;
    scene_spheres *spheres; /* owned, and what is in them */
    int64_t sphere_sets, sphere_capacity;
} scene;

/* Adds a mesh or set of spheres; its arrays are the scene's from here on, even on failure. */
int scene_add_mesh(scene *s, scene_mesh *m, err *e);
int scene_add_spheres(scene *s, scene_spheres *b, err *e);

/* The box of all faces' corners and spheres; vertices of no face do not count. False: there is nothing to be seen, and
 * the box is as it was. */
bool scene_bounds(const scene *s, double low[3], double high[3]);

/* Gives a mesh smooth normals: at every corner the mean of the normals of the faces around it, weighted by their angles
 * there, but for those that are turned by more than crease degrees from this face (so a box keeps its edges). Faces
 * that are wound the other way are turned, so an inside-out part does no harm. */
int scene_smooth(scene_mesh *m, double crease, err *e);

/* Checks sizes, indices and finite numbers: "label: what is wrong". trace() does so by itself. */
int scene_check(const scene *s, err *e);

void scene_mesh_free(scene_mesh *m);
void scene_free(scene *s);

#endif
