#include "solve/fields.h"

#include "base/checksum.h"
#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

static const char *const axis_name[FIELD_AXES] = {"node", "element"};

int fields_allocate(const fields *f, int where, field_values *v, const char *what, err *e)
{
    *v = (field_values){{NULL}};
    for (int i = 0; i < f->count; i++) {
        if (!fields_is_in(f, i, where))
            continue;
        v->of[i] = mem_array(fields_size(f, i), sizeof *v->of[i], what, e);
        if (!v->of[i])
            return -1;
    }
    return 0;
}

void fields_free(field_values *v)
{
    for (int i = 0; i < FIELDS_MOST; i++)
        free(v->of[i]);
    *v = (field_values){{NULL}};
}

uint32_t fields_crc(const fields *f, const field_values *v, uint32_t crc)
{
    for (int i = 0; i < f->count; i++)
        crc = checksum_add(crc, v->of[i], (size_t)fields_size(f, i) * sizeof *v->of[i]);
    return crc;
}

int fields_lend(const fields *f, int where, const field_values *v, frame *to, const model *m, err *e)
{
    for (int i = 0; i < f->count; i++) {
        const field *row = &f->field[i];
        if (fields_is_in(f, i, where) &&
            !frame_lend(to, m, row->name, row->unit, axis_name[row->axis], row->columns, v->of[i], e))
            return -1;
    }
    return 0;
}

const double *fields_find(const fields *f, int i, const frame *from)
{
    const field *row = &f->field[i];
    const model_array *a = frame_find(from, row->name);
    const bool fits = a && a->type == MODEL_F64 && a->columns == row->columns && a->rows == f->rows[row->axis] &&
                      !strcmp(a->axis, axis_name[row->axis]);
    return fits ? a->f64 : NULL;
}

bool fields_fit(const fields *f, int where, const frame *from)
{
    for (int i = 0; i < f->count; i++)
        if (fields_is_in(f, i, where) && !fields_find(f, i, from))
            return false;
    return true;
}

void fields_read(const fields *f, int where, const frame *from, field_values *v)
{
    for (int i = 0; i < f->count; i++)
        if (fields_is_in(f, i, where))
            memcpy(v->of[i], fields_find(f, i, from), (size_t)fields_size(f, i) * sizeof *v->of[i]);
}
