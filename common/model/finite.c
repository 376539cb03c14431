#include "model/finite.h"

#include <inttypes.h>

enum { NEEDED = 4 };

/* How many of them are different, up to those needed. */
static int different(const int32_t *node, int count)
{
    int found = 0;
    for (int i = 0; i < count && found < NEEDED; i++) {
        bool new = true;
        for (int k = 0; k < i; k++)
            new = new &&node[k] != node[i];
        found += new;
    }
    return found;
}

int finite_elements(const model *m, const char *where, err *e)
{
    const model_array *node = model_find(m, "element.node");
    for (int64_t i = 0; node && i < node->rows; i++) {
        int count = different(&node->i32[i * node->columns], node->columns);
        if (count < NEEDED)
            return err_set(e, where, where ? model_line(node, i) : 0,
                           "element.node, row %" PRId64 " has %d different node%s; expected %d or more", i, count,
                           count == 1 ? "" : "s", NEEDED);
    }
    return 0;
}
