/* A file that is written beside its place and put there once it is whole; until then the place is as it was. The file
 * has no name while it is written where the file system can do that (O_TMPFILE), else one of its own. A process that is
 * killed leaves nothing behind, except a file that had a name (kill -9): see temporary.h. The caller owns the struct;
 * begin with a zeroed one.
 */
#ifndef SINEW_REPLACE_H
#define SINEW_REPLACE_H

#include "base/err.h"

typedef struct replace {
    int fd;          /* what to write to; -1: closed */
    char *target;    /* where the file goes, links followed; owned; NULL: nothing is open */
    char *temporary; /* its name until then; owned; NULL while it has none */
} replace;

/* Opens a file that is to appear as path, which is a regular file or none; a link stays a link, even one to nothing.
 * A name that cannot be given is refused now, not after the work. */
int replace_open(replace *r, const char *path, err *e);

/* Waits until every byte of it is known to be stored. name: for messages. -1 with e filled, also where it would replace
 * a file that was read (see inputs.h). */
int replace_settle(replace *r, const char *name, err *e);

/* Closes a file that was settled, which takes a name until it is put in its place: where descriptors are scarce. -1
 * with e filled. */
int replace_park(replace *r, const char *name, err *e);

/* Puts a file that was settled in its place. Its name there is not stored yet. In every case r is zeroed, and on
 * failure no file is left and the place is as it was. */
int replace_place(replace *r, const char *name, err *e);

/* All of it: settles the file, puts it in its place, and waits until its name is stored. In every case r is zeroed, and
 * on failure no file is left and the place is as it was, unless it is the name that could not be stored. */
int replace_finish(replace *r, const char *name, err *e);

/* Waits until what was written is stored: 0, or -1 with errno. Some of what can be written to
 * cannot be synced; nothing is wrong then. */
int replace_store(int fd);

/* Waits until what stands under the names in the folder of a file is stored; path may be a link to the file. name: for
 * messages. A folder that may be written but not read takes names and cannot be synced, and one of a file system that
 * is read-only has none to store; nothing is wrong then. */
int replace_store_names(const char *path, const char *name, err *e);

/* Removes the file. */
void replace_discard(replace *r);

#endif
