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

/* The first of the features in words, or NULL. */
static const char *words_of(uint32_t features)
{
#define EXECUTOR_WORDS(name, words) words,
    static const char *const all[] = {EXECUTOR_FEATURES(EXECUTOR_WORDS)};
#undef EXECUTOR_WORDS
    for (int i = 0; i < EXECUTOR_FEATURE_COUNT; i++)
        if (features >> i & 1)
            return all[i];
    return NULL;
}

/* What an executor lacks of what is needed, in words, or NULL. */
static const char *lack_of(const executor *x, const executor_need *need)
{
    const char *feature = words_of(need->features & ~x->features);
    if (feature)
        return feature;
    return need->law && !(x->forms >> need->form & 1) ? need->law : NULL;
}

/* What was chosen, and what it was chosen for where not all can do that. */
static void say_chosen(const executor *x, const executor_need *need, const char *why, char *says, size_t size)
{
    const char *feature = words_of(need->features);
    if (feature)
        snprintf(says, size, "%s (the one with %s)", x->device, feature);
    else
        snprintf(says, size, "%s%s", x->device, why);
}

static int first_usable(const executor *const *table, const executor_need *need, char *says, size_t size, err *e)
{
    char why[300] = "";
    for (int i = 0; table[i]; i++) {
        const char *lack = lack_of(table[i], need), *reason = lack ? NULL : table[i]->unusable();
        if (!lack && !reason) {
            say_chosen(table[i], need, why, says, size);
            return i;
        }
        append(why, sizeof why, " (%s: %s%s)", table[i]->device, lack ? "no " : "", lack ? lack : reason);
    }
    return err_set(e, NULL, 0, "no back end can be used here%s", why);
}

static const char *title(const char *device)
{
    return strcmp(device, "cuda") ? device : "CUDA";
}

static int not_in_table(const executor *const *table, const char *device, err *e)
{
    char have[200] = "";
    for (int i = 0; table[i]; i++)
        append(have, sizeof have, "%s%s", i ? ", " : "", table[i]->device);
    return err_set(e, NULL, 0, "this build has no %s back end; have: %s", title(device), have);
}

int executor_choose(const executor *const *table, const char *device, const executor_need *need, char *says,
                    size_t size, err *e)
{
    const char *lack = NULL;
    if (!strcmp(device, "auto"))
        return first_usable(table, need, says, size, e);
    for (int i = 0; table[i]; i++) {
        if (strcmp(table[i]->device, device) != 0)
            continue;
        lack = lack_of(table[i], need);
        if (lack)
            continue;
        const char *reason = table[i]->unusable();
        snprintf(says, size, "%s", device);
        return reason ? err_set(e, NULL, 0, "the %s back end cannot be used here: %s", device, reason) : i;
    }
    return lack ? err_set(e, NULL, 0, "the %s back end has no %s; expected -d cpu or auto", title(device), lack)
                : not_in_table(table, device, e);
}
