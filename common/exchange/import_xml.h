/* The data of arrays in VTK's XML. Texts point into the file's bytes, which are the caller's and are not changed;
 * nothing here is kept but what a function says is the caller's to free.
 */
#ifndef SINEW_IMPORT_XML_H
#define SINEW_IMPORT_XML_H

#include "base/xml.h"

/* How a file's arrays are stored. */
typedef struct xml_style {
    int header; /* bytes of a header's number: 4 or 8 */
    bool big, zlib;
    bool base64;                         /* of appended data */
    const char *appended, *appended_end; /* or NULL */
} xml_style;

/* One array: where it is and of what. */
typedef struct xml_array {
    char type[XML_VALUE], name[XML_VALUE], format[XML_VALUE];
    int64_t components, offset;
    const char *begin, *end; /* of what stands inline */
    int64_t line;
} xml_array;

/* Its numbers as doubles, the caller's to free: `count` of them are expected. NULL with e filled. */
double *xml_numbers(const xml *x, const xml_style *style, const xml_array *a, int64_t count, err *e);

/* Its bytes where it is of strings, each with its NUL, and the whole with another. *size: without that. */
char *xml_strings(const xml *x, const xml_style *style, const xml_array *a, size_t *size, err *e);

#endif
