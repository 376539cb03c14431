#include "solve/executor.h"

#include "base/thread.h"

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

/* The law of the form that is needed. A form that no law has was chosen because it expresses all of them. */
static const char *law_needed(const executor_need *need)
{
    for (int f = 0; f < EXECUTOR_FORMS; f++)
        if (need->form >> f & 1 && need->law[f])
            return need->law[f];
    return "that expresses all laws of the model";
}

/* Returns the words for the first needed feature that the executor lacks, or else the law's; NULL: it lacks nothing. */
static const char *lack_of(const executor *x, const executor_need *need)
{
    const char *feature = words_of(need->features & ~x->features);
    if (feature)
        return feature;
    return need->form & ~x->forms ? law_needed(need) : NULL;
}

/* Whether, of what is needed, it lacks the law alone. */
static bool lacks_law(const executor *x, const executor_need *need)
{
    return !(need->features & ~x->features);
}

/* What was chosen, and what it was chosen for where not all can do that. */
static void say_chosen(const executor *x, const executor_need *need, const char *why, char *says, size_t size)
{
    const char *feature = words_of(need->features & ~EXECUTOR_USUAL);
    if (feature)
        snprintf(says, size, "%s (the one with %s)", x->device, feature);
    else
        snprintf(says, size, "%s%s", x->device, why);
}

static const executor *first_usable(const executor *const *table, const executor_need *need, char *says, size_t size,
                                    err *e)
{
    char why[300] = "";
    for (int i = 0; table[i]; i++) {
        const char *lack = lack_of(table[i], need), *reason = lack ? NULL : table[i]->unusable();
        if (!lack && !reason) {
            say_chosen(table[i], need, why, says, size);
            return table[i];
        }
        const char *no = lack && lacks_law(table[i], need) ? "no law " : "no ";
        append(why, sizeof why, " (%s: %s%s)", table[i]->device, lack ? no : "", lack ? lack : reason);
    }
    err_set(e, NULL, 0, "no back end can be used here%s", why);
    return NULL;
}

static const char *title(const char *device)
{
    return strcmp(device, "cuda") ? device : "CUDA";
}

/* Names what it lacks; a law with the volume that wants it, and with the laws that it has. */
static void refuse(const executor *x, const executor_need *need, err *e)
{
    char who[200] = "", have[200] = "";
    if (!lacks_law(x, need)) {
        err_set(e, NULL, 0, "the %s back end has no %s; expected -d cpu or auto", title(x->device), lack_of(x, need));
        return;
    }
    if (need->volume)
        append(who, sizeof who, ", which volume '%s' has", need->volume);
    for (int f = 0; f < EXECUTOR_FORMS; f++)
        if (need->law[f] && x->forms >> f & 1)
            append(have, sizeof have, "%s, or ", need->law[f]);
    err_set(e, NULL, 0, "the %s back end has no law %s%s; expected %s-d cpu or auto", title(x->device),
            law_needed(need), who, have);
}

static void not_in_table(const executor *const *table, const char *device, err *e)
{
    char have[200] = "";
    for (int i = 0; table[i]; i++)
        if (!i || strcmp(table[i]->device, table[i - 1]->device) != 0)
            append(have, sizeof have, "%s%s", i ? ", " : "", table[i]->device);
    err_set(e, NULL, 0, "this build has no %s back end; have: %s", title(device), have);
}

const executor *executor_choose(const executor *const *table, const char *device, const executor_need *need, char *says,
                                size_t size, err *e)
{
    const executor *lacking = NULL;
    if (!strcmp(device, "auto"))
        return first_usable(table, need, says, size, e);
    for (int i = 0; table[i]; i++) {
        if (strcmp(table[i]->device, device) != 0)
            continue;
        if (lack_of(table[i], need)) {
            lacking = table[i];
            continue;
        }
        const char *reason = table[i]->unusable();
        snprintf(says, size, "%s", device);
        if (!reason)
            return table[i];
        err_set(e, NULL, 0, "the %s back end cannot be used here: %s", device, reason);
        return NULL;
    }
    if (lacking)
        refuse(lacking, need, e);
    else
        not_in_table(table, device, e);
    return NULL;
}

static const executor *likely(const executor *const *table, const char *device, const executor_need *need)
{
    for (int i = 0; table[i]; i++)
        if ((!strcmp(device, "auto") || !strcmp(device, table[i]->device)) && !lack_of(table[i], need))
            return table[i];
    return NULL;
}

static void *make_ready(void *argument)
{
    executor_ahead *a = argument;
    const bool usable = !a->of->unusable();
    sem_post(&a->known);
    if (usable && a->of->load)
        a->of->load();
    return NULL;
}

void executor_ahead_start(executor_ahead *a, const executor *const *table, const char *device,
                          const executor_need *need)
{
    const executor *of = likely(table, device, need);
    if (!of || !strcmp(of->device, "cpu"))
        return;
    a->of = of;
    sem_init(&a->known, 0, 0);
    a->waits = !thread_start_quiet(&a->thread, make_ready, a);
    if (!a->waits)
        a->of = NULL; /* executor_choose does it */
}

void executor_ahead_wait(executor_ahead *a)
{
    while (a->waits && sem_wait(&a->known)) /* until no signal came between */
        ;
    a->waits = false;
}

void executor_ahead_end(executor_ahead *a)
{
    if (!a->of)
        return;
    pthread_join(a->thread, NULL);
    sem_destroy(&a->known);
    *a = (executor_ahead){.of = NULL};
}
