/* The loops for any machine. */
#define SLICE_LANES_TABLE slice_lanes_plain
#define SLICE_LANES_NAME  "plain"
#include "slice/image/slice_lanes_loops.h"
