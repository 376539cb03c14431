/* Regions of a label image: one for each of the named volumes, from 1, and 0 for all else. The share of a region at a
 * place is that of the voxels around it, weighted by a cubic B-spline of the distance (Unser, IEEE Signal Processing
 * Magazine 16(6), 1999), so that the steps of voxels do not show; the region of a place is the one of the largest
 * share. The creator owns it.
 */
#ifndef SINEW_MESH_REGIONS_H
#define SINEW_MESH_REGIONS_H

#include "msds/mesh/mesh_chosen.h"

enum { MESH_REGIONS = 32 /* volumes at most */, MESH_REGION_BYTES = 1 };

typedef struct mesh_regions {
    volume place; /* the image's geometry; no voxels, no names */
    volume_finder finder;
    uint8_t *voxel;                   /* the region of each */
    int count;                        /* regions, 0 among them */
    mesh_chosen of[MESH_REGIONS + 1]; /* the labels of each but 0 */
} mesh_regions;

/* Makes r (zeroed) of names or numbers of labels between commas; of labels with one name, one region. Takes
 * MESH_REGION_BYTES a voxel. where: the image's name. -1 with e filled, and to be freed all the same: a usage error, no
 * memory, labels that are not whole numbers. */
int mesh_regions_make(mesh_regions *r, const char *list, const volume *labels, const char *where, err *e);
void mesh_regions_free(mesh_regions *r);

/* The region of a place, m. r: a mesh_regions. */
int mesh_regions_at(const void *r, const double place[3]);

/* The direction in which the share of the largest region at a place falls most, against that of the next; of length 1,
 * or 0 where there is one region alone. Returns the difference of their shares, 0 to 1. */
double mesh_regions_normal(const mesh_regions *r, const double place[3], double to[3]);

/* The label at a place that is of a region: of region 0, what most voxels around it have that are of it. */
int64_t mesh_regions_label(const mesh_regions *r, const volume *labels, const double place[3], int region);

#endif
