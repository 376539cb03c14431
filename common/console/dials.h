/* What a page may change of a tool that runs: keys with their units, defaults and ranges, and the values that they have
 * now. The tools check each value again; these tables are for people. Owns nothing.
 */
#ifndef SINEW_DIALS_H
#define SINEW_DIALS_H

#include "base/out.h"

enum { DIALS_MOST = 16, DIALS_VALUE = 80 };

typedef struct dial {
    const char *key, *unit, *usual, *help;
    double low, high;    /* both 0: any, or no number */
    const char *choices; /* between '|'; NULL: any */
} dial;

typedef struct dials {
    const dial *table; /* its last has no key */
    char value[DIALS_MOST][DIALS_VALUE];
} dials;

/* With the values that a tool begins with. skin, labels: whether there is one of its own; whether there are any. */
dials dials_of_msds(bool skin);
dials dials_of_slice(bool labels);
dials dials_of_tled(void);

/* Notes the line `set KEY VALUE` or `now KEY VALUE`; another, or an unknown key, is let be. */
void dials_note(dials *d, const char *line);

/* The value of a key, or NULL. */
const char *dials_value(const dials *d, const char *key);

/* {"KEY":{"value":...,"unit":...,"default":...,"help":...,"min":...,"max":...,"choices":[...]},...} */
void dials_put(const dials *d, out *to);

#endif
