/* Files that were installed with the tools, found from where the program that runs lies: in PREFIX/share/sinew beside
 * PREFIX/bin, or in the checkout that it was built in. Owns nothing.
 */
#ifndef SINEW_INSTALLED_H
#define SINEW_INSTALLED_H

#include <stdbool.h>

enum { INSTALLED_PATH = 4096 };

/* Finds the folder that has the file `name`: of each folder above the program, from the nearest on, the folder
 * `installed` ("share/sinew/console") in it, then the folder `checkout` ("common/console/page"). False: neither. */
bool installed_find(const char *installed, const char *checkout, const char *name, char folder[INSTALLED_PATH]);

#endif
