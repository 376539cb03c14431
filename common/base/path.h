/* Paths of files: the folder in one, what a link stands for, what lies beside a file.
 * What is returned is the caller's to free.
 */
#ifndef SINEW_PATH_H
#define SINEW_PATH_H

#include "base/err.h"

#include <stdbool.h>
#include <stddef.h>
#include <sys/stat.h>

/* The length of the folder's part of a path, its last slash included; 0: it has none. */
size_t path_folder(const char *path);

/* The folder (its first n bytes) and name joined. NULL with e filled. */
char *path_join(const char *folder, size_t n, const char *name, err *e);

/* The path of a regular file that an input names, from the input's own path: beside it or in a folder beside it, links
 * followed; no other is opened for an input's asking, and no output replaces it (see inputs.h). place: the input, for
 * messages. NULL with e filled. */
char *path_beside(const char *path, const char *name, const char *place, err *e);

/* Where a file named path would be, links followed, even one to nothing. NULL with e filled where there can be none. */
char *path_target(const char *path, err *e);

/* Looks, links followed, at a path that is to be written. Returns 1 with *s filled where something is there, 0 where
 * nothing is, -1 with e filled where the system does not say. */
int path_look(const char *path, struct stat *s, err *e);

/* Tells whether a name is one of an OBJ file: it ends in .obj or .obj.gz, in any case. */
bool path_is_obj(const char *path);

/* Tells whether two paths lead to one regular file, through any links, or would once it is there. */
bool path_is_same(const char *a, const char *b);

/* Tells whether the path leads to the regular file, pipe or socket that is open at fd. A device may be read and written
 * at once, so it never counts. */
bool path_is_open(const char *path, int fd);

#endif
