#include "solve/executor.h"

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

static int first_usable(const executor *const *table, char *says, size_t size, err *e)
{
    char why[300] = "";
    for (int i = 0; table[i]; i++) {
        const char *reason = table[i]->unusable();
        if (!reason) {
            snprintf(says, size, "%s%s", table[i]->device, why);
            return i;
        }
        append(why, sizeof why, " (%s: %s)", table[i]->device, reason);
    }
    return err_set(e, NULL, 0, "no back end can be used here%s", why);
}

static int not_in_table(const executor *const *table, const char *device, err *e)
{
    char have[200] = "";
    for (int i = 0; table[i]; i++)
        append(have, sizeof have, "%s%s", i ? ", " : "", table[i]->device);
    return err_set(e, NULL, 0, "this build has no %s back end; have: %s", strcmp(device, "cuda") ? device : "CUDA",
                   have);
}

int executor_choose(const executor *const *table, const char *device, char *says, size_t size, err *e)
{
    if (!strcmp(device, "auto"))
        return first_usable(table, says, size, e);
    for (int i = 0; table[i]; i++)
        if (!strcmp(table[i]->device, device)) {
            const char *reason = table[i]->unusable();
            snprintf(says, size, "%s", device);
            return reason ? err_set(e, NULL, 0, "the %s back end cannot be used here: %s", device, reason) : i;
        }
    return not_in_table(table, device, e);
}
