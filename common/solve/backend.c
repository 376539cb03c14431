#include "solve/backend.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void append(char *text, size_t size, const char *format, ...) SINEW_PRINTF(3, 4);

static void append(char *text, size_t size, const char *format, ...)
{
    size_t used = strlen(text);
    va_list list;
    va_start(list, format);
    vsnprintf(text + used, size - used, format, list);
    va_end(list);
}

static const backend *first_usable(const backend *const *table, char *says, size_t size, err *e)
{
    char why[300] = "";
    for (int i = 0; table[i]; i++) {
        const char *reason = table[i]->unusable();
        if (!reason) {
            snprintf(says, size, "%s%s", table[i]->name, why);
            return table[i];
        }
        append(why, sizeof why, " (%s: %s)", table[i]->name, reason);
    }
    err_set(e, NULL, 0, "no back end can be used here%s", why);
    return NULL;
}

static const backend *not_in_table(const backend *const *table, const char *name, err *e)
{
    char have[200] = "";
    for (int i = 0; table[i]; i++)
        append(have, sizeof have, "%s%s", i ? ", " : "", table[i]->name);
    err_set(e, NULL, 0, "this build has no %s back end; have: %s", strcmp(name, "cuda") ? name : "CUDA", have);
    return NULL;
}

const backend *backend_choose(const backend *const *table, const char *name, char *says, size_t size, err *e)
{
    if (!strcmp(name, "auto"))
        return first_usable(table, says, size, e);
    for (int i = 0; table[i]; i++)
        if (!strcmp(table[i]->name, name)) {
            const char *reason = table[i]->unusable();
            snprintf(says, size, "%s", name);
            if (reason)
                err_set(e, NULL, 0, "the %s back end cannot be used here: %s", name, reason);
            return reason ? NULL : table[i];
        }
    return not_in_table(table, name, e);
}
