/* How a live run is told to end: by SIGINT or SIGTERM, once; it then ends as at the end of its input. A second signal
 * ends the process at once. The flag is the process's.
 */
#ifndef SINEW_STOP_H
#define SINEW_STOP_H

#include <stdbool.h>

/* Catches the two signals from here on. Call it before anything that removes files when a signal ends the process
 * (base/temporary.h): that leaves caught signals alone. */
void stop_catch(void);

/* Whether one came. Any thread may ask. */
bool stop_came(void);

#endif
