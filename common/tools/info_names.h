/* `sinew info --get` of lists of names: arrays of strings, and what a model names without such an array (its muscles, surfaces and
 * arrays). Keys are described in sinew-info(1).
 */
#ifndef SINEW_INFO_NAMES_H
#define SINEW_INFO_NAMES_H

#include "base/out.h"
#include "model/source.h"

/* The key of the muscles' names, which are those of their volumes. */
#define INFO_NAMES_MUSCLES "muscle.name"

/* Writes the names, each a line that ends, bytes that are no text of one line as \xHH (chars_show). 1: the key is of no list;
 * -1: e filled. */
int info_names(const source *s, const char *key, out *to, err *e);

#endif
