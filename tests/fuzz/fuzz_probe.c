/* Any text as --probe: a probe that has a size, and a depth and a way out for every point; or one error with a text. */
#include "probe/probe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void ask(const probe *p)
{
    const pose at = {{.1, .2, .3}, {0, 0, 0, 1}};
    const probe_placed placed = probe_place(p, &at);
    const double x[3] = {.1, .19, .31};
    probe_touch t = probe_at(&placed, x);
    double square = t.way[0] * t.way[0] + t.way[1] * t.way[1] + t.way[2] * t.way[2];
    if (!isfinite(t.depth) || !(fabs(square - 1) < 1e-6) || !(placed.reach > 0))
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    probe p = {0};
    err e = {0};
    if (!text)
        return 0;
    if (size)
        memcpy(text, data, size);
    text[size] = '\0';
    int status = probe_of(&p, text, &e);
    if ((status != 0) != (e.text[0] != '\0'))
        abort();
    if (!status && p.kind != PROBE_CONVEX)
        ask(&p);
    free(text);
    return 0;
}
