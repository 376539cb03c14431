/* The data that muscles are computed from: a model's arrays, its elements sorted by volume, and marks on its nodes. An
 * element mixed of two volumes belongs to both. A body borrows the model's arrays; the muscles own the rest.
 */
#ifndef SINEW_MUSCLE_BODY_H
#define SINEW_MUSCLE_BODY_H

#include <stdbool.h>
#include <stdint.h>

typedef struct body {
    int64_t elements, nodes;
    int32_t columns; /* of node */
    const double *position;
    const int32_t *node, *volume;
    const uint8_t *rigid;
    const int32_t *anchor; /* nodes; NULL: not known */
    const float *fraction; /* elements; NULL: all are whole */
    const int32_t *mix;    /* elements: the second volume, -1 = none; NULL: none has any */
    const float *mixture;  /* elements: its share of what is enclosed; where mix is */
    float *fibre;          /* elements x 3: of the volume */
    float *mixfibre;       /* elements x 3: of the second volume; NULL where mix is */
    int32_t *seen;         /* nodes: the last muscle that counted it */
    float *held;           /* nodes: of its elements of the muscle looked at last, the largest part */
    int32_t *part;         /* nodes: its attachment in the muscle looked at last, -1 = none */
    int64_t *start;        /* volumes + 1: a volume's first place in element */
    int64_t *element;      /* the elements, volume after volume; of one, those that it is the second in come last */
} body;

static inline void body_centre(const body *b, int64_t element, double *centre)
{
    const int32_t *node = &b->node[b->columns * element];
    for (int a = 0; a < 3; a++) {
        centre[a] = 0;
        for (int n = 0; n < b->columns; n++)
            centre[a] += b->position[3 * (int64_t)node[n] + a];
        centre[a] /= b->columns;
    }
}

/* Whether elements have shares of volumes. */
static inline bool body_has_shares(const body *b)
{
    return b->fraction || b->mix;
}

/* Of what is enclosed of an element, the part of a volume that it is of. */
static inline double body_part(const body *b, int64_t element, int32_t volume)
{
    if (!b->mix || b->mix[element] < 0)
        return 1;
    return volume == b->volume[element] ? 1 - (double)b->mixture[element] : (double)b->mixture[element];
}

/* The share of the element. */
static inline double body_share(const body *b, int64_t element, int32_t volume)
{
    return (b->fraction ? (double)b->fraction[element] : 1) * body_part(b, element, volume);
}

/* The fibre that an element has of a volume, which it is of. */
static inline float *body_fibre(const body *b, int64_t element, int32_t volume)
{
    return (volume == b->volume[element] ? b->fibre : b->mixfibre) + 3 * element;
}

/* A set of a forest in which each points to one before it, or to itself. */
static inline int32_t body_root(int32_t *root, int32_t n)
{
    while (root[n] != n)
        n = root[n] = root[root[n]];
    return n;
}

static inline void body_join(int32_t *root, int32_t m, int32_t n)
{
    m = body_root(root, m);
    n = body_root(root, n);
    if (m > n)
        root[m] = n;
    else
        root[n] = m;
}

#endif
