/* Reports as tables: columns stay aligned whatever the names, and lists of names in a sentence. */
#include "base/chars.h"
#include "cli/listing.h"
#include "cli/text_table.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

static const char *const heads[] = {"<name", ">size\nmm", "<", NULL};

static void is(const char *got, const char *want, const char *name)
{
    if (!ok(got && !strcmp(got, want), "%s", name))
        printf("# got\n%s# wanted\n%s", got ? got : "nothing\n", want);
}

/* The lines of a table of one row. */
static char *lines_of(const char *name)
{
    err e = {0};
    text_table *t = text_table_create(heads, &e);
    text_table_cell(t, "%s", name);
    text_table_number(t, 12.345, 1);
    text_table_cell(t, "!");
    char *text = text_table_lines(t, &e);
    text_table_free(t);
    return text;
}

static void test_rows(void)
{
    err e = {0};
    text_table *t = text_table_create(heads, &e);
    char *text = text_table_lines(t, &e);
    is(text, "        size\n  name    mm\n", "no rows: the headings alone");
    ok(text_table_is_empty(t), "without rows it is empty");
    free(text);
    text_table_cell(t, "a");
    text_table_number(t, 1234.5, 2);
    text_table_cell(t, "%s", "");
    text_table_cell(t, "longer");
    text_table_number(t, NAN, 2);
    text_table_cell(t, "!");
    text_table_cell(t, "half a row");
    ok(!text_table_is_empty(t), "with rows it is not");
    text = text_table_lines(t, &e);
    is(text, "             size\n  name         mm\n  a       1234.50\n  longer        -  !\n",
       "to the left, to the right, no spaces at the end");
    free(text);
    text_table_free(t);
    ok(!e.status, "no error");
}

/* The column in which the row's "12.3" ends. */
static int end_of_number(const char *text)
{
    const char *last = strstr(text, "12.3");
    const char *line = last;
    char head[2000];
    while (line > text && line[-1] != '\n')
        line--;
    snprintf(head, sizeof head, "%.*s", (int)(last + 4 - line), line);
    return chars_width(head);
}

static void test_names(void)
{
    static const struct {
        const char *name;
        int width; /* of what is shown */
    } given[] = {{"plain", 5},
                 {"h\u00e9", 2},
                 {"\u7b11\u808c\u4e00", 6},
                 {"e\u0301e\u0301e", 3},
                 {"\x1b[31m", 5},
                 {"\xc2\x9b"
                  "31m",
                  5},
                 {"\xff\xfe", 2}};
    char longest[256];
    for (size_t i = 0; i < sizeof given / sizeof *given; i++) {
        char *text = lines_of(given[i].name);
        const int column = given[i].width > 4 ? given[i].width : 4;
        ok(text && end_of_number(text) == 2 + column + 2 + 4, "the number is aligned after name %d", (int)i);
        ok(text && !strchr(text, '\x1b') && !strstr(text, "\xc2\x9b"), "and no terminal is steered");
        free(text);
    }
    memset(longest, 'x', sizeof longest - 1);
    longest[sizeof longest - 1] = '\0';
    char *text = lines_of(longest);
    ok(text && end_of_number(text) == 80 - 3, "a long name has a line of its own, and the numbers end in 80 columns");
    ok(strstr(text, longest) && strstr(text, longest)[255] == '\n', "the whole of it");
    free(text);
}

static void test_numbers(void)
{
    ok(text_table_decimals(123.4, 5) == 2 && text_table_decimals(.0123, 5) == 6, "five digits");
    ok(text_table_decimals(123456, 5) == 0 && text_table_decimals(0, 5) == 0 && text_table_decimals(NAN, 5) == 0,
       "no decimals of large numbers, 0 and nan");
    ok(text_table_decimals(1e-300, 5) == 9 && text_table_decimals(INFINITY, 5) == 0, "at most 9");
}

static void test_width(void)
{
    ok(chars_width("") == 0 && chars_width("abc") == 3, "ASCII");
    ok(chars_width("h\u00e9") == 2 && chars_width("e\u0301") == 1, "accents");
    ok(chars_width("\u7b11") == 2 && chars_width("\U0001f600") == 2, "wide characters");
    ok(chars_width("\xc3(") == 2 && chars_width("\xff") == 1, "bytes of no character");
}

static void test_listing(void)
{
    listing l = {0};
    is(listing_text(&l), "", "of none");
    listing_add(&l, "%s", "a");
    is(listing_text(&l), "a", "of one");
    listing_add(&l, "%s", "b");
    is(listing_text(&l), "a, b", "of two");
    l = (listing){0};
    for (int i = 0; i < 1000; i++)
        listing_add(&l, "muscle_%d", i);
    const char *text = listing_text(&l);
    ok(strlen(text) < sizeof l.text && !strncmp(text, "muscle_0, muscle_1, ", 20), "of many, what has room");
    const char *more = strstr(text, " and ");
    int64_t named = 1, left = more ? strtol(more + 5, NULL, 10) : 0;
    for (const char *p = text; (p = strstr(p, ", ")); p++)
        named++;
    ok(more && strstr(more, " more") && named + left == 1000, "and how many more");
}

int main(void)
{
    test_rows();
    test_names();
    test_numbers();
    test_width();
    test_listing();
    return done_testing();
}
