#include "mesh/node_values.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>

static void add(double value, node_values_rule rule, double *to, int32_t *count)
{
    if (rule == NODE_LEAST)
        *to = *count ? fmin(*to, value) : value;
    else
        *to += value;
    *count += rule == NODE_MEAN || !*count;
}

int node_values(const model_array *node, const double *value, node_values_rule rule, double *to, int64_t nodes, err *e)
{
    int32_t *count = mem_array(nodes, sizeof *count, "a field", e);
    if (!count)
        return -1;
    for (int64_t n = 0; n < nodes; n++)
        to[n] = 0;
    for (int64_t i = 0; i < node->rows * node->columns; i++)
        if (!isnan(value[i / node->columns]))
            add(value[i / node->columns], rule, &to[node->i32[i]], &count[node->i32[i]]);
    for (int64_t n = 0; n < nodes; n++)
        to[n] = count[n] ? to[n] / count[n] : (double)NAN;
    free(count);
    return 0;
}
