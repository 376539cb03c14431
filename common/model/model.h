/* The model in memory: metadata, provenance, axes (named counts) and typed arrays over them, as
 * sinew-model(5) defines. A model owns all that hangs on it; pointers to its arrays are valid until an array is
 * added or removed, pointers to data until the array is removed. Functions that can fail return -1 or NULL with e
 * filled.
 */
#ifndef SINEW_MODEL_H
#define SINEW_MODEL_H

#include "base/lookup.h"

#include <stddef.h>
#include <stdint.h>

enum { MODEL_NAME = 256 }; /* bytes that hold any name, key or unit, its NUL included */

typedef enum model_type { MODEL_F32, MODEL_F64, MODEL_I32, MODEL_I64, MODEL_U8, MODEL_STR, MODEL_TYPES } model_type;

typedef struct model_array {
    char *name;
    model_type type;
    char *unit; /* "m", "Pa", "1", …; "@axis": indices into that axis, -1 for none */
    char *axis;
    int32_t columns;
    int64_t rows; /* the axis's count */
    int64_t line; /* of its heading, where it was read as text; its rows are the lines after it; else 0 */
    union {       /* rows x columns, row by row */
        void *data;
        float *f32;
        double *f64;
        int32_t *i32;
        int64_t *i64;
        uint8_t *u8;
        char **str; /* each owned, UTF-8, never NULL */
    };
    bool lent; /* the data is someone else's, and only read */
    /* Of f64: its stream has it as f32. Where it was read, each number is one of an f32; writing rounds to the nearest.
     * So what computes with frames has doubles, whatever they are stored as. */
    bool narrow;
} model_array;

typedef struct model_arrays {
    model_array *v;
    int count;
    lookup index; /* of v */
} model_arrays;

typedef struct model_axis {
    char *name;
    int64_t count;
} model_axis;

typedef struct model_meta {
    char *key, *value;
} model_meta;

/* A block of a type that we do not know (its first letter is lower case), kept as it came. */
typedef struct model_block {
    char type[5];
    uint32_t flags;
    uint64_t length;
    unsigned char *payload;
} model_block;

typedef struct model {
    model_meta *meta;
    char **prov;
    model_axis *axes;
    model_arrays arrays;
    model_block *blocks;
    int metas, provs, axis_count, block_count;
    lookup meta_index, axis_index;
    char *stream; /* the name of what it was read from, owned; NULL: it was made */
} model;

/* One frame of results. */
typedef struct frame {
    int64_t index;
    double time; /* s */
    model_arrays arrays;
} frame;

void model_free(model *m); /* and zeroes it; a zeroed model is an empty one */
void frame_free(frame *f);

/* Metadata. model_meta_of: NULL where there is none. Numbers: `count` doubles
 * between spaces, as short as they read back. */
const char *model_meta_of(const model *m, const char *key);
int model_meta_set(model *m, const char *key, const char *value, err *e);
int model_meta_numbers(const model *m, const char *key, double *value, int count, err *e);
int model_meta_set_numbers(model *m, const char *key, const double *value, int count, err *e);

/* Appends the line `TOOL VERSION OPTIONS` (no third field where options is ""). Options that are not UTF-8 (file names
 * can be anything) get '?' for the bytes that are not. */
int model_prov_add(model *m, const char *tool, const char *version, const char *options, err *e);

/* The axis's count, or -1 where there is none. */
int64_t model_count(const model *m, const char *axis);
/* Adds the axis; it must not be there, unless with the same count. */
int model_axis_add(model *m, const char *axis, int64_t count, err *e);

/* NULL where there is none. */
model_array *model_find(const model *m, const char *name);
model_array *frame_find(const frame *f, const char *name);

/* The array, or NULL with e saying which tool makes it. */
model_array *model_need(const model *m, const char *name, err *e);

/* Adds a zeroed array whose type, unit, axis and columns the table of known arrays gives (known.h); its axis must be
 * there. An array of that name is replaced. Strings begin as "". */
model_array *model_add(model *m, const char *name, err *e);
/* The same for a frame of model m. */
model_array *frame_add(frame *f, const model *m, const char *name, err *e);
/* Adds an array of any name, of f64, whose numbers stand there already, and stay there unchanged as long as the frame
 * is. */
model_array *frame_lend(frame *f, const model *m, const char *name, const char *unit, const char *axis, int32_t columns,
                        const double *numbers, err *e);
/* Lets an array that was lent be of other numbers, as many: of f64, or of f32. A frame of these is for writing alone:
 * what is known as f64 is then stored as f32, like what is narrow. */
void model_array_lend(model_array *a, model_type type, const void *numbers);
/* Adds a zeroed array of any kind. */
model_array *model_add_as(model *m, const char *name, model_type type, const char *unit, const char *axis,
                          int32_t columns, err *e);

/* The array of that name in a list, or NULL. */
model_array *model_arrays_find(const model_arrays *list, const char *name);

/* For readers. Moves *a into the list, in the place of an array of its name where there is one; *a is then empty. */
model_array *model_arrays_take(model_arrays *list, model_array *a, err *e);
int model_block_take(model *m, model_block *b, err *e);
void model_array_free(model_array *a);

/* Sets one string of a MODEL_STR array, copying text. */
int model_set_text(model_array *a, int64_t at, const char *text, err *e);

void model_remove(model *m, const char *name);

/* Removes every array that is to go, all at once. */
void model_remove_all(model *m, bool goes(const model_array *a, const void *context), const void *context);

/* The same of a frame. */
void frame_remove_all(frame *f, bool goes(const model_array *a, const void *context), const void *context);

/* For a tool that changes an axis (its count or its order): removes the axis and every array that is over it or
 * points to it, noting those that the known table lacks. */
void model_axis_drop(model *m, const char *axis, notes *warnings);

/* Surfaces carried: the names S of axes "S/vertex", but for the user's ("x-"). *at, 0 at first, is how far the axes
 * have been walked. Returns the name of the next, or NULL past the last. */
const char *model_surface(const model *m, int *at, char *name, size_t size);

/* The line of a row where the array was read as text, else 0: for messages. */
static inline int64_t model_line(const model_array *a, int64_t row)
{
    return a->line > 0 ? a->line + 1 + row : 0;
}

/* The type that the array has in a stream. */
static inline model_type model_stored(const model_array *a)
{
    return a->narrow ? MODEL_F32 : a->type;
}

size_t model_type_size(model_type t);
const char *model_type_name(model_type t);
/* MODEL_TYPES where the name is none. */
model_type model_type_of(const char *name);

/* All of sinew-model(5)'s rules that a table can hold, on one array: known name with its type, unit, axis and columns;
 * indices and values in range. Where: the stream's name; line: 0, or the line of its heading (its rows follow, one a
 * line). Index ranges need all axes. Of a frame's array, m is the model that the frame belongs to. */
int model_check(const model *m, const model_array *a, const char *where, int64_t line, err *e);

#endif
