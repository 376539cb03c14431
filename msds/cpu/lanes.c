#include "msds/cpu/lanes.h"

#include "base/mem.h"

#include <stdlib.h>

#define LANES_TABLE(set, name, bytes, has) [VECTORS_##set] = &lanes_##set,
const lanes *const lanes_all[VECTORS_COUNT] = {VECTORS_SETS(LANES_TABLE)};

const lanes *lanes_choose(err *e)
{
    const int set = vectors_choose(e);
    return set < 0 ? NULL : lanes_all[set];
}

int lanes_field_make(lanes_field *f, int64_t nodes, err *e)
{
    const int64_t each = nodes + 2 * LANES;
    f->memory = mem_array(3 * each, sizeof *f->memory, "the solver", e);
    for (int a = 0; a < 3 && f->memory; a++)
        f->x[a] = f->memory + a * each + LANES;
    return f->memory ? 0 : -1;
}

void lanes_field_free(lanes_field *f)
{
    free(f->memory);
    *f = (lanes_field){0};
}
