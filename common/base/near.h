/* Finds the known name that is nearest to an unknown one, and words the message that says so. Keeps nothing.
 */
#ifndef SINEW_NEAR_H
#define SINEW_NEAR_H

#include "base/err.h"

#include <stddef.h>

/* Of `count` names the one nearest to name (edit distance at most a third of its length, at least 1), or -1. */
int near_name(const char *name, const char *const *names, int count);

/* The names between commas into `to`, as many as fit: ", ..." stands for the rest. */
void near_list(char *to, size_t size, const char *const *names, int count);

/* "unknown WHAT 'name'; did you mean 'near'? expected one of: a, b, c" as an error at place:line. Where none is near,
 * those that begin with the name are offered, three at most. Says so where there are no names at all; long lists are
 * cut. Returns -1. */
int near_unknown(err *e, const char *place, int64_t line, const char *what, const char *name, const char *const *names,
                 int count);

/* The same of a name on the command line, as err_option. */
int near_option(err *e, const char *option, const char *what, const char *name, const char *const *names, int count);

#endif
