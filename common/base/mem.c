#include "base/mem.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *mem_array(int64_t count, size_t size, const char *what, err *e)
{
    void *p = NULL;
    if (count >= 0 && (uint64_t)count <= PTRDIFF_MAX / (size ? size : 1))
        p = calloc(count ? (size_t)count : 1, size ? size : 1);
    if (!p)
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

int64_t mem_available(void)
{
    long long kib = 0;
    char line[128];
    FILE *f = fopen("/proc/meminfo", "r");
    if (!f)
        return INT64_MAX / 4;
    while (fgets(line, sizeof line, f))
        if (sscanf(line, "MemAvailable: %lld kB", &kib) == 1)
            break;
    fclose(f);
    return kib > 0 ? (int64_t)kib * 1024 : INT64_MAX / 4;
}
