/* The table of the arrays that a state consists of: a row for each, in the order in which they are written. All that
 * copies a state goes over its solver's table: saving and restoring, snapshots, checkpoints, fingerprints, frames, and
 * a start from a frame. So a new array is a new row. Outside of an executor the numbers of every field are doubles, row
 * by row as a model has them; an executor lays them out as it likes. A solver owns its table, which is constant; the
 * caller owns field_values.
 */
#ifndef SINEW_FIELDS_H
#define SINEW_FIELDS_H

#include "model/model.h"

typedef enum field_axis { FIELD_NODE, FIELD_ELEMENT, FIELD_AXES } field_axis;

/* Where a field is written. What is neither can be found again from the others. */
enum { FIELD_IN_FRAMES = 1, FIELD_IN_CHECKPOINTS = 2 };

/* In place of these: every field, wherever it is written. */
enum { FIELDS_ALL = -1 };

enum { FIELDS_MOST = 8 };

typedef struct field {
    const char *name, *unit; /* of its array in a model, which is of f64 */
    field_axis axis;
    int columns;
    int where;           /* FIELD_IN_FRAMES and others, or 0 */
    const char *without; /* "velocity 0": how a run begins from a frame that lacks it; NULL: it cannot */
} field;

typedef struct fields {
    const field *field; /* count, at most FIELDS_MOST */
    int count;
    int64_t rows[FIELD_AXES]; /* of each axis */
} fields;

/* The numbers of a state: of each field rows x columns, in the order of the table; NULL where a field is not wanted. */
typedef struct field_values {
    double *of[FIELDS_MOST];
} field_values;

/* How many numbers field i has. */
static inline int64_t fields_size(const fields *f, int i)
{
    return f->rows[f->field[i].axis] * f->field[i].columns;
}

/* Whether field i is written in any of these places. */
static inline bool fields_is_in(const fields *f, int i, int where)
{
    return where == FIELDS_ALL || (f->field[i].where & where) != 0;
}

/* Zeroed memory for the fields of some places; what: for the message. -1 with e filled, and v to be freed all the
 * same. */
int fields_allocate(const fields *f, int where, field_values *v, const char *what, err *e);
void fields_free(field_values *v);

/* The checksum of all fields, going on from crc. */
uint32_t fields_crc(const fields *f, const field_values *v, uint32_t crc);

/* Lends the fields of some places to a frame of model m, which must have their axes. -1 with e filled. */
int fields_lend(const fields *f, int where, const field_values *v, frame *to, const model *m, err *e);

/* The numbers of field i in a frame; NULL where the frame lacks it, or has it in another shape. */
const double *fields_find(const fields *f, int i, const frame *from);

/* Whether a frame has the fields of some places; and copies them out of one that has. */
bool fields_fit(const fields *f, int where, const frame *from);
void fields_read(const fields *f, int where, const frame *from, field_values *v);

#endif
