/* A change of one material, as a line of a file or assignments make it: which keys get which values. It is gathered
 * first and applied after, so that the order of its keys does not matter. Owns nothing.
 */
#ifndef SINEW_MATERIAL_EDIT_H
#define SINEW_MATERIAL_EDIT_H

#include "model/known.h"
#include "model/materials.h"

enum { MATERIAL_EDIT_FIBRE = LAW_ALL_KEYS + 1, MATERIAL_EDIT_NAMES };

/* "law", then the keys, then "fibre"; and the arrays of the keys. */
extern const char *const material_edit_names[MATERIAL_EDIT_NAMES];
extern const char *const material_edit_arrays[LAW_ALL_KEYS];

typedef struct material_edit {
    uint64_t given; /* bits of material_edit_names */
    material of;    /* what is given of it */
} material_edit;

/* Where a material has the value of a law_key. */
double *material_edit_value(material *of, int key);

/* The value of a key that stands in a model: nan where the material has no such key, or none is given. */
double material_edit_stored(const material *of, int key);

/* Whether materials may lack a key, which is nan in their row of its array: of laws, of fibres, and optional ones. */
static inline bool material_edit_optional(int key)
{
    return key < LAW_OWN_KEYS || key >= LAW_OPTIONAL;
}

/* All keys of laws become nan. */
void material_edit_clear(material *of);

/* Bits, 1 << LAW_E and so on, of the laws' keys that have a value. */
unsigned material_edit_keys(const material *of);

/* Whether the table of laws allows the value; words: what it expects. */
bool material_edit_valid(int key, double value, char words[KNOWN_WORDS]);

/* An unknown name in the file `place`, or, with line 0, in the option `place`. Returns -1. */
int material_edit_unknown(err *e, const char *place, int64_t line, const char *what, const char *name,
                          const char *const *names, int count);

/* Takes the value of material_edit_names[name]; the caller sets the bit in `given`. */
int material_edit_take(material_edit *r, int name, const char *text, const char *place, int64_t line, err *e);

/* Changes a material as the edit says, as materials_override describes. What is then wrong with its keys is told at
 * place:line. */
int material_edit_apply(material *to, const material_edit *edit, const char *place, int64_t line, err *e);

/* "E=3000 nu=0.49 density=1000", as a file of materials has it: what has a value in row i of a model's table. */
enum { MATERIAL_EDIT_WORDS = 32 * (LAW_ALL_KEYS + 1) };
void material_edit_words(const model *m, int64_t i, char to[MATERIAL_EDIT_WORDS]);

#endif
