#include "slice/image/slice_lanes.h"

const slice_lanes *slice_lanes_choose(err *e)
{
#define SLICE_LANES_TABLE(set, name, bytes, has) [VECTORS_##set] = &slice_lanes_##set,
    static const slice_lanes *const all[VECTORS_COUNT] = {VECTORS_SETS(SLICE_LANES_TABLE)};
    const int set = vectors_choose(e);
    return set < 0 ? NULL : all[set];
}
