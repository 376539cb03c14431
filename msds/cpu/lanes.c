#include "msds/cpu/lanes.h"

#include "base/mem.h"
#include "solve/vectors.h"

#include <stdlib.h>

const lanes *const lanes_all[] = {
#if defined(__x86_64__)
    &lanes_avx512, &lanes_avx2,
#endif
    &lanes_plain, NULL};

const lanes *lanes_choose(err *e)
{
    for (int i = 0; lanes_all[i]; i++)
        if (vectors_are(lanes_all[i]->name))
            return lanes_all[i];
    vectors_none(e);
    return NULL;
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
