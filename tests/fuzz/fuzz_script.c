/* Any bytes as a script for a small model: curves whose times are in order and whose values
 * are finite, or one error with a text. */
// needs: tled/problem/script.c tled/problem/script_read.c tled/problem/script_nodes.c tled/problem/script_surface.c
// needs: tled/problem/script_move.c
// needs: tled/problem/script_levels.c tled/problem/script_muscles.c tled/problem/script_track.c tled/muscle/muscles.c
// needs: tled/muscle/expressions.c tled/muscle/activation.c
#include "tled/problem/script.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Its surface, "lip", bound: a tetrahedron of the groups "upper" and "lower red", and a square. */
static void make_surface(model *m, err *e)
{
    static const int32_t corner[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3, 4, 5, 6, 7};
    model_axis_add(m, "lip/vertex", 8, e);
    model_axis_add(m, "lip/face", 5, e);
    model_axis_add(m, "lip/corner", 16, e);
    model_axis_add(m, "lip/group", 2, e);
    double *p = model_add(m, "lip/vertex.position", e)->f64;
    double *weight = model_add_as(m, "lip/vertex.weight", MODEL_F64, "1", "lip/vertex", 3, e)->f64;
    int64_t *start = model_add(m, "lip/face.start", e)->i64;
    memcpy(model_add(m, "lip/face.vertex", e)->i32, corner, sizeof corner);
    model_add(m, "lip/vertex.element", e);
    for (int i = 0; i < 24; i++) {
        p[i] = i / 3 < 4 ? i / 3 == i % 3 + 1 : i / 3 - 4 == i % 3 || (i / 3 == 7 && i % 3 < 2);
        weight[i] = 1 - p[i];
    }
    for (int i = 0; i < 5; i++)
        start[i] = 3 * (int64_t)i;
    model_add(m, "lip/face.group", e)->i32[1] = 1;
    model_set_text(model_add(m, "lip/group.name", e), 0, "upper", e);
    model_set_text(model_find(m, "lip/group.name"), 1, "lower red", e);
}

/* 8 nodes, 1 m apart, the lower 4 held by "skull", the others of the body "jaw"; an element of them; one muscle,
 * "muscle_zyg". */
static void make_model(model *m, err *e)
{
    *m = (model){0};
    model_axis_add(m, "node", 8, e);
    model_axis_add(m, "anchor", 1, e);
    model_axis_add(m, "volume", 1, e);
    model_axis_add(m, "element", 1, e);
    double *p = model_add(m, "node.position", e)->f64;
    int32_t *anchor = model_add(m, "node.anchor", e)->i32;
    for (int i = 0; i < 8; i++)
        p[3 * i] = i & 1, p[3 * i + 1] = i >> 1 & 1, p[3 * i + 2] = i >> 2, anchor[i] = i < 4 ? 0 : -1;
    int32_t *node = model_add_as(m, "element.node", MODEL_I32, "@node", "element", 8, e)->i32;
    for (int i = 0; i < 8; i++)
        node[i] = i % 4 < 2 ? i : i ^ 1;
    make_surface(m, e);
    model_set_text(model_add(m, "anchor.name", e), 0, "skull", e);
    model_axis_add(m, "body", 1, e);
    model_set_text(model_add(m, "body.name", e), 0, "jaw", e);
    for (int i = 0, *body = model_add(m, "node.body", e)->i32; i < 8; i++)
        body[i] = i < 4 ? -1 : 0;
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
    if (c->triangle_first < 0 || c->triangle_first + c->triangle_count > s->triangles)
        abort();
    if ((c->surface != NULL) != (c->triangle_count > 0))
        abort();
    for (int64_t i = 0; i < 3 * (int64_t)c->triangle_count; i++)
        if (s->corner[3 * (int64_t)c->triangle_first + i] < 0 || s->corner[3 * (int64_t)c->triangle_first + i] > 7)
            abort();
    for (int32_t i = c->key_first; i < c->key_first + c->key_count; i++) {
        if (!isfinite(s->time[i]) || (i > c->key_first && s->time[i] < s->time[i - 1]))
            abort();
        script_value(s, c, s->time[i] / 2, value);
        if (isnan(value[0]) || isnan(value[1]) || isnan(value[2]))
            abort();
    }
}

/* Each line as one that comes live. */
static void take_live(const uint8_t *data, size_t size, const model *m)
{
    keyfile k;
    script s = {0};
    err e = {0};
    char word[] = "now";
    in *source = in_memory(data, size, "fuzz", &e);
    keyfile_open(&k, source);
    for (int i = 1; keyfile_next(&k, &e) > 0; i++) {
        const script_now now = {i, i + 1, NULL};
        const script before = s;
        err wrong = {0};
        bool anew = false;
        if (!script_is_now(&k))
            k.word[0] = word;
        if (!script_take_now(&s, m, &k, &now, &anew, &wrong))
            for (int64_t c = 0; c < s.curves; c++)
                check_curve(&s, &s.curve[c]);
        else if (!wrong.text[0] || s.curves != before.curves || s.nodes != before.nodes || s.keys < before.keys)
            abort();
    }
    in_close(source);
    script_free(&s);
}

/* As a file of poses. */
static void take_poses(const uint8_t *data, size_t size, const model *m)
{
    const pose place = {{0, 0, 1}, {0, .6, 0, .8}};
    script s = {0};
    err e = {0};
    in *source = in_memory(data, size, "fuzz", &e);
    const int status = script_read_poses(&s, source, m, &place, &e);
    if (status && !e.text[0])
        abort();
    for (int64_t i = 0; !status && i < s.curves; i++)
        check_curve(&s, &s.curve[i]);
    in_close(source);
    script_free(&s);
}

static void try_values(const script *s)
{
    double *value = malloc((size_t)(3 * s->curves + 1) * sizeof *value);
    for (int64_t i = 0; value && i < s->keys; i++)
        script_values(s, s->time[i], value);
    free(value);
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
        try_values(&s);
    }
    in_close(source);
    script_free(&s);
    take_poses(data, size, &m);
    take_live(data, size, &m);
    model_free(&m);
    return 0;
}
