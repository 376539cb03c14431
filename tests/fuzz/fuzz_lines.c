/* Any bytes from a live source: each line is a pose, a control or skipped, once; all of them can be taken, and the
 * source ends.
 */
#include "base/clock.h"
#include "live/lines.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MOST = 65536 /* bytes that a pipe holds */, WAIT = 20 /* s */ };

static void must(bool good)
{
    if (!good)
        abort();
}

/* A source with these bytes, which then ends. */
static lines *open_bytes(const uint8_t *data, size_t size)
{
    err e = {0};
    int ends[2];
    char path[40];
    const char *const list[] = {path};
    must(!pipe(ends));
    must(write(ends[1], data, size) == (ssize_t)size);
    close(ends[1]);
    snprintf(path, sizeof path, "/proc/self/fd/%d", ends[0]);
    lines *l = lines_open(list, 1, NULL, &e);
    close(ends[0]);
    must(l != NULL);
    return l;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    lines_pose at;
    keyfile k;
    int64_t taken = 0, controls = 0, ends = 1;
    if (size > MOST)
        return 0;
    for (size_t i = 0; i < size; i++)
        ends += data[i] == '\n';
    lines *l = open_bytes(data, size);
    const double until = clock_now() + WAIT;
    while (!lines_ended(l)) {
        lines_wait(l, until);
        while (lines_take(l, &k)) {
            must(k.count > 0 && k.line >= 1 && k.line <= ends);
            controls++;
        }
        taken += lines_take_pose(l, &at);
        must(clock_now() < until);
    }
    const lines_counts c = lines_count(l);
    must(c.controls == controls && c.poses == taken + c.stale && !c.writers);
    must(c.poses + c.controls + c.skipped <= ends);
    lines_close(l);
    return 0;
}
