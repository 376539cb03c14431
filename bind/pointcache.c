#include "bind/pointcache.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { START_AT = 20 }; /* where the start frame is; rate and samples follow it */

static void put_u32(unsigned char *to, uint32_t v)
{
    for (int i = 0; i < 4; i++)
        to[i] = (unsigned char)(v >> 8 * i);
}

static void put_f32(unsigned char *to, float v)
{
    uint32_t bits;
    memcpy(&bits, &v, sizeof bits);
    put_u32(to, bits);
}

void pointcache_begin(pointcache *c, out *to, int32_t points)
{
    unsigned char head[32] = "POINTCACHE2";
    *c = (pointcache){.to = to, .points = points};
    put_u32(head + 12, 1);
    put_u32(head + 16, (uint32_t)points);
    out_write(to, head, sizeof head);
}

/* Blender plays sample i at frame start + i rate: one rate for all. */
static int check_step(pointcache *c, int64_t index, err *e)
{
    int64_t step = index - c->last;
    if (c->samples == INT32_MAX)
        return err_set(e, NULL, 0, "more frames than a point cache can count (%d)", INT32_MAX);
    if (c->samples == 1)
        c->step = step;
    if (c->samples && (step <= 0 || step != c->step))
        return err_set(e, NULL, 0, "frame %lld comes after %lld, but the step was %lld; a point cache has one step",
                       (long long)index, (long long)c->last, (long long)c->step);
    return 0;
}

int pointcache_add(pointcache *c, int64_t index, const double *position, err *e)
{
    if (check_step(c, index, e))
        return -1;
    c->first = c->samples ? c->first : index;
    c->last = index;
    c->samples++;
    for (int64_t i = 0; i < c->points; i++) {
        unsigned char row[12];
        for (int a = 0; a < 3; a++) {
            double v = position[3 * i + a];
            if (!(fabs(v) <= FLT_MAX))
                return err_set(e, NULL, 0, "frame %lld: %g is past a point cache's range (float32)", (long long)index,
                               v);
            put_f32(row + 4 * a, (float)v);
        }
        out_write(c->to, row, sizeof row);
    }
    return 0;
}

int pointcache_end(pointcache *c, err *e)
{
    unsigned char tail[12];
    put_f32(tail, (float)c->first);
    put_f32(tail + 4, c->step ? (float)c->step : 1);
    put_u32(tail + 8, (uint32_t)c->samples);
    return out_patch(c->to, START_AT, tail, sizeof tail, e);
}
