/* Sizes that do not fit: what would wrap round to a small one is refused, and the array stays as it was. */
#include "base/mem.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

/* As many things that their bytes, counted in 64 bits, come to `bytes` only. */
static int64_t wrapping(size_t size, size_t bytes)
{
    return (int64_t)(UINT64_MAX / size + 1 + bytes / size);
}

static void refused(int64_t need, size_t size)
{
    err e = {0};
    char *array = strdup("kept");
    int64_t capacity = 5;
    ok(mem_grow(&array, &capacity, need, size, "things", &e) == -1 && strstr(e.text, "out of memory for things"),
       "%lld of %zu bytes are refused", (long long)need, size);
    ok(capacity == 5 && !strcmp(array, "kept"), "and the array stays");
    free(array);
}

static void refused_new(int64_t count, size_t size)
{
    err e = {0};
    void *p = mem_array(count, size, "things", &e);
    ok(!p && strstr(e.text, "out of memory for things"), "%lld new of %zu bytes are refused", (long long)count, size);
    free(p);
}

int main(void)
{
    static const size_t sizes[] = {2, 8, 16, 4096};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const size_t size = sizes[i];
        const int64_t most = (int64_t)(PTRDIFF_MAX / size);
        refused(most + 1, size);
        refused(INT64_MAX, size);
        refused_new(most + 1, size);
        refused_new(-1, size);
        if (size == 2) /* as many as make it wrap are more than an int64_t counts */
            continue;
        refused(wrapping(size, 0), size);
        refused(wrapping(size, 4 * size), size);
        refused_new(wrapping(size, 4 * size), size);
    }
    /* What would double past the largest size has that; it is not there either. */
    err e = {0};
    char *array = NULL;
    int64_t capacity = INT64_MAX / 2 + 2;
    ok(mem_grow(&array, &capacity, capacity + 1, 1, "things", &e) == -1 && e.status && !array, "half of all memory");

    e = (err){0};
    capacity = 0;
    int good = 0;
    for (int64_t need = 1; need <= 1000; need++) {
        const int64_t before = capacity;
        good += !mem_grow(&array, &capacity, need, 1, "things", &e) && capacity >= need &&
                (capacity == before || capacity >= 2 * before);
        array[need - 1] = (char)need;
    }
    for (int64_t i = 0; i < 1000; i++)
        good -= array[i] == (char)(i + 1);
    ok(!good && capacity < 2048, "what grows by one at a time doubles, and keeps what it holds");
    free(array);
    return done_testing();
}
