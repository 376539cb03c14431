/* What nodes have of their elements: the mean of the values of the elements round each, or the least. Owns nothing.
 */
#ifndef SINEW_NODE_VALUES_H
#define SINEW_NODE_VALUES_H

#include "model/model.h"

typedef enum node_values_rule { NODE_MEAN, NODE_LEAST } node_values_rule;

/* node: element.node; value: a number an element, nan: it has none; to: nodes, nan where no element has one. -1 with e
 * filled on no memory. */
int node_values(const model_array *node, const double *value, node_values_rule rule, double *to, int64_t nodes, err *e);

#endif
