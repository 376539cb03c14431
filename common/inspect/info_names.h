/* `sinew info --get` for lists of names: arrays of strings, and the names of muscles, surfaces, groups, arrays and
 * keys of materials, which have no array of their own. Keys are described in sinew-info(1).
 */
#ifndef SINEW_INFO_NAMES_H
#define SINEW_INFO_NAMES_H

#include "base/out.h"
#include "model/source.h"

/* The key of the muscles' names, which are those of their volumes. */
#define INFO_NAMES_MUSCLES "muscle.name"

/* The key of the materials' keys: NAME.KEY. */
#define INFO_NAMES_KEYS "material.key"

/* Writes the names, one a line, with control characters and bytes that are not UTF-8 as \xHH (chars_show). 1: the key
 * names no list; -1: e filled. */
int info_names(const source *s, const char *key, out *to, err *e);

#endif
