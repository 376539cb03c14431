/* Files of one run that appear together: each is written beside its place, and all are put there once it is known that
 * the run went well, so that a run that fails leaves the files of an earlier one as they were. Each keeps a descriptor
 * as long as there are enough, since a file without a name is gone when the process is. The caller owns the struct;
 * begin with a zeroed one.
 */
#ifndef SINEW_OUTS_H
#define SINEW_OUTS_H

#include "base/out.h"

typedef struct outs_file outs_file;

typedef struct outs {
    outs_file *first, *last; /* owned */
    outs_file *open;         /* the first that may have a descriptor */
    int64_t descriptors;     /* from there on */
    int64_t most;            /* to have; 0: not known yet */
} outs;

/* Opens the next file, which is to appear as path; a link stays a link. The caller closes it (out_close) or gives it up
 * (out_discard) as any other out. NULL with e filled. */
out *outs_open(outs *s, const char *path, err *e);

/* Puts every file in its place, in the order in which they were opened, and waits until their names
 * are stored. All must have been closed. */
int outs_commit(outs *s, err *e);

/* Removes the files that are not in their places. */
void outs_free(outs *s);

#endif
