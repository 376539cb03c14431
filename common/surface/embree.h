/* A bounding volume hierarchy of boxes, faces or spheres: the one user of Embree, and the one file that knows which of
 * its versions this is. Faces and spheres are met by packets of rays; boxes only overlap, as candidates.c needs it. The
 * creator owns it. Once committed, any number of threads may ask at once.
 */
#ifndef SINEW_EMBREE_H
#define SINEW_EMBREE_H

#include "base/err.h"

#include <stdalign.h>

typedef struct embree embree;

/* Gives the box of one item. Called from several threads. */
typedef void embree_box(const void *context, uint32_t item, float *low, float *high);
/* Takes two items whose boxes overlap. Called from several threads. */
typedef void embree_take_pair(void *context, uint32_t one, uint32_t other);

enum { EMBREE_RAYS = 16 };
#define EMBREE_NONE UINT32_MAX

/* A packet of rays and what they met: Embree's own layout, so that nothing is copied. */
typedef struct embree_packet {
    alignas(64) float from[3][EMBREE_RAYS];
    float start[EMBREE_RAYS];    /* where a ray begins, in multiples of along */
    float along[3][EMBREE_RAYS]; /* any length but zero */
    float time[EMBREE_RAYS];     /* Embree's */
    float end[EMBREE_RAYS];      /* where it ends; then where it met something */
    uint32_t mask[EMBREE_RAYS];  /* Embree's, as are the next two: embree_packet_clear sets them */
    uint32_t id[EMBREE_RAYS], flags[EMBREE_RAYS];
    float normal[3][EMBREE_RAYS]; /* of the face or sphere, any length */
    float u[EMBREE_RAYS], v[EMBREE_RAYS];
    uint32_t item[EMBREE_RAYS];     /* the face or sphere of a geometry */
    uint32_t geometry[EMBREE_RAYS]; /* EMBREE_NONE: nothing */
    uint32_t instance[EMBREE_RAYS];
} embree_packet;

/* threads: for building only. NULL with e filled. */
embree *embree_create(int threads, err *e);
void embree_destroy(embree *b);

/* Each adds one geometry; the first is number 0. -1 with e filled. context must live until embree_commit returns;
 * faces and spheres are copied. Faces have 3 or 4 corners, and their [u, v] is as Embree has it. */
int embree_add_boxes(embree *b, int64_t count, embree_box *box, const void *context, err *e);
int embree_add_faces(embree *b, int corners, int64_t vertices, const float *position, int64_t faces,
                     const uint32_t *corner, err *e);
int embree_add_spheres(embree *b, int64_t count, const float *centre_radius, err *e);
int embree_commit(embree *b, err *e);

/* Gives every two items of a scene of boxes only whose boxes overlap, once, the lower number first. */
void embree_pairs(const embree *b, embree_take_pair *take, void *context);

/* All rays as if unused: from 0 without end, and nothing met. */
void embree_packet_clear(embree_packet *p);

/* The nearest thing that each ray whose bit of valid is set meets. coherent: the rays run much the same way. */
void embree_nearest(const embree *b, unsigned valid, embree_packet *p, bool coherent);

/* Whether a ray meets anything at all: its end becomes -infinity. */
void embree_blocked(const embree *b, unsigned valid, embree_packet *p, bool coherent);

#endif
