/* Interrupts: preloaded into a program (LD_PRELOAD), it lets read, write, fsync and their like return early, as they
 * may when a signal comes: with EINTR, or with fewer bytes than were asked for. Which, goes by the numbers that
 * SINEW_FAULT_SEED begins. Where SINEW_FAULT_COUNT names a file, it gets how many calls were interrupted.
 */
// NOLINTBEGIN(readability-inconsistent-declaration-parameter-name): those of the C library begin with __
#include "next.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct {
    atomic_ullong state;
    atomic_llong count;
} chance;

static unsigned long long next_number(void)
{
    unsigned long long x = atomic_fetch_add(&chance.state, 0x9e3779b97f4a7c15u);
    x ^= x >> 30, x *= 0xbf58476d1ce4e5b9u;
    x ^= x >> 27, x *= 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

__attribute__((constructor)) static void begin(void)
{
    const char *seed = getenv("SINEW_FAULT_SEED");
    atomic_store(&chance.state, seed ? strtoull(seed, NULL, 10) : 1);
}

/* Of the bytes that were asked for, how many are to be tried: all, some, or none, with EINTR. */
static size_t shortened(size_t size)
{
    const unsigned long long n = next_number();
    if (n % 4 > 1 || !size)
        return size;
    atomic_fetch_add(&chance.count, 1);
    if (n % 4 == 0) {
        errno = EINTR;
        return 0;
    }
    return 1 + (size_t)(n >> 8) % size;
}

ssize_t read(int fd, void *to, size_t size)
{
    ssize_t (*next)(int, void *, size_t);
    void *found = real_function("read");
    memcpy(&next, &found, sizeof next);
    const size_t n = shortened(size);
    return n || !size ? next(fd, to, n) : -1;
}

ssize_t write(int fd, const void *from, size_t size)
{
    ssize_t (*next)(int, const void *, size_t);
    void *found = real_function("write");
    memcpy(&next, &found, sizeof next);
    const size_t n = shortened(size);
    return n || !size ? next(fd, from, n) : -1;
}

ssize_t pwrite(int fd, const void *from, size_t size, off_t at)
{
    ssize_t (*next)(int, const void *, size_t, off_t);
    void *found = real_function("pwrite");
    memcpy(&next, &found, sizeof next);
    const size_t n = shortened(size);
    return n || !size ? next(fd, from, n, at) : -1;
}

int fsync(int fd)
{
    int (*next)(int);
    void *found = real_function("fsync");
    memcpy(&next, &found, sizeof next);
    return shortened(1) ? next(fd) : -1;
}

__attribute__((destructor)) static void end(void)
{
    const char *path = getenv("SINEW_FAULT_COUNT");
    FILE *f = path ? fopen(path, "a") : NULL;
    if (!f)
        return;
    fprintf(f, "%lld\n", (long long)atomic_load(&chance.count));
    fclose(f);
}
// NOLINTEND(readability-inconsistent-declaration-parameter-name)
