/* The tags of XML that other programs write, and their attributes, one after another: no text between tags, no
 * entities, no declarations. Names and values point into the file's bytes, which are the caller's and are not changed.
 */
#ifndef SINEW_XML_H
#define SINEW_XML_H

#include "base/err.h"

#include <stddef.h>

enum { XML_ATTRIBUTES = 24, XML_VALUE = 128 };

typedef struct xml_tag {
    char name[XML_VALUE];                                                  /* "/X" where it closes X */
    char key[XML_ATTRIBUTES][XML_VALUE], value[XML_ATTRIBUTES][XML_VALUE]; /* values as far as they fit */
    const char *whole[XML_ATTRIBUTES], *whole_end[XML_ATTRIBUTES];         /* the values, all of them */
    int count;
    bool closed; /* <X/> */
    const char *begin;
} xml_tag;

typedef struct xml {
    const char *name, *what; /* the file's, and whose XML it is, for messages */
    const char *text, *at, *end;
} xml;

/* The next tag that is neither a comment nor a declaration: 1; 0: the end; -1 with e filled. */
int xml_next(xml *x, xml_tag *tag, err *e);

/* The index of an attribute, or -1; and its value, or NULL. */
int xml_find(const xml_tag *tag, const char *key);
const char *xml_value(const xml_tag *tag, const char *key);

/* The line of a place in the text. */
int64_t xml_line(const xml *x, const char *at);

#endif
