/* The CPU executors of tled-run, in its two precisions. Each is complete in itself; a state belongs to who created
 * it. */
#ifndef SINEW_CPU_H
#define SINEW_CPU_H

#include "tled/problem/tled_executor.h"

extern const tled_executor tled_cpu_double, tled_cpu_single;               /* of boxes of a lattice */
extern const tled_executor tled_cpu_meshes_double, tled_cpu_meshes_single; /* of any hexahedra */

#endif
