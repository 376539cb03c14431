/* `sinew info --get quality.KEY`: which elements of a model are folded, by J = det F (mesh/quality.h), in the frame
 * read last, or at rest where there are none; and what share of energy hourglass control holds. Keys are described in
 * sinew-info(1).
 */
#ifndef SINEW_INFO_QUALITY_H
#define SINEW_INFO_QUALITY_H

#include "base/out.h"
#include "mesh/quality.h"
#include "model/source.h"

enum { INFO_QUALITY_KEYS = 6 };

extern const char *const info_quality_keys[INFO_QUALITY_KEYS];

/* The unit of a key's value, "" for numbers without one; NULL: it is no key. */
const char *info_quality_unit(const char *key);

/* What was seen in the frame read last, so that several keys take one look at its elements. Begin with a zeroed one. */
typedef struct info_quality_seen {
    int64_t looks; /* the source's frames when it was looked at, and 1; 0: never */
    bool is_known;
    quality of;
} info_quality_seen;

/* Writes the value, without a line end. 1: it is no key; -1 with e filled. */
int info_quality(const source *s, info_quality_seen *seen, const char *key, out *to, err *e);

/* The frame's elements. False: it has no such, or no displacement. */
bool info_quality_look(const source *s, quality *to);

#endif
