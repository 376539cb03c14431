/* Products with the tangent of a state's elements, by each method: of linear elements a matrix; of springs another,
 * made of them as they stand; of warped elements and of tissue at large strains each element's own derivative. In the
 * solver's order and single precision. The creator owns it; it borrows the parts that it began with.
 */
#ifndef SINEW_TANGENT_PRODUCT_H
#define SINEW_TANGENT_PRODUCT_H

#include "msds/cpu/cg.h"
#include "msds/cpu/msds_cpu.h"
#include "msds/cpu/tissue.h"

typedef struct tangent_product {
    msds_parts of;
    lanes_matrix matrix;     /* of springs; made when they are first asked for */
    const lanes_matrix *has; /* what multiplies; NULL: elements do */
    double *u, *way, *force; /* the model's nodes x 3; with turn: of warped elements, made when first asked for */
    double *turn;            /* elements x 4 */
    bool careful;
    float *inverse; /* nodes: about the inverse of the diagonal, m/N; 0 where fixed */
    double *sum;    /* chunks */
    const lanes_field *from;
    lanes_field *to;
} tangent_product;

/* -1 with e filled, and to be freed all the same. k is zeroed. */
int tangent_product_make(tangent_product *k, const sell *s, err *e);
void tangent_product_free(tangent_product *k);

/* From here on of these parts, as they are; careful: without what springs that are pressed would buckle by, and what
 * turns of warped elements take, so that the matrix is not indefinite. -1 with e filled. */
int tangent_product_begin(tangent_product *k, const msds_parts *of, bool careful, err *e);

/* y = K p; 0 at fixed nodes, where p has to be 0. Returns p . y. */
double tangent_product_of(tangent_product *k, const lanes_field *p, lanes_field *y);

#endif
