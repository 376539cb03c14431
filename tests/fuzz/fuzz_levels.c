/* Any bytes as a file of expressions and as a track: levels from 0 to 1 at times that rise, and activations that follow
 * them, or one error with a text. */
// needs: tled/problem/script.c tled/problem/script_read.c tled/problem/script_nodes.c tled/problem/script_surface.c
// needs: tled/problem/script_move.c
// needs: tled/problem/script_levels.c tled/problem/script_muscles.c tled/problem/script_track.c tled/muscle/muscles.c
// needs: tled/muscle/expressions.c tled/muscle/activation.c
#include "tled/problem/script.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void make_model(model *m, err *e)
{
    static const char *const volume[] = {"muscle_zyg_left", "muscle_zyg_right", "ris"};
    *m = (model){0};
    model_axis_add(m, "volume", 3, e);
    model_add(m, "volume.name", e);
    uint8_t *muscle = model_add(m, "volume.muscle", e)->u8;
    for (int i = 0; i < 3; i++)
        model_set_text(model_find(m, "volume.name"), i, volume[i], e), muscle[i] = 1;
}

static int read_expressions(expressions *x, const void *data, size_t size, const model *m)
{
    err e = {0};
    in *source = in_memory(data, size, "fuzz", &e);
    const int status = expressions_read(x, source, m, &e);
    if ((status != 0) != (e.text[0] != 0) || (!status && !x->count))
        abort();
    for (int64_t i = 0; i < x->parts; i++)
        if (x->part[i].volume < 0 || x->part[i].volume > 2 || !(x->part[i].level >= 0 && x->part[i].level <= 1))
            abort();
    in_close(source);
    return status;
}

static void check_levels(const script *s, double time)
{
    double value[30];
    if (s->curves > 10)
        abort();
    script_values(s, time, value);
    for (int64_t i = 0; i < s->curves; i++)
        if (!(value[3 * i] >= 0 && value[3 * i] <= 1))
            abort();
}

static void take_track(const uint8_t *data, size_t size, const model *m, const expressions *x, bool smooth)
{
    script s = {.expressions = x, .times = {smooth ? .01 : 0, .04}};
    err e = {0};
    in *source = in_memory(data, size, "fuzz", &e);
    const int status = script_read_track(&s, source, m, smooth, &e) || script_check_levels(&s, m, NULL, &e);
    if ((status != 0) != (e.text[0] != 0))
        abort();
    for (int64_t i = 0; !status && i < s.keys; i++) {
        check_levels(&s, s.time[i]);
        check_levels(&s, s.time[i] / 2);
        check_levels(&s, s.time[i] + 1);
    }
    in_close(source);
    script_free(&s);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char known[] = "smile: zyg_*=.75 ris=.5\nhalf: muscle_zyg_left=.5\n";
    model m;
    err e = {0};
    expressions x = {0}, own = {0};
    make_model(&m, &e);
    read_expressions(&own, data, size, &m);
    if (e.status || read_expressions(&x, known, sizeof known - 1, &m))
        abort();
    take_track(data, size, &m, &x, false);
    take_track(data, size, &m, &x, true);
    expressions_free(&own);
    expressions_free(&x);
    model_free(&m);
    return 0;
}
