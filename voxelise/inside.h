/* The inside test: which centres lie inside each volume (W&M section 3). A centre is inside where a ray to it from
 * outside crosses the volume's triangles an odd number of times. Rays run along one axis, through every column of
 * centres; each triangle is drawn, row by row, onto the columns that cross it, and turns over one bit a column, at the
 * cell that follows the crossing; then each bit is added to the one before it along the ray, so nothing is sorted and
 * nothing searched. This is done in slabs of a few layers of rows, with one bit a cell of each volume's box.
 *
 * The caller owns an inside, which borrows grid and triangles, and one slab a thread. Any number of threads may look at
 * slabs at once.
 */
#ifndef SINEW_INSIDE_H
#define SINEW_INSIDE_H

#include "base/pool.h"
#include "voxelise/surfaces/crossing.h"

/* Triangles of closed volumes, in the grid's unit: all borrowed. */
typedef struct inside_triangles {
    const double *position; /* vertices x 3 */
    int64_t vertices;
    const int32_t *vertex; /* triangles x 3 */
    const int32_t *volume; /* triangles: the volume that each bounds, in ascending order */
    int64_t triangles;
} inside_triangles;

/* The cells low <= i < high along each axis. */
typedef struct inside_box {
    int32_t low[3], high[3];
} inside_box;

typedef struct inside {
    inside_triangles t;
    crossing_mesh mesh;
    double *cell; /* of mesh */
    int32_t *first;
    int32_t volumes;
    inside_box *box; /* volumes: what is inside is in it */
    int64_t layers;  /* of rows in a slab */
    int64_t slabs;
    int64_t *start;     /* slabs + 1: the first of a slab's triangles */
    uint32_t *triangle; /* slab after slab, each in the order that they were given in */
} inside;

/* Rays run along `ray`; rows along ray + 1, the bits of a word along ray + 2 (mod 3). A slab has a multiple of so many
 * layers. */
int inside_create(inside *test, const grid *g, const inside_triangles *t, int ray, int multiple, pool *threads, err *e);
void inside_free(inside *test);

/* One volume in a slab: bit b of word w of a layer and a cell along the ray is the cell low of the grid +
 * 64 (word + w) + b along the bits' axis. */
typedef struct inside_part {
    int32_t volume;
    inside_box box; /* the volume's, cut to the slab; along the bits' axis to whole words */
    int64_t word, words;
    uint64_t *bits; /* layers x cells along the ray x words */
} inside_part;

typedef struct inside_slab {
    inside_part *part; /* by volume */
    int64_t parts, part_capacity;
    uint64_t *bits;
    int64_t capacity;
} inside_slab;

/* Fills a slab, whatever it held; begin with a zeroed one. Its rows are low of the grid + number * layers and so on. */
int inside_look(const inside *test, int64_t number, inside_slab *slab, err *e);
void inside_slab_free(inside_slab *slab);

/* Takes the columns from <= i < to of a row, whose rays cross a triangle in this plane. */
typedef void inside_crossing(void *context, int64_t triangle, const crossing_plane *plane, int32_t row, int32_t from,
                             int32_t to);

/* Gives every crossing in a slab, triangle after triangle; but for those beyond the lattice's last cell along the
 * ray. */
void inside_cross(const inside *test, int64_t number, inside_crossing *take, void *context);

/* The words of one layer and cell along the ray, both within the part's box. */
static inline uint64_t *inside_words(const inside *test, const inside_part *p, int64_t layer, int64_t along)
{
    int ray = test->mesh.ray, row = test->mesh.row;
    int64_t cells = p->box.high[ray] - p->box.low[ray];
    return p->bits + ((layer - p->box.low[row]) * cells + along - p->box.low[ray]) * p->words;
}

/* Bytes that a slab may come to, for one thread. */
double inside_slab_bytes(const inside *test);

#endif
