#include "render/field.h"

#include "base/mem.h"
#include "base/near.h"
#include "base/num.h"
#include "cli/spelling.h"
#include "mesh/gradient.h"
#include "mesh/node_values.h"
#include "mesh/quality.h"
#include "model/source.h"
#include "results/results.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The fields that are not arrays. */
static const char *const ours[] = {"displacement",     "strain",           "strain.max", "stress",
                                   "quality.j.centre", "quality.j.corner", "volume",     "material"};
enum { DISPLACEMENT, STRAIN, STRAIN_MAX, STRESS, CENTRE, CORNER, VOLUME, MATERIAL, OURS };

/* The displacements of a frame, or NULL with e filled. */
static const double *displacement(const frame *f, const char *name, err *e)
{
    const model_array *u = f ? frame_find(f, "node.displacement") : NULL;
    if (u)
        return u->f64;
    if (!f)
        err_set(e, NULL, 0,
                "%s cannot be shown at rest, because it needs a frame of results; expected a model from tled-run",
                name);
    else
        err_set(e, NULL, 0, "frame %lld has no node.displacement, which %s takes; expected results of tled-run",
                (long long)f->index, name);
    return NULL;
}

static int make(field *to, bool of_elements, int64_t count, const char *label, const char *si, err *e)
{
    to->of_elements = of_elements;
    to->count = count;
    snprintf(to->label, sizeof to->label, "%s", label);
    snprintf(to->si, sizeof to->si, "%s", si);
    to->value = mem_array(count, sizeof *to->value, "a field", e);
    return to->value ? 0 : -1;
}

/* ---- arrays */

double field_of_vector(const field *f, const double v[3])
{
    return f->component >= 0 ? v[f->component] : sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* One component, or the norm (component -1) of the three, or the one number. */
static int take_array(field *to, const model_array *a, err *e)
{
    if (a->columns == 3 && !to->of_elements) {
        to->vector = mem_array(3 * to->count, sizeof *to->vector, "a field", e);
        if (!to->vector)
            return -1;
    }
    for (int64_t n = 0; n < to->count; n++) {
        double v[3];
        for (int c = 0; c < a->columns; c++)
            v[c] = source_value(a, n * a->columns + c);
        to->value[n] = a->columns == 3 ? field_of_vector(to, v) : v[0];
        if (to->vector)
            memcpy(&to->vector[3 * n], v, sizeof v);
    }
    return 0;
}

static bool is_field(const model_array *a)
{
    bool over = !strcmp(a->axis, "node") || !strcmp(a->axis, "element");
    return over && a->type != MODEL_STR && (a->columns == 1 || (a->columns == 3 && a->unit[0] != '@'));
}

/* "array" or "array.x": the array, and the component or -1; NULL: no such array. */
static const model_array *find(const model *m, const frame *f, const char *name, int *component)
{
    char head[300];
    size_t n = strlen(name);
    const model_array *a = f ? frame_find(f, name) : NULL;
    *component = -1;
    a = a ? a : model_find(m, name);
    if (a && is_field(a))
        return a;
    if (n < 3 || n >= sizeof head || name[n - 2] != '.' || name[n - 1] < 'x' || name[n - 1] > 'z')
        return NULL;
    snprintf(head, sizeof head, "%.*s", (int)(n - 2), name);
    *component = name[n - 1] - 'x';
    a = f ? frame_find(f, head) : NULL;
    a = a ? a : model_find(m, head);
    return a && is_field(a) && a->columns == 3 ? a : NULL;
}

static int of_array(field *to, const model_array *a, int component, const char *label, err *e)
{
    const char *si = strcmp(a->unit, "1") != 0 && a->unit[0] != '@' ? a->unit : "";
    if (make(to, !strcmp(a->axis, "element"), a->rows, label, si, e))
        return -1;
    to->component = component;
    to->displaces = !strcmp(a->name, "node.displacement");
    to->below_zero = component >= 0 || a->columns == 1;
    return take_array(to, a, e);
}

/* ---- names: the volume of an element, and its material */

static int of_names(field *to, const model *m, bool of_material, err *e)
{
    const model_array *volume = model_need(m, "element.volume", e);
    const char *key = of_material ? "material.name" : "volume.name";
    const model_array *name = volume ? model_need(m, key, e) : NULL;
    const model_array *of = name && of_material ? model_need(m, "volume.material", e) : volume;
    if (!name || !of || make(to, true, volume->rows, ours[of_material ? MATERIAL : VOLUME], "", e))
        return -1;
    to->name = name->str;
    to->names = name->rows;
    for (int64_t n = 0; n < to->count; n++)
        to->value[n] = of_material ? of->i32[volume->i32[n]] : volume->i32[n];
    return 0;
}

/* ---- strain and stress */

static double strained(int which, const double h[9])
{
    double strain[9];
    gradient_strain(h, strain);
    return which == STRAIN ? 2. / 3 * gradient_mises(strain) : gradient_largest(strain);
}

static int of_strain(field *to, const model *m, const frame *f, int which, err *e)
{
    const double *u = displacement(f, ours[which], e);
    const model_array *node = u ? model_need(m, "element.node", e) : NULL;
    const model_array *rest = node ? model_need(m, "node.position", e) : NULL;
    if (!rest || make(to, true, node->rows, ours[which], "", e))
        return -1;
    to->below_zero = which == STRAIN_MAX;
    for (int64_t n = 0; n < node->rows; n++) {
        double h[9];
        gradient_of(&node->i32[n * node->columns], node->columns, rest->f64, u, h);
        to->value[n] = strained(which, h);
    }
    return 0;
}

/* A number of a result, as "element.stress.xx": which of its columns; -1: it is none. */
static int result_column(int row, const char *name)
{
    static const char *const tensor[] = {".xx", ".yy", ".zz", ".xy", ".yz", ".xz"}, *const values[] = {".1", ".2",
                                                                                                       ".3"};
    const int columns = results_columns(row);
    const char *part = name + strlen(results_array(row));
    if (columns <= 1)
        return columns == 1 && !*part ? 0 : -1;
    for (int i = 0; i < columns; i++)
        if (!strcmp(part, columns == 6 ? tensor[i] : values[i]))
            return i;
    return -1;
}

/* The row of results that the name is of, and the column; false: of none. */
static bool find_result(const char *name, int *row, int *column)
{
    for (*row = 0; *row < RESULTS; ++*row)
        if (!strncmp(name, results_array(*row), strlen(results_array(*row))) &&
            (*column = result_column(*row, name)) >= 0)
            return true;
    return false;
}

/* As the frame has it, or computed. The caller frees it. */
static float *numbers_of(const model *m, const frame *f, int row, err *e)
{
    const model_array *there = frame_find(f, results_array(row));
    const int64_t count = model_count(m, "element") * results_columns(row);
    results *r = NULL;
    float *to = mem_array(count, sizeof *to, "a field", e);
    if (!to)
        return NULL;
    if (there) {
        memcpy(to, there->f32, (size_t)count * sizeof *to);
        return to;
    }
    if (results_create(&r, m, 1U << row, NULL, e)) {
        free(to);
        return NULL;
    }
    results_of_elements(r, row, f, to);
    results_destroy(r);
    return to;
}

static int of_result(field *to, const model *m, const frame *f, const char *name, int row, int column, err *e)
{
    const bool pressure = row == RESULTS_STRESS || row == RESULTS_MISES;
    const char *unit = row == RESULTS_ENERGY ? "J/m3" : "";
    if (!displacement(f, name, e))
        return -1;
    float *number = numbers_of(m, f, row, e);
    if (!number || make(to, true, model_count(m, "element"), name, pressure ? "Pa" : unit, e)) {
        free(number);
        return -1;
    }
    to->below_zero = row != RESULTS_MISES && row != RESULTS_ENERGY;
    for (int64_t n = 0; n < to->count; n++)
        to->value[n] = (double)number[n * results_columns(row) + column];
    free(number);
    return 0;
}

static int of_quality(field *to, const model *m, const frame *f, int which, err *e)
{
    const double *u = displacement(f, ours[which], e);
    const model_array *node = u ? model_need(m, "element.node", e) : NULL;
    const model_array *rest = node ? model_need(m, "node.position", e) : NULL;
    if (!rest)
        return -1;
    const quality_mesh mesh = {node->i32, node->columns, node->rows, rest->f64, NULL};
    if (make(to, true, node->rows, ours[which], "", e))
        return -1;
    to->below_zero = to->folds = true;
    for (int64_t n = 0; n < node->rows; n++) {
        const quality_j j = quality_of(&mesh, n, u);
        to->value[n] = which == CENTRE ? j.centre : j.corner;
    }
    return 0;
}

/* ---- all of them by name */

static void note_arrays(const model_arrays *list, notes *names)
{
    for (int i = 0; i < list->count; i++)
        if (is_field(&list->v[i]) && results_find(list->v[i].name) == RESULTS)
            notes_add(names, "%s", list->v[i].name);
}

/* Of results, some: for messages. */
static const char *const computed[] = {"element.stress.mises", "element.stress.xx",     "element.strain.xx",
                                       "element.stretch.1",    "element.stretch.fibre", "element.energy"};

static int unknown(const model *m, const frame *f, const char *name, err *e)
{
    notes names = {0};
    for (int i = 0; i < OURS; i++)
        notes_add(&names, "%s", ours[i]);
    for (size_t i = 0; i < sizeof computed / sizeof *computed; i++)
        notes_add(&names, "%s", computed[i]);
    if (f)
        note_arrays(&f->arrays, &names);
    note_arrays(&m->arrays, &names);
    near_option(e, NULL, "field", name, (const char *const *)names.line, names.count);
    notes_free(&names);
    return -1;
}

/* Which of ours; OURS: none. */
static int own(const char *name)
{
    int i = 0;
    while (i < OURS && strcmp(name, ours[i]) != 0)
        i++;
    return i == OURS && !strncmp(name, "displacement.", 13) ? DISPLACEMENT : i;
}

enum { NAME = 120 };

/* The field's name: as typed if there is such a field, else in British spelling. */
static const char *spelled(const model *m, const frame *f, const char *typed, char to[NAME])
{
    int component;
    int row;
    const bool there = own(typed) < OURS || find_result(typed, &row, &component) || find(m, f, typed, &component);
    return there || !spelling_british(typed, strlen(typed), to, NAME) ? typed : to;
}

static int of_name(field *to, const model *m, const frame *f, const char *typed, err *e)
{
    char full[320], british[NAME];
    const char *name = spelled(m, f, typed, british);
    int which = own(name), component, row;
    const model_array *a;
    if (which == VOLUME || which == MATERIAL)
        return of_names(to, m, which == MATERIAL, e);
    if (which == STRAIN || which == STRAIN_MAX)
        return of_strain(to, m, f, which, e);
    if (which == STRESS)
        return of_result(to, m, f, name, RESULTS_MISES, 0, e);
    if (which == CENTRE || which == CORNER)
        return of_quality(to, m, f, which, e);
    if (which == DISPLACEMENT && !displacement(f, name, e))
        return -1;
    if (find_result(name, &row, &component))
        return of_result(to, m, f, name, row, component, e);
    snprintf(full, sizeof full, "%s%.300s", which == DISPLACEMENT ? "node." : "", name);
    a = find(m, f, full, &component);
    return a ? of_array(to, a, component, name, e) : unknown(m, f, name, e);
}

int field_of(field *to, const model *m, const frame *f, const char *name, err *e)
{
    *to = (field){0};
    if (!of_name(to, m, f, name, e))
        return 0;
    field_free(to);
    return -1;
}

void field_free(field *f)
{
    free(f->value);
    free(f->vector);
    *f = (field){0};
}

double *field_at_nodes(const field *f, const model *m, err *e)
{
    const int64_t nodes = model_count(m, "node");
    const model_array *node = f->of_elements ? model_need(m, "element.node", e) : NULL;
    double *value = mem_array(nodes, sizeof *value, "a field", e);
    if (!value || !f->of_elements) {
        if (value)
            memcpy(value, f->value, (size_t)nodes * sizeof *value);
        return value;
    }
    if (!node || node_values(node, f->value, f->folds ? NODE_LEAST : NODE_MEAN, value, nodes, e)) {
        free(value);
        return NULL;
    }
    return value;
}

const char *field_unit(const field *f, const model *m, double most, double *scale)
{
    const char *own_unit = model_meta_of(m, "source.unit");
    num_unit unit = own_unit ? num_unit_of(own_unit) : 0;
    *scale = 1;
    if (!strcmp(f->si, "m") && unit) {
        *scale = 1 / num_length_in((num_length){1, unit}, unit, num_unit_of("m"));
        return num_unit_name(unit);
    }
    if (!strcmp(f->si, "Pa") && most >= 1e3) {
        *scale = most >= 1e6 ? 1e-6 : 1e-3;
        return most >= 1e6 ? "MPa" : "kPa";
    }
    return f->si;
}
