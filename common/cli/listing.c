#include "cli/listing.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { REST = 40 }; /* bytes for " and N more" */

void listing_add(listing *l, const char *format, ...)
{
    char name[sizeof l->text];
    va_list args;
    va_start(args, format);
    vsnprintf(name, sizeof name, format, args);
    va_end(args);
    const size_t used = strlen(l->text), room = sizeof l->text - REST - used;
    if (l->named == l->count && strlen(name) + 3 < room) {
        snprintf(l->text + used, room, "%s%s", used ? ", " : "", name);
        l->named++;
    }
    l->count++;
}

const char *listing_text(listing *l)
{
    const size_t used = strlen(l->text);
    if (l->named < l->count)
        snprintf(l->text + used, sizeof l->text - used, " and %lld more", (long long)(l->count - l->named));
    l->named = l->count;
    return l->text;
}
