/* Any bytes as the words of a 3D mouse and the events of its daemon: a line of words, then eight numbers an event, each
 * 8 ms after the one before. Where the probe is stays finite, and its quaternion of length 1.
 */
#include "live/puck.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void must(bool good)
{
    if (!good)
        abort();
}

static void check(const pose *at)
{
    double row[7], square = 0;
    pose_to_row(at, row);
    for (int i = 0; i < 7; i++)
        must(isfinite(row[i]));
    for (int i = 3; i < 7; i++)
        square += row[i] * row[i];
    must(fabs(square - 1) < 1e-9);
}

/* The words before the first line's end, which are none where there is a zero byte. */
static size_t read_plan(const uint8_t *data, size_t size, puck_plan *plan)
{
    err e = {0};
    const uint8_t *end = memchr(data, '\n', size);
    char *words = malloc(size + 1);
    must(words != NULL);
    const size_t length = end ? (size_t)(end - data) : size;
    memcpy(words, data, length);
    words[length] = '\0';
    const int failed = puck_plan_read(words, plan, &e);
    must(failed ? e.status == STATUS_USAGE : !e.status);
    free(words);
    if (failed)
        must(!puck_plan_read("", plan, &(err){0}));
    return end ? length + 1 : size;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const double each = .008;
    puck_plan plan;
    int32_t event[8];
    double now = 0;
    if (!size)
        return 0;
    size_t at = read_plan(data, size, &plan);
    puck p = puck_make(&plan);
    const pose none = pose_none();
    puck_place(&p, &none, now);
    for (; at + sizeof event <= size; at += sizeof event) {
        err e = {0};
        memcpy(event, data + at, sizeof event);
        now += each;
        must(puck_take(&p, event, now, &e) == (e.status ? -1 : 0));
        puck_advance(&p, now + each / 2);
        check(&p.at);
    }
    puck_drop(&p, now + 1);
    check(&p.at);
    return 0;
}
