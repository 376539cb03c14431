/* The words for methods, as --method, the lines `method NAME` and records have them, and which solver each means. Owns
 * nothing.
 */
#ifndef SINEW_METHODS_H
#define SINEW_METHODS_H

#include "msds/problem/problem.h"
#include "solve/executor.h"

/* In the order of --method's choices. */
#define METHODS_CHOICES "msds|fem|exact|warp|exact-warp|tissue"
typedef enum method_word {
    METHOD_MSDS,
    METHOD_FEM,
    METHOD_EXACT,
    METHOD_WARP,
    METHOD_EXACT_WARP,
    METHOD_TISSUE,
    METHOD_WORDS
} method_word;

extern const char *const methods_words[METHOD_WORDS];

/* The method of this name, or -1. */
int methods_find(const char *word);

msds_method methods_solver(method_word method);
bool methods_warps(method_word method);

/* What it takes of an executor: EXECUTOR_*, solve/executor.h. */
uint32_t methods_features(method_word method);

/* The same with what --exact and --warp add to finite elements. */
method_word methods_with(method_word method, bool exact, bool warp);

#endif
