#include "base/temporary.h"

#include "base/mem.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct {
    char **path;
    int64_t count, capacity;
    bool watching;
} list;

static const int ends[] = {SIGINT, SIGTERM, SIGHUP};

enum { ENDS = sizeof ends / sizeof *ends };

/* Then the signal does what it would have done: SA_RESETHAND has put its default back. */
static void remove_all(int signal)
{
    for (int64_t i = 0; i < list.count; i++)
        unlink(list.path[i]);
    raise(signal);
}

/* A signal that was ignored when we began (nohup) stays so. */
static void watch(void)
{
    struct sigaction now, act = {.sa_handler = remove_all, .sa_flags = (int)SA_RESETHAND};
    sigemptyset(&act.sa_mask);
    for (int i = 0; i < ENDS; i++)
        if (!sigaction(ends[i], NULL, &now) && now.sa_handler == SIG_DFL)
            sigaction(ends[i], &act, NULL);
    list.watching = true;
}

/* Keeps the signals away while the list changes; the pool's threads take none. */
static void hold(sigset_t *before)
{
    sigset_t set;
    sigemptyset(&set);
    for (int i = 0; i < ENDS; i++)
        sigaddset(&set, ends[i]);
    sigprocmask(SIG_BLOCK, &set, before);
}

int temporary_add(const char *path, err *e)
{
    sigset_t before;
    char *copy = mem_text(path, e);
    if (!copy)
        return -1;
    hold(&before);
    int bad = mem_grow(&list.path, &list.capacity, list.count + 1, sizeof *list.path, "names of files", e);
    if (!bad)
        list.path[list.count++] = copy;
    if (!list.watching)
        watch();
    sigprocmask(SIG_SETMASK, &before, NULL);
    if (bad)
        free(copy);
    return bad;
}

void temporary_drop(const char *path)
{
    sigset_t before;
    int64_t i = list.count - 1;
    while (i >= 0 && strcmp(list.path[i], path) != 0)
        i--;
    if (i < 0)
        return;
    hold(&before);
    free(list.path[i]);
    list.path[i] = list.path[--list.count];
    if (!list.count) {
        free(list.path);
        list.path = NULL;
        list.capacity = 0;
    }
    sigprocmask(SIG_SETMASK, &before, NULL);
}
