#include "cli/installed.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Whether folder/below/name can be read, with folder/below in `to`. */
static bool has_file(const char *folder, const char *below, const char *name, char to[INSTALLED_PATH])
{
    char path[INSTALLED_PATH];
    return snprintf(to, INSTALLED_PATH, "%s/%s", folder, below) < INSTALLED_PATH &&
           snprintf(path, sizeof path, "%s/%s", to, name) < (int)sizeof path && !access(path, R_OK);
}

bool installed_find(const char *installed, const char *checkout, const char *name, char folder[INSTALLED_PATH])
{
    char own[PATH_MAX];
    const ssize_t n = readlink("/proc/self/exe", own, sizeof own - 1);
    own[n > 0 ? n : 0] = '\0';
    for (char *slash = strrchr(own, '/'); slash; slash = strrchr(own, '/')) {
        *slash = '\0';
        if (has_file(own, installed, name, folder) || has_file(own, checkout, name, folder))
            return true;
    }
    return false;
}
