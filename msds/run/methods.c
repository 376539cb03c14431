#include "msds/run/methods.h"

#include <string.h>

const char *const methods_words[METHOD_WORDS] = {"msds", "fem", "exact", "warp", "exact-warp", "tissue"};

static const msds_method solver[METHOD_WORDS] = {MSDS_SPRINGS, MSDS_FEM, MSDS_EXACT, MSDS_FEM, MSDS_EXACT, MSDS_TISSUE};

int methods_find(const char *word)
{
    for (int i = 0; i < METHOD_WORDS; i++)
        if (!strcmp(word, methods_words[i]))
            return i;
    return -1;
}

msds_method methods_solver(method_word method)
{
    return solver[method];
}

bool methods_warps(method_word method)
{
    return method == METHOD_WARP || method == METHOD_EXACT_WARP;
}

uint32_t methods_features(method_word method)
{
    if (method == METHOD_TISSUE)
        return EXECUTOR_TISSUE;
    return methods_warps(method) ? EXECUTOR_WARP : 0;
}

method_word methods_with(method_word method, bool exact, bool warp)
{
    if (method == METHOD_MSDS || method == METHOD_TISSUE)
        return method;
    exact = exact || solver[method] == MSDS_EXACT;
    warp = warp || methods_warps(method);
    if (exact)
        return warp ? METHOD_EXACT_WARP : METHOD_EXACT;
    return warp ? METHOD_WARP : METHOD_FEM;
}
