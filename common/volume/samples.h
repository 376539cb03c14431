/* Boxes of a volume's voxels as floats, for what is computed on them; and where labels lie. Memory is the caller's.
 */
#ifndef SINEW_SAMPLES_H
#define SINEW_SAMPLES_H

#include "volume/volume.h"

typedef struct samples_box {
    int64_t low[3], high[3]; /* voxels: low to high - 1 */
} samples_box;

typedef struct samples_label {
    int64_t value, count; /* voxels */
    samples_box box;
} samples_label;

enum { SAMPLES_LABELS = 65536 };

samples_box samples_whole(const volume *v);
int64_t samples_count(const samples_box *b);

/* The box with `by` voxels more on each side, as far as the volume goes. */
samples_box samples_wider(const volume *v, const samples_box *b, const int64_t by[3]);

/* The voxels of a box, x fastest. */
void samples_take(const volume *v, const samples_box *b, float *to);

/* 1 where a voxel has the value, else 0. */
void samples_mark(const volume *v, const samples_box *b, int64_t value, float *to);

/* Every value but 0 that there is, ascending; the caller frees *list. Returns how many, or -1 with e filled: voxels
 * that are no whole numbers, more than SAMPLES_LABELS values. */
int64_t samples_labels(const volume *v, samples_label **list, err *e);

/* Gaussian filter of samples, size[0] fastest; sigma in samples, 0: not along that axis.
 * Beyond the ends it goes on as at the ends.
 */
int samples_filter(float *value, const int64_t size[3], const double sigma[3], err *e);

/* The same of planes across z that need not all be there at once: those of z `from` to `to` - 1 are given one after
 * another, filtered, and no plane is taken after one that is `samples_reach` before it was given. Takes
 * samples_planes_bytes of memory. */
typedef struct samples_planes {
    void (*take)(void *context, int64_t z, float *plane);
    void (*give)(void *context, int64_t z, const float *plane);
    void *context;
} samples_planes;

int samples_filter_planes(const samples_planes *p, const int64_t size[3], const double sigma[3], int64_t from,
                          int64_t to, err *e);
double samples_planes_bytes(const int64_t size[3], const double sigma[3]);

/* How far the filter reaches. */
int64_t samples_reach(double sigma);

#endif
