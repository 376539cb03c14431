#include "model/muscle_name.h"

#include <string.h>
#include <strings.h>

const char *muscle_name_short(const char *name)
{
    static const char prefix[] = "muscle_";
    const size_t n = sizeof prefix - 1;
    return !strncasecmp(name, prefix, n) && name[n] ? name + n : name;
}
