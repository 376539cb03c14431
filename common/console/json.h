/* JSON, written piece by piece: texts in quotes, numbers as short as they read back. Keeps nothing.
 */
#ifndef SINEW_JSON_H
#define SINEW_JSON_H

#include "base/out.h"
#include "console/mailbox.h"

/* A string. Bytes that are not UTF-8 become '?'. */
void json_text(const char *text, out *to);

/* A string, or null where text is NULL. */
void json_text_or_null(const char *text, out *to);

/* A number; null where it is not finite. */
void json_number(double value, out *to);

/* [a,b,...] */
void json_numbers(const double *list, int count, out *to);

/* What was written to memory as a mail of text; `from`, which may be NULL, is freed. NULL with e filled. */
mail *json_mail(out *from, err *e);

/* {"type":"said",...}: a line for people. level: "info", "warning" or "error". NULL where memory is out. */
mail *json_said(const char *level, const char *tool, const char *text);

/* {"type":"saved","name":...,"url":...}: a file that a page may fetch. NULL where memory is out. */
mail *json_saved(const char *name);

#endif
