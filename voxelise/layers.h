/* Layers from the skin inward (epidermis, dermis, hypodermis): voxels of level 0 whose centre is nearer to the surface
 * than the thickness of the layers so far become volumes of their own; by shares, samples of voxels do. The surface is
 * what bounds level 0 and is not rigid by name; voxels of higher levels (muscles) stay what they are. The caller owns a
 * layers.
 */
#ifndef SINEW_LAYERS_H
#define SINEW_LAYERS_H

#include "base/num.h"
#include "voxelise/depths.h"
#include "voxelise/volumes.h"
#include "voxelise/voxels.h"

typedef struct layers_layer {
    char *name;              /* owned */
    double thickness, depth; /* of its lower side below the surface; in the OBJ's unit */
    int32_t material;
} layers_layer;

typedef struct layers {
    layers_layer *layer; /* from the surface inward */
    int64_t layers, capacity;
} layers;

/* From a file of lines `NAME thickness=LENGTH material=MATERIAL`. A length without a suffix is in `unit`, the OBJ's; a
 * layer that names no material takes the one of its own name, else the first. No name may be a volume's. */
int layers_read(layers *l, in *file, num_unit unit, const volumes *plan, const model *materials, err *e);
void layers_free(layers *l);

/* Gives voxels to the layers, unless they are by shares and have them, and adds the layers to the plan: after level 0,
 * with priorities that follow its own. g: the lattice of voxels. */
int layers_apply(const layers *l, voxels *x, volumes *plan, const obj *o, const grid *g, pool *threads, err *e);

/* What voxels_find and its rule borrow of the layers. It holds pointers into itself, so it must not be copied. g: the
 * lattice of samples, so many along a voxel; m has materials. -1 with e filled. */
typedef struct layers_samples {
    voxels_strata strata;
    double *modulus; /* shares_rule's; owned, as are: */
    double *corner;
    depths *made;
    depths_surface surface;
    double depth[DEPTHS_MOST];
} layers_samples;

int layers_sample(layers_samples *to, const layers *l, const volumes *plan, const model *m, const obj *o, const grid *g,
                  int samples, err *e);
void layers_samples_free(layers_samples *s);

/* Adds element.normal to the model that was built of such voxels: of the elements of the layers, also where these are
 * only the second volume. plan: with the layers. Outward is away from most of these elements, whichever way the skin's
 * polygons are turned. */
int layers_normals(const layers *l, const volumes *plan, const obj *o, const grid *g, model *m, pool *threads, err *e);

/* Of a plan that has the layers: which of them a volume is, or -1. */
int64_t layers_at(const layers *l, const volumes *plan, int32_t volume);

/* How thick one is, in the OBJ's unit. */
double layers_thickness(const layers *l, int64_t layer);

/* Whether it is thinner than a voxel is long. g: the lattice of voxels. */
bool layers_is_thin(const layers *l, int64_t layer, const grid *g);

#endif
