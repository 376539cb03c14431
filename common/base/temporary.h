/* The names of files that are not yet in their places, so that none of these files is left behind. A process that is
 * told to end by a signal removes them first. What a killed process left (kill -9) is removed by the next process that
 * makes such a file in that folder. The list is the process's one, since a signal has no other way to find it: the
 * exception to "no writable globals".
 */
#ifndef SINEW_TEMPORARY_H
#define SINEW_TEMPORARY_H

#include "base/err.h"

enum { TEMPORARY_NAME = 64 };

/* The process's next name, as no other process has that is alive: ".sinew-HOST-PID-NUMBER.tmp". */
void temporary_name(char name[TEMPORARY_NAME]);

/* Calls make(context, path), which makes a file of that name or returns -1 with errno, and notes the file: no signal
 * comes in between. Returns what make did, or -1 with e filled where there is no memory; e is clear where make
 * failed. */
int temporary_make(const char *path, int (*make)(const void *context, const char *path), const void *context, err *e);

/* The file is in its place, or gone. A path that was not noted is no error. */
void temporary_drop(const char *path);

/* Removes what processes of this host left in a folder that are gone ("": here), once for each folder. Who has such a
 * file open locks it (flock); what is locked, of another user or of another host's name stays. */
void temporary_sweep(const char *folder);

/* Removes all files that are noted, and ends the process by the signal, though that be ignored or blocked. Returns only
 * where that cannot be. */
void temporary_end(int signal_number);

#endif
