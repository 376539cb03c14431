/* Files that are not yet in their places: a process that is told to end (SIGINT, SIGTERM, SIGHUP) removes them first. The
 * list is the process's one, since a signal has no other way to find it: the exception to "no writable globals".
 */
#ifndef SINEW_TEMPORARY_H
#define SINEW_TEMPORARY_H

#include "base/err.h"

/* Notes the file at path, which stays the caller's to rename or remove. Not for several threads at once. */
int temporary_add(const char *path, err *e);

/* The file is in its place, or gone. A path that was not noted is no error. */
void temporary_drop(const char *path);

#endif
