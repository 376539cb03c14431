#include "slice/image/slice_lanes.h"

#include "solve/vectors.h"

const slice_lanes *slice_lanes_choose(err *e)
{
    static const slice_lanes *const all[] = {
#if defined(__x86_64__)
        &slice_lanes_avx512,
        &slice_lanes_avx2,
#endif
        &slice_lanes_plain,
        NULL
    };
    for (int i = 0; all[i]; i++)
        if (vectors_are(all[i]->name))
            return all[i];
    vectors_none(e);
    return NULL;
}
