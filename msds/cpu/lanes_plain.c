/* The loops for any machine. */
#define LANES_TABLE lanes_plain
#define LANES_NAME  "plain"
#include "msds/cpu/lanes_loops.h"
