/* What tests of a manual page have in common, of which a part is printed from a table: the part as it must be, between
 * two marked lines, and whether the page has it. Run from the top of the checkout.
 */
#ifndef SINEW_PAGE_TABLE_H
#define SINEW_PAGE_TABLE_H

#include "base/in.h"
#include "base/out.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

/* Whether the page holds the text, which starts with the line `begin`; the first line that differs is told. */
static inline bool page_has(const char *page, const char *begin, const char *text)
{
    const char *at = page ? strstr(page, begin) : NULL;
    while (at && *text && *at == *text)
        at++, text++;
    if (at && *text)
        printf("# the page has '%.*s', the table '%.*s'\n", (int)strcspn(at, "\n"), at, (int)strcspn(text, "\n"), text);
    return at && !*text;
}

/* Prints the part on standard output: the exit status. */
static inline int page_print(void (*print)(out *o))
{
    err e = {0};
    out *o = out_open(NULL, false, &e);
    print(o);
    return out_close(o, &e);
}

/* Two tests: the page in `file` is there, and what is printed is the page's part from the line `begin` on. */
static inline void page_test(const char *file, const char *begin, void (*print)(out *o), const char *says)
{
    err e = {0};
    char *page = NULL;
    size_t size;
    out *o = out_memory(&e);
    print(o);
    out_write(o, "", 1);
    in *s = in_open(file, &e);
    ok(s && in_all(s, &page, &e) > 0, "the manual page is there %s", e.text);
    ok(page_has(page, begin, (const char *)out_bytes(o, &size)), "%s", says);
    free(page);
    in_close(s);
    out_discard(o);
}

#endif
