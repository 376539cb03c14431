/* Any bytes as a volume image: one that is whole and has a place, and that is the same when it is written and read
 * again; or one error with a text. For the targets of both formats.
 */
#ifndef SINEW_VOLUME_BYTES_H
#define SINEW_VOLUME_BYTES_H

#include "volume/nrrd.h"
#include "volume/volume.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static inline int volume_bytes_read(volume *v, const void *bytes, size_t size)
{
    err e = {0};
    in *s = in_memory(bytes, size, "fuzz", &e);
    int status = s ? volume_read(v, s, NULL, NULL, &e) : -1;
    if ((status != 0) != (e.text[0] != '\0'))
        abort();
    in_close(s);
    return status;
}

static inline void volume_bytes_places(const volume *v)
{
    err e = {0};
    volume_finder f = volume_finder_of(v);
    const double last[3] = {(double)v->size[0] - 1, (double)v->size[1] - 1, (double)v->size[2] - 1};
    double place[3];
    volume_place(v, last, place);
    int64_t at = volume_nearest(v, &f, place);
    if (volume_check(v, NULL, 0, &e) || at >= volume_count(v) || at < -1)
        abort();
    volume_value(v, volume_count(v) - 1);
}

static inline void volume_bytes(const uint8_t *data, size_t size)
{
    volume v = {0}, again = {0};
    err e = {0};
    size_t n;
    if (volume_bytes_read(&v, data, size)) {
        if (v.data)
            abort();
        return;
    }
    volume_bytes_places(&v);
    out *to = out_memory(&e);
    if (!to || nrrd_write(&v, size % 2, to, &e))
        abort();
    const unsigned char *bytes = out_bytes(to, &n);
    if (volume_bytes_read(&again, bytes, n) || memcmp(v.axis, again.axis, sizeof v.axis) ||
        memcmp(v.size, again.size, sizeof v.size) || v.labels != again.labels ||
        memcmp(v.data, again.data, (size_t)volume_count(&v) * volume_type_size(v.type)))
        abort();
    out_discard(to);
    volume_free(&v);
    volume_free(&again);
}

/* The same, with a format's first line before the bytes. */
static inline void volume_bytes_after(const void *first, size_t n, const uint8_t *data, size_t size)
{
    uint8_t *all = malloc(n + size);
    if (!all)
        return;
    memcpy(all, first, n);
    if (size)
        memcpy(all + n, data, size);
    volume_bytes(all, n + size);
    free(all);
}

#endif
