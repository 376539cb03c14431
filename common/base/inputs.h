/* The files that this process opened to read, by device and inode, so that no output replaces one of them: an input names others (a header
 * its data, a folder its images), which the command line does not show. The list is the process's, and any thread may use it.
 */
#ifndef SINEW_INPUTS_H
#define SINEW_INPUTS_H

#include "base/err.h"

#include <stdbool.h>
#include <sys/stat.h>

/* Notes a file, if it is a regular one. -1 with e filled where memory is out. */
int inputs_note(const struct stat *s, err *e);

/* Whether the file at path, links followed, was noted. */
bool inputs_has(const char *path);

#endif
