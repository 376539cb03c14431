#include "solve/vectors.h"

#include <stdlib.h>
#include <string.h>

static bool has(int set)
{
#define HAS(set, name, bytes, has) [VECTORS_##set] = (has),
    const bool all[VECTORS_COUNT] = {VECTORS_SETS(HAS)};
    return all[set];
}

bool vectors_can(int set)
{
#define NAME(set, name, bytes, has) [VECTORS_##set] = (name),
    static const char *const names[VECTORS_COUNT] = {VECTORS_SETS(NAME)};
    const char *wanted = getenv("SINEW_VECTORS");
    return has(set) && (!wanted || !*wanted || !strcmp(wanted, names[set]));
}

int vectors_choose(err *e)
{
    for (int set = 0; set < VECTORS_COUNT; set++)
        if (vectors_can(set))
            return set;
    const char *wanted = getenv("SINEW_VECTORS");
    err_set(e, "SINEW_VECTORS", 0, "'%.100s' is not available here; expected plain, AVX2 or AVX-512",
            wanted ? wanted : "");
    return -1;
}
