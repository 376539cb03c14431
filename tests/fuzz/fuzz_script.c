/* Any bytes as a script for a small model: curves whose times are in order and whose values
 * are finite, or one error with a text. */
// needs: tled/problem/script.c tled/problem/script_read.c
#include "tled/problem/script.h"

#include <math.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* 8 nodes, 1 m apart, the lower 4 held by "skull"; one muscle, "muscle_zyg". */
static void make_model(model *m, err *e)
{
    *m = (model){0};
    model_axis_add(m, "node", 8, e);
    model_axis_add(m, "anchor", 1, e);
    model_axis_add(m, "volume", 1, e);
    double *p = model_add(m, "node.position", e)->f64;
    int32_t *anchor = model_add(m, "node.anchor", e)->i32;
    for (int i = 0; i < 8; i++)
        p[3 * i] = i & 1, p[3 * i + 1] = i >> 1 & 1, p[3 * i + 2] = i >> 2, anchor[i] = i < 4 ? 0 : -1;
    model_set_text(model_add(m, "anchor.name", e), 0, "skull", e);
    model_set_text(model_add(m, "volume.name", e), 0, "muscle_zyg", e);
    model_add(m, "volume.muscle", e)->u8[0] = 1;
}

static void check_curve(const script *s, const script_curve *c)
{
    double value[3];
    if (c->key_count < 1 || c->key_first < 0 || c->key_first + c->key_count > s->keys)
        abort();
    if (c->node_first < 0 || c->node_first + c->node_count > s->nodes)
        abort();
    for (int32_t i = c->key_first; i < c->key_first + c->key_count; i++) {
        if (!isfinite(s->time[i]) || (i > c->key_first && s->time[i] < s->time[i - 1]))
            abort();
        script_value(s, c, s->time[i] / 2, value);
        if (isnan(value[0]) || isnan(value[1]) || isnan(value[2]))
            abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    model m;
    script s = {0};
    err e = {0};
    make_model(&m, &e);
    in *source = in_memory(data, size, "fuzz", &e);
    if (e.status)
        abort();
    if (script_read(&s, source, &m, &e)) {
        if (!e.text[0])
            abort();
    } else {
        for (int64_t i = 0; i < s.curves; i++)
            check_curve(&s, &s.curve[i]);
    }
    in_close(source);
    script_free(&s);
    model_free(&m);
    return 0;
}
