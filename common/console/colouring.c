#include "console/colouring.h"

#include "base/mem.h"
#include "base/near.h"
#include "console/json.h"
#include "mesh/node_values.h"
#include "mesh/quality.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name, *unit;
    int row; /* of results.h, the first of its columns; where it is one */
} table[COLOURINGS] = {[COLOURING_OWN] = {"own", "", RESULTS},
                       [COLOURING_DISPLACEMENT] = {"displacement", "m", RESULTS},
                       [COLOURING_SPEED] = {"speed", "m/s", RESULTS},
                       [COLOURING_QUALITY] = {"quality", "J", RESULTS},
                       [COLOURING_STRESS] = {"stress", "Pa", RESULTS_MISES},
                       [COLOURING_STRETCH] = {"stretch", "", RESULTS_STRETCH},
                       [COLOURING_FIBRE] = {"stretch.fibre", "", RESULTS_FIBRE_STRETCH},
                       [COLOURING_ENERGY] = {"energy", "J/m3", RESULTS_ENERGY}};

int colouring_room_make(colouring_room *room, const model *m, err *e)
{
    err lacks = {0};
    const int64_t elements = model_count(m, "element");
    *room = (colouring_room){.m = m};
    room->value = mem_array(model_count(m, "node"), sizeof *room->value, "colours", e);
    room->element = room->value ? mem_array(elements, sizeof *room->element, "colours", e) : NULL;
    room->number = room->element ? mem_array(elements, 3 * sizeof *room->number, "colours", e) : NULL;
    if (!room->number)
        return -1;
    results_create(&room->results, m, 0, NULL, &lacks);
    return 0;
}

void colouring_room_free(colouring_room *room)
{
    results_destroy(room->results);
    free(room->value);
    free(room->element);
    free(room->number);
    *room = (colouring_room){0};
}

const char *colouring_name(colouring is)
{
    return table[is].name;
}

int colouring_find(const char *name)
{
    for (int i = 0; i < COLOURINGS; i++)
        if (!strcmp(table[i].name, name))
            return i;
    return -1;
}

void colouring_words(char to[COLOURING_WORDS])
{
    const char *names[COLOURINGS];
    for (int i = 0; i < COLOURINGS; i++)
        names[i] = table[i].name;
    near_list(to, COLOURING_WORDS, names, COLOURINGS);
}

void colouring_put(out *to)
{
    out_text(to, "\"colours\":[");
    for (int i = COLOURING_DISPLACEMENT; i < COLOURINGS; i++) {
        out_text(to, i > COLOURING_DISPLACEMENT ? "," : "");
        json_text(table[i].name, to);
    }
    out_text(to, "],\"units\":{");
    for (int i = COLOURING_DISPLACEMENT; i < COLOURINGS; i++) {
        out_text(to, i > COLOURING_DISPLACEMENT ? "," : "");
        json_text(table[i].name, to);
        out_text(to, ":");
        json_text(table[i].unit, to);
    }
    out_text(to, "}");
}

/* 1, 2 or 5 times a power of ten, at least x. */
static double round_up(double x)
{
    const double power = pow(10, floor(log10(x)));
    for (int i = 0; i < 2; i++)
        if (x <= (i ? 2 : 1) * power)
            return (i ? 2 : 1) * power;
    return x <= 5 * power ? 5 * power : 10 * power;
}

static void fill_speed(const model_array *v, double *value, geometry_frame *to)
{
    static const double least = 1e-3; /* m/s */
    double most = least;
    for (int64_t n = 0; n < v->rows; n++) {
        const double *x = v->f64 + 3 * n;
        value[n] = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        most = fmax(most, value[n]);
    }
    to->value = value;
    to->low = 0;
    to->high = round_up(most);
}

/* A number an element at the nodes; other: what a node without one gets. False: no memory for it. */
static bool to_nodes(colouring_room *room, node_values_rule rule, double other, double *least, double *most)
{
    err none = {0};
    const int64_t nodes = model_count(room->m, "node");
    if (node_values(model_find(room->m, "element.node"), room->element, rule, room->value, nodes, &none))
        return false;
    for (int64_t n = 0; n < nodes; n++) {
        room->value[n] = isfinite(room->value[n]) ? room->value[n] : other;
        *least = fmin(*least, room->value[n]);
        *most = fmax(*most, room->value[n]);
    }
    return true;
}

/* Rounds the range of values that are 1 at rest outward to tenths. */
static void range_about_one(double least, double most, geometry_frame *to)
{
    static const double step = .1;
    to->low = step * floor(least / step);
    to->high = step * ceil(most / step);
    to->low -= to->low < to->high ? 0 : step;
}

static void fill_quality(colouring_room *room, geometry_frame *to)
{
    const model_array *node = model_find(room->m, "element.node"), *rest = model_find(room->m, "node.position");
    const quality_mesh mesh = {node->i32, node->columns, node->rows, rest->f64, NULL};
    double least = 1, most = 1;
    for (int64_t i = 0; i < node->rows; i++)
        room->element[i] = quality_of(&mesh, i, to->u).corner;
    if (!to_nodes(room, NODE_LEAST, 1, &least, &most))
        return;
    to->value = room->value;
    range_about_one(least, most, to);
}

static void fill_result(colouring is, colouring_room *room, const frame *f, geometry_frame *to)
{
    static const double smallest[COLOURINGS] = {[COLOURING_STRESS] = 10, [COLOURING_ENERGY] = 1};
    const int row = table[is].row, columns = results_columns(row);
    const bool one = is == COLOURING_STRETCH || is == COLOURING_FIBRE;
    double least = one, most = one ? 1 : smallest[is];
    results_of_elements(room->results, row, f, room->number);
    for (int64_t i = 0; i < model_count(room->m, "element"); i++)
        room->element[i] = (double)room->number[columns * i];
    if (!to_nodes(room, NODE_MEAN, one, &least, &most))
        return;
    to->value = room->value;
    if (one) {
        range_about_one(least, most, to);
        return;
    }
    to->low = 0;
    to->high = round_up(most);
}

void colouring_fill(colouring is, colouring_room *room, const frame *f, geometry_frame *to)
{
    const model_array *v = frame_find(f, "node.velocity");
    if (is == COLOURING_SPEED && v && v->type == MODEL_F64 && v->rows == model_count(room->m, "node"))
        fill_speed(v, room->value, to);
    if (is == COLOURING_QUALITY)
        fill_quality(room, to);
    if (table[is].row < RESULTS && room->results && frame_find(f, "node.displacement"))
        fill_result(is, room, f, to);
}
