/* The names of the files that are written for one image, and that none of them is another's. Owns nothing. */
#ifndef SINEW_SLICE_FILES_H
#define SINEW_SLICE_FILES_H

#include "cli/tool.h"
#include "slice/image/slice_write.h"

/* The file of --cut for an image, of its pattern or name; the caller frees it. NULL with e filled. */
char *slice_files_cut(const char *pattern, int64_t index, err *e);

/* That the files of an image are none that is read, nor each other: -1 with e filled. cut: of --cut, or NULL. */
int slice_files_check(const tool *t, const slice_writer *w, const char *cut, int64_t index, err *e);

#endif
