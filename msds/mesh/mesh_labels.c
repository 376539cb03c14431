#include "msds/mesh/mesh_labels.h"

#include "base/mem.h"
#include "base/num.h"
#include "model/materials.h"
#include "msds/mesh/mesh_chosen.h"
#include "surface/names.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    NAME = 400, /* bytes of one name in a list */
    TOLD = 20   /* labels without a tetrahedron that are told one by one */
};

/* Whether the first `before` bytes of the list name the label already. */
static bool named(const char *list, size_t before, int64_t value)
{
    for (const char *p = list; p < list + before; p += strcspn(p, ",") + 1) {
        char number[NAME];
        int64_t other;
        snprintf(number, sizeof number, "%.*s", (int)strcspn(p, "="), p);
        if (!num_int(number, INT64_MIN, INT64_MAX, &other) && other == value)
            return true;
    }
    return false;
}

/* One "VALUE=NAME" of the list, `before` bytes in. */
static int take_name(volume *labels, const char *list, size_t before, char *item, err *e)
{
    char *equals = strchr(item, '=');
    int64_t value;
    if (equals)
        *equals = '\0';
    if (!equals || !equals[1] || num_int(item, INT64_MIN, INT64_MAX, &value))
        return err_usage(e, "--names: '%s'; expected LABEL=NAME, such as 1=bone,2=vein", item);
    if (named(list, before, value))
        return err_usage(e, "--names: label %" PRId64 " is named twice; expected each once", value);
    return volume_name(labels, value, equals + 1, e);
}

int mesh_label_names(volume *labels, const char *list, err *e)
{
    size_t length;
    for (const char *p = list; p; p = p[length] ? p + length + 1 : NULL) {
        char item[NAME];
        length = strcspn(p, ",");
        if (length >= sizeof item)
            return err_usage(e, "--names: a name of %zu bytes; expected fewer than %d", length, NAME);
        snprintf(item, sizeof item, "%.*s", (int)length, p);
        if (take_name(labels, list, (size_t)(p - list), item, e))
            return -1;
    }
    return 0;
}

/* ---- labels of elements */

static void centre(const int32_t *node, const double *position, double to[3])
{
    for (int a = 0; a < 3; a++) {
        to[a] = 0;
        for (int c = 0; c < 4; c++)
            to[a] += position[3 * (int64_t)node[c] + a] / 4;
    }
}

/* The label of each element. A number that is none has no label. */
static int find_labels(const model *m, const volume *labels, const char *where, int64_t *label, err *e)
{
    const model_array *node = model_find(m, "element.node"), *position = model_find(m, "node.position");
    volume_finder f = volume_finder_of(labels);
    for (int64_t n = 0; n < node->rows; n++) {
        double at[3];
        centre(&node->i32[4 * n], position->f64, at);
        int64_t voxel = volume_nearest(labels, &f, at);
        if (mesh_chosen_read(labels, voxel, where, &label[n], e))
            return -1;
    }
    return 0;
}

static int compare(const void *a, const void *b)
{
    int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x > y) - (x < y);
}

/* The labels that there are, in ascending order, 0 aside, and the volume of each. */
typedef struct found {
    int64_t *value;
    int32_t *volume;
    int64_t count;
    names names; /* of volumes */
} found;

static void found_free(found *f)
{
    free(f->value);
    free(f->volume);
    names_free(&f->names);
}

static int name_volumes(found *f, const volume *labels, err *e)
{
    if (names_number(&f->names, "tissue", e) < 0)
        return -1;
    for (int64_t i = 0; i < f->count; i++) {
        char number[40];
        const char *name = volume_label_of(labels, f->value[i]);
        snprintf(number, sizeof number, "label%" PRId64, f->value[i]);
        f->volume[i] = names_number(&f->names, name ? name : number, e);
        if (f->volume[i] < 0)
            return -1;
    }
    return 0;
}

static int find_volumes(found *f, const volume *labels, const int64_t *label, int64_t elements, err *e)
{
    f->value = mem_array(elements, sizeof *f->value, "labels", e);
    f->volume = f->value ? mem_array(elements, sizeof *f->volume, "labels", e) : NULL;
    if (!f->volume)
        return -1;
    memcpy(f->value, label, (size_t)elements * sizeof *label);
    qsort(f->value, (size_t)elements, sizeof *f->value, compare);
    for (int64_t i = 0; i < elements; i++)
        if (f->value[i] && (!f->count || f->value[f->count - 1] != f->value[i]))
            f->value[f->count++] = f->value[i];
    return name_volumes(f, labels, e);
}

/* ---- labels that nothing is of */

typedef struct missed {
    int64_t value[TOLD];
    int count;
    bool more;
} missed;

static void add_missed(missed *m, int64_t value)
{
    for (int i = 0; i < m->count; i++)
        if (m->value[i] == value)
            return;
    m->more = m->count == TOLD;
    if (m->count < TOLD)
        m->value[m->count++] = value;
}

static bool left_out(const mesh_without *without, int64_t label)
{
    return without && without->is(without->context, label);
}

/* The image's labels that no element has. */
static void find_missed(missed *m, const found *f, const volume *labels, const mesh_without *without)
{
    double last = 0;
    for (int64_t voxel = 0; voxel < volume_count(labels) && !m->more; voxel++) {
        const double value = volume_value(labels, voxel);
        if (value == last || !(fabs(value) <= 9e15))
            continue;
        last = value;
        const int64_t label = (int64_t)value;
        if (label && !left_out(without, label) &&
            !bsearch(&label, f->value, (size_t)f->count, sizeof *f->value, compare))
            add_missed(m, label);
    }
}

static void note_one(const volume *labels, int64_t value, const char *what, notes *warnings)
{
    const char *name = volume_label_of(labels, value);
    if (name)
        notes_add(warnings, "label %" PRId64 " (%s) %s", value, name, what);
    else
        notes_add(warnings, "label %" PRId64 " %s", value, what);
}

/* What is too thin, or not where the mesh is; and names of no voxel. */
static void note_missed(const found *f, const volume *labels, const mesh_without *without, notes *warnings)
{
    missed m = {.count = 0};
    find_missed(&m, f, labels, without);
    for (int i = 0; i < m.count; i++)
        note_one(labels, m.value[i],
                 "has no tetrahedron, because no tetrahedron has its centre in it; expected a label inside the mesh, "
                 "and more nodes where it is thin",
                 warnings);
    if (m.more)
        notes_add(warnings, "other labels have no tetrahedron either");
    for (int i = 0; i < labels->labels && !m.more; i++) {
        bool any = bsearch(&labels->label[i].value, f->value, (size_t)f->count, sizeof *f->value, compare) != NULL;
        for (int k = 0; k < m.count; k++)
            any = any || m.value[k] == labels->label[i].value;
        if (!any && labels->label[i].value && !left_out(without, labels->label[i].value))
            note_one(labels, labels->label[i].value, "is named, but no voxel has this label", warnings);
    }
}

/* ---- tables */

static int add_table(model *m, char *const *name, int32_t count, err *e)
{
    static const char *const array[] = {"volume.name",     "volume.level",  "volume.priority",
                                        "volume.material", "volume.muscle", "element.volume"};
    if (model_axis_add(m, "volume", count, e))
        return -1;
    for (size_t i = 0; i < sizeof array / sizeof *array; i++)
        if (!model_add(m, array[i], e))
            return -1;
    for (int32_t v = 0; v < count; v++) {
        int32_t own = materials_find(m, name[v]);
        if (model_set_text(model_find(m, "volume.name"), v, name[v], e))
            return -1;
        model_find(m, "volume.priority")->i32[v] = v;
        model_find(m, "volume.material")->i32[v] = own < 0 ? 0 : own;
    }
    return 0;
}

static void put_volumes(model *m, const found *f, const int64_t *label)
{
    model_array *of = model_find(m, "element.volume");
    for (int64_t n = 0; n < of->rows; n++) {
        const int64_t *at = bsearch(&label[n], f->value, (size_t)f->count, sizeof *f->value, compare);
        of->i32[n] = at ? f->volume[at - f->value] : 0;
    }
}

int mesh_label(model *m, const volume *labels, const char *where, const int64_t *given, const mesh_without *without,
               notes *warnings, err *e)
{
    char tissue[] = "tissue", *const one[] = {tissue};
    int64_t elements = model_count(m, "element");
    found f = {0};
    if (!labels)
        return add_table(m, one, 1, e);
    int64_t *label = mem_array(elements, sizeof *label, "labels", e);
    int status = -1;
    if (label && given)
        memcpy(label, given, (size_t)elements * sizeof *label);
    if (label && (given || !find_labels(m, labels, where, label, e)) && !find_volumes(&f, labels, label, elements, e) &&
        !add_table(m, f.names.name, f.names.count, e)) {
        put_volumes(m, &f, label);
        note_missed(&f, labels, without, warnings);
        status = 0;
    }
    found_free(&f);
    free(label);
    return status;
}
