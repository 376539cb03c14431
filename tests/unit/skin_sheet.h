/* A sheet for tests of skins: 20 cm a side, of 41 x 41 vertices, with a swell in it if so asked. Functions end the test
 * program where even the setting up fails.
 */
#ifndef SINEW_SKIN_SHEET_H
#define SINEW_SKIN_SHEET_H

#include "base/mem.h"
#include "model/model.h"
#include "msds/run/skin.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SHEET_SIDE = 41 };

static inline void sheet_must(bool good, const err *e)
{
    if (good)
        return;
    printf("Bail out! %s\n", e->text);
    exit(1);
}

/* A square sheet of 20 cm with a swell in it, as OBJ text of a model's surface. */
static inline void sheet_add(model *m, double swell)
{
    static char text[SHEET_SIDE * SHEET_SIDE * 120];
    err e = {0};
    obj o = {0};
    int n = 0;
    for (int j = 0; j < SHEET_SIDE; j++)
        for (int i = 0; i < SHEET_SIDE; i++) {
            double x = .005 * i, y = .005 * j;
            n += snprintf(text + n, sizeof text - (size_t)n, "v %.17g %.17g %.17g\n", x, y,
                          swell * sin(20 * x) * sin(15 * y));
        }
    for (int j = 0; j + 1 < SHEET_SIDE; j++)
        for (int i = 0; i + 1 < SHEET_SIDE; i++)
            n += snprintf(text + n, sizeof text - (size_t)n, "f %d %d %d\nf %d %d %d\n", j * SHEET_SIDE + i + 1,
                          j * SHEET_SIDE + i + 2, (j + 1) * SHEET_SIDE + i + 2, j * SHEET_SIDE + i + 1,
                          (j + 1) * SHEET_SIDE + i + 2, (j + 1) * SHEET_SIDE + i + 1);
    in *source = in_memory(text, (size_t)n, "sheet.obj", &e);
    sheet_must(source && !obj_read(&o, source, &e) && !surface_add(m, "sheet", &o, 1, &e), &e);
    in_close(source);
    obj_free(&o);
}

static inline skin_options sheet_options(void)
{
    skin_options o = {.stiffness = 100, .anchors = .1, .tension = .5, .damping = .1, .dt = .01};
    return o;
}

static inline void sheet_make(skin *s, const model *m, const skin_options *o, int threads)
{
    err e = {0};
    surface shape;
    pool *workers = pool_create(threads, &e);
    sheet_must(workers && !surface_of(m, "sheet", &shape, &e) && !skin_make(s, &shape, o, workers, &e), &e);
}

static inline void sheet_done(skin *s)
{
    pool *workers = s->threads;
    skin_free(s);
    pool_destroy(workers);
}

static inline void sheet_step(skin *s, const probe_placed *at, int64_t count)
{
    err e = {0};
    sheet_must(!skin_step(s, at, count, &e) && !skin_fetch(s, &e), &e);
}

#endif
