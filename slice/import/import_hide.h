/* What us-import says of files without their names and contents, which may be of people: an error's place becomes a
 * number or a word for the file, and what stands between single quotes (names, words of a header) is left out. Keeps
 * nothing.
 */
#ifndef SINEW_IMPORT_HIDE_H
#define SINEW_IMPORT_HIDE_H

#include "base/err.h"

enum { IMPORT_LABEL = 48 };

/* of: what the place is called instead, as "file 3 of 24"; "": it is not a file's, and stays. */
void import_hide(err *e, const char *of);

/* Of an error of the command line, whose words stay: only this one is left out, where it stands between quotes. */
void import_hide_word(err *e, const char *word);

#endif
