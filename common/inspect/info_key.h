/* `sinew info --get KEY`: one value of a model that has been read to its end. Keys are described in sinew-info(1).
 */
#ifndef SINEW_INFO_KEY_H
#define SINEW_INFO_KEY_H

#include "base/out.h"
#include "inspect/info_quality.h"
#include "model/source.h"

enum { INFO_KEY = 512 };

/* The key in British spelling, in `to`, if it begins with the name of an array only then; else the key itself. Only the
 * array's name is changed: names behind it are the user's. */
const char *info_key_spelled(const source *s, const char *key, char to[INFO_KEY]);

/* Writes the value of the key, without a line end; seen: of keys before, in the same frame or others. Returns 0, or -1
 * with e filled: what is wrong with the key, and what there is. */
int info_key(const source *s, info_quality_seen *seen, const char *key, out *to, err *e);

/* The unit of the key's value, "" for counts, where it is a number or several of the frame read last. NULL with e
 * filled: of anything else. Borrowed from the source. */
const char *info_key_unit(const source *s, const char *key, err *e);

/* The rows of a table: of its columns, arrays of the axis whose names begin with its name and a point; 0 where there
 * are none, whatever the axis counts. */
int64_t info_table_rows(const model *m, const char *axis);

/* How many elements each volume has, by its row in the table; 0 where there are no elements.
 * The caller frees it; NULL with e filled. */
int64_t *info_volume_counts(const model *m, err *e);

#endif
