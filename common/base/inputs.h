/* The files that this process opened to read, by device, inode and time of birth, so that no output replaces one of
 * them: an input names others (a header its data, a folder its images), which the command line does not show. The list
 * is the process's, and any thread may use it.
 */
#ifndef SINEW_INPUTS_H
#define SINEW_INPUTS_H

#include "base/err.h"

#include <stdbool.h>

/* Notes the file of a descriptor, or at a path, links followed, if it is a regular one.
 * -1 with e filled where memory is out. */
int inputs_note(int fd, err *e);
int inputs_note_path(const char *path, err *e);

/* Whether the file at path, links followed, was noted. */
bool inputs_has(const char *path);

#endif
