/* The items that a model stream consists of, and the table of functions that an encoding is. text.c and binary.c turn
 * bytes into items and items into bytes, and know no more; stream.c knows which item may stand where. An item that was
 * read owns what hangs on it; one that is written borrows it all.
 */
#ifndef SINEW_ITEM_H
#define SINEW_ITEM_H

#include "base/in.h"
#include "base/out.h"
#include "model/model.h"

enum { ITEM_PLACE = 600 }; /* bytes that hold a place */

enum { ITEM_MAJOR = 1, ITEM_MINOR = 0 }; /* the version that is written */

typedef enum item_kind {
    ITEM_META,  /* key, text */
    ITEM_PROV,  /* text: TOOL VERSION OPTIONS */
    ITEM_AXIS,  /* key, number: its count */
    ITEM_ARRAY, /* array */
    ITEM_BLOCK, /* block: of a type that we do not know */
    ITEM_FRAME, /* number: its index; time */
    ITEM_END,
    ITEM_FAIL /* number: the status; text */
} item_kind;

typedef struct item {
    item_kind kind;
    int64_t at; /* its line (text) or the number of its block (binary) */
    char *key, *text;
    int64_t number;
    double time;
    model_array array;
    bool finite; /* of array: it is known that all values are finite */
    bool within; /* likewise, that all are indices in their range (check_range) */
    bool passed; /* its values were passed over: array has none */
    model_block block;
} item;

typedef struct item_source item_source;

typedef struct encoding {
    bool lines; /* places are lines; else blocks */
    /* Reads the first line or magic. */
    int (*begin)(item_source *s, err *e);
    /* Reads the next item into an empty one. The caller frees it in every case. */
    int (*read)(item_source *s, item *it, err *e);
    void (*write_begin)(out *o);
    void (*write)(out *o, const item *it);
} encoding;

/* A stream that is being read. */
struct item_source {
    in *s;
    const encoding *how;
    model axes;     /* the axes so far, and nothing else: arrays take their rows from here */
    int64_t blocks; /* binary: blocks begun */
    char *held;     /* text: a line that was looked at and not taken; NULL: none */
    bool stopped;   /* it gave no more bytes where an item was to begin or go on */
    bool names;     /* names alone are wanted: see item_passes */
    char within;    /* the first character of the item last begun; 0: of none, the stream stopped before it */
};

void item_free(item *it);

/* What its block is called: "META", ... */
const char *item_type(const item *it);

/* Where the item stands: "stdin" (its line is it->at), or "stdin: block 7 (ARRY element.node)". */
void item_place(const item_source *s, const item *it, char *place, size_t size);

/* Fills e with that place. Always -1. */
int item_error(const item_source *s, const item *it, err *e, const char *format, ...) SINEW_PRINTF(4, 5);

/* The error of a stream that stops without `end` or `fail`. */
int item_cut(const item_source *s, err *e);

/* Checks the heading of an array just read (name, unit, axis, columns) and sets its
 * rows. Returns its count of values, or -1. */
int64_t item_heading(const item_source *s, item *it, err *e);

/* Whether the n values of an array are skipped without a check: if only names are wanted, those of
 * all arrays but strings and short ones. */
bool item_passes(const item_source *s, const item *it, int64_t n);

/* If only names are wanted: -1 with e filled once more of a text or gzip stream was read than takes about 0.1 s. */
int item_hurries(const item_source *s, err *e);

/* Makes every nan among n values the one that is written: quiet, positive, no payload. Returns whether all are
 * finite. */
bool item_canonical(model_type type, void *values, int64_t n);

/* Makes doubles of an array of f32, which is then narrow (model.h); one without values stays so. -1 with e filled. */
int item_widen(model_array *a, err *e);

/* Rounds n doubles to the nearest floats. */
void item_round(const double *from, float *to, int64_t n);

/* Whether rounding leaves every finite number of an array finite. */
bool item_rounds(const model_array *a);

#endif
