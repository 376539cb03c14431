#include "base/mem.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* Where the memory that is free cannot be known. */
#define UNKNOWN (INT64_MAX / 4)

void mem_large(void *p, size_t size)
{
    enum { LARGE = 1 << 22 };
    size_t page = (size_t)sysconf(_SC_PAGESIZE), before = (uintptr_t)p % page;
    if (size >= LARGE) /* from the page's start: a mapping of two minds cannot be moved when it grows */
        madvise((char *)p - before, before + size, MADV_HUGEPAGE);
}

void *mem_array(int64_t count, size_t size, const char *what, err *e)
{
    const size_t each = size ? size : 1;
    void *p = NULL;
    if (count >= 0 && (uint64_t)count <= PTRDIFF_MAX / each)
        p = calloc(count ? (size_t)count : 1, each);
    if (p)
        mem_large(p, (size_t)count * size);
    else
        err_memory(e, what);
    return p;
}

int mem_grow(void *array, int64_t *capacity, int64_t need, size_t size, const char *what, err *e)
{
    if (need <= *capacity)
        return 0;
    int64_t most = (int64_t)(PTRDIFF_MAX / size);
    if (need > most)
        return err_memory(e, what);
    int64_t next = *capacity > most / 2 ? most : *capacity * 2;
    if (next < need)
        next = need;
    if (next < 16 && most >= 16)
        next = 16;
    void *old;
    memcpy(&old, array, sizeof old);
    void *grown = realloc(old, (size_t)next * size);
    if (!grown)
        return err_memory(e, what);
    mem_large(grown, (size_t)next * size);
    memcpy(array, &grown, sizeof grown);
    *capacity = next;
    return 0; // cppcheck-suppress memleak ; *array has it
}

char *mem_text(const char *text, err *e)
{
    char *copy = strdup(text);
    if (!copy)
        err_memory(e, "text");
    return copy;
}

/* The number after `key` at the start of a line ("": the file is a number alone); -1 where there is none. */
static int64_t number_in(const char *path, const char *key)
{
    long long value = -1;
    char line[256];
    size_t n = strlen(key);
    FILE *f = fopen(path, "r");
    while (f && value < 0 && fgets(line, sizeof line, f))
        if (strncmp(line, key, n) != 0 || sscanf(line + n, "%lld", &value) != 1)
            value = -1;
    if (f)
        fclose(f);
    return value;
}

static int64_t group_number(const char *root, const char *path, const char *file, const char *key)
{
    char name[PATH_MAX];
    snprintf(name, sizeof name, "%s%s/%s", root, path, file);
    return number_in(name, key);
}

int64_t mem_group_left(const char *root, const char *path)
{
    int64_t left = UNKNOWN;
    char at[PATH_MAX];
    snprintf(at, sizeof at, "%s", path);
    for (;;) {
        size_t n = strlen(at);
        while (n && at[n - 1] == '/')
            at[--n] = 0;
        int64_t most = group_number(root, at, "memory.max", ""), used = group_number(root, at, "memory.current", "");
        int64_t cached = group_number(root, at, "memory.stat", "file ");
        if (most >= 0 && used >= 0) {
            used -= cached > 0 && cached < used ? cached : 0;
            left = most - used < left ? most - used : left;
        }
        char *slash = strrchr(at, '/');
        if (!slash)
            return left > 0 ? left : 0;
        *slash = 0;
    }
}

/* The path of the process's control group. */
static void find_group(char *path, size_t size)
{
    char line[PATH_MAX];
    FILE *f = fopen("/proc/self/cgroup", "r");
    *path = 0;
    while (f && fgets(line, sizeof line, f))
        if (!strncmp(line, "0::", 3)) {
            line[strcspn(line, "\n")] = 0;
            snprintf(path, size, "%s", line + 3);
        }
    if (f)
        fclose(f);
}

int64_t mem_available(void)
{
    char group[PATH_MAX];
    int64_t kib = number_in("/proc/meminfo", "MemAvailable:");
    find_group(group, sizeof group);
    int64_t left = mem_group_left("/sys/fs/cgroup", group), free_now = kib > 0 ? kib * 1024 : UNKNOWN;
    return left < free_now ? left : free_now;
}
