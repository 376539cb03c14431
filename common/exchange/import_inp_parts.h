/* The types that the two halves of the reader of Abaqus input share: import_inp.c reads the lines, and import_inp_end.c
 * resolves what refers to other lines, once all are read.
 */
#ifndef SINEW_IMPORT_INP_PARTS_H
#define SINEW_IMPORT_INP_PARTS_H

#include "exchange/import_inp.h"
#include "exchange/import_sets.h"
#include "exchange/inp_law.h"

/* What the data lines after a keyword are. */
typedef enum inp_block {
    INP_NOTHING,
    INP_NODES,
    INP_ELEMENTS,
    INP_NODE_SET,
    INP_ELEMENT_SET,
    INP_MOVED,
    INP_ELASTIC,
    INP_HYPER,
    INP_HYPER_REST,
    INP_DENSITY,
    INP_HELD
} inp_block;

typedef struct inp_section {
    int32_t set, material;
    int64_t line;
} inp_section;

typedef struct inp_held {
    int32_t set, node; /* one of them -1 */
    uint8_t mask;
} inp_held;

typedef struct inp_reader {
    import_mesh *m;
    in *s;
    const import_wishes *w;
    notes *warnings;
    err *e;
    import_ids element_id;
    import_sets nodes, elements; /* NSETs, ELSETs */
    inp_section *sections;
    int64_t section_count, section_room;
    inp_held *holds;
    int64_t hold_count, hold_room;
    /* The keyword whose lines are being read. */
    inp_block now;
    int32_t set; /* that nodes or elements, or numbers, go to; -1: none */
    bool generates;
    int32_t columns;      /* of elements; 0: of fewer dimensions, passed over */
    int32_t material;     /* of *MATERIAL, or -1 */
    const inp_law *hyper; /* of INP_HYPER */
    int parts;            /* *PART, *INSTANCE */
    int32_t pending[32];  /* an element's numbers so far */
    int pending_count;
    int64_t pending_line;
    char noted[16][64]; /* keywords that were noted */
    int noted_count;
} inp_reader;

/* Abaqus's names have no case: in place, lower case, without the quotes and the instance that they may have. */
char *import_inp_name(char *name);

/* Once all lines are read: numbers become indices, sections volumes, *BOUNDARY rigid nodes. */
int import_inp_finish(inp_reader *r, const import_wishes *w);

#endif
