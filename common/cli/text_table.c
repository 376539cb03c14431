#include "cli/text_table.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/num.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 16, WIDE = 80, INDENT = 2, GAP = 2, LEAST_FIRST = 24 };

struct text_table {
    const char *heads[COLUMNS];
    int columns;
    char **cell; /* owned, rows x columns */
    int64_t cells, capacity;
    err failed;
};

text_table *text_table_create(const char *const *heads, err *e)
{
    text_table *t = mem_array(1, sizeof *t, "a report", e);
    if (!t)
        return NULL;
    while (t->columns < COLUMNS && heads[t->columns]) {
        t->heads[t->columns] = heads[t->columns];
        t->columns++;
    }
    return t;
}

void text_table_free(text_table *t)
{
    for (int64_t i = 0; t && i < t->cells; i++)
        free(t->cell[i]);
    if (t)
        free(t->cell);
    free(t);
}

void text_table_cell(text_table *t, const char *format, ...)
{
    char text[1200];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    chars_tame(text);
    if (t->failed.status || MEM_ROOM(&t->cell, &t->capacity, t->cells + 1, "a report", &t->failed))
        return;
    char *copy = mem_text(text, &t->failed);
    if (copy)
        t->cell[t->cells++] = copy;
}

bool text_table_is_empty(const text_table *t)
{
    return !t->cells && !t->failed.status;
}

void text_table_count(text_table *t, int64_t number)
{
    text_table_cell(t, "%lld", (long long)number);
}

void text_table_number(text_table *t, double number, int decimals)
{
    if (isnan(number))
        text_table_cell(t, "-");
    else
        text_table_cell(t, "%.*f", decimals, number);
}

int text_table_decimals(double largest, int digits)
{
    if (!(fabs(largest) > 0) || isinf(largest))
        return 0;
    const int before = 1 + (int)floor(log10(fabs(largest)));
    return (int)num_clamp_int(digits - before, 0, 9);
}

/* ---- lines */

/* The part of a heading that is in its first or second line; those of one line stand in the second. */
static void head_line(const char *head, int line, char *to, size_t size)
{
    const char *text = head + 1, *second = strchr(text, '\n');
    if (line > 0)
        snprintf(to, size, "%s", second ? second + 1 : text);
    else
        snprintf(to, size, "%.*s", second ? (int)(second - text) : 0, text);
}

static int widest_of(const text_table *t, int column)
{
    int widest = 0;
    char head[80];
    for (int line = 0; line < 2; line++) {
        head_line(t->heads[column], line, head, sizeof head);
        const int width = chars_width(head);
        widest = width > widest ? width : widest;
    }
    for (int64_t i = column; i < t->cells - t->cells % t->columns; i += t->columns) {
        const int width = chars_width(t->cell[i]);
        widest = width > widest ? width : widest;
    }
    return widest;
}

/* The widths of columns; the first has what the others leave. */
static void find_widths(const text_table *t, int *width)
{
    int others = INDENT;
    for (int c = 0; c < t->columns; c++) {
        width[c] = widest_of(t, c);
        others += c ? GAP + width[c] : 0;
    }
    const int left = WIDE - others < LEAST_FIRST ? LEAST_FIRST : WIDE - others;
    width[0] = width[0] > left ? left : width[0];
}

/* A text that grows. */
typedef struct lines {
    char *text; /* owned */
    int64_t size, capacity;
    err *e;
    bool failed; /* for want of memory: e is filled, and what is added from then on is dropped */
} lines;

static void add(lines *to, const char *text, int64_t size)
{
    to->failed = to->failed || MEM_ROOM(&to->text, &to->capacity, to->size + size + 1, "a report", to->e);
    if (to->failed)
        return;
    memcpy(to->text + to->size, text, (size_t)size);
    to->size += size;
    to->text[to->size] = '\0';
}

static void add_spaces(lines *to, int count)
{
    while (count-- > 0)
        add(to, " ", 1);
}

/* Ends a line: without spaces at its end. */
static void end_line(lines *to)
{
    while (to->size && to->text[to->size - 1] == ' ')
        to->size--;
    add(to, "\n", 1);
}

static void add_cell(const text_table *t, lines *to, int column, const char *text, int width)
{
    const int spaces = width - chars_width(text);
    const bool right = t->heads[column][0] == '>';
    add_spaces(to, column ? GAP : INDENT);
    add_spaces(to, right ? spaces : 0);
    add(to, text, (int64_t)strlen(text));
    add_spaces(to, right ? 0 : spaces);
}

static void add_heads(const text_table *t, lines *to, const int *width)
{
    char head[80];
    bool two = false;
    for (int c = 0; c < t->columns; c++)
        two = two || strchr(t->heads[c], '\n');
    for (int line = two ? 0 : 1; line < 2; line++) {
        for (int c = 0; c < t->columns; c++) {
            head_line(t->heads[c], line, head, sizeof head);
            add_cell(t, to, c, head, width[c]);
        }
        end_line(to);
    }
}

static void add_row(const text_table *t, lines *to, char *const *cell, const int *width)
{
    for (int c = 0; c < t->columns; c++) {
        add_cell(t, to, c, cell[c], width[c]);
        if (c == 0 && chars_width(cell[c]) > width[c]) {
            end_line(to);
            add_spaces(to, INDENT + width[0]);
        }
    }
    end_line(to);
}

char *text_table_lines(const text_table *t, err *e)
{
    lines to = {.e = e};
    if (err_join(e, &t->failed))
        return NULL;
    int *width = mem_array(t->columns, sizeof *width, "a report", e);
    if (!width)
        return NULL;
    find_widths(t, width);
    add_heads(t, &to, width);
    for (int64_t i = 0; i + t->columns <= t->cells; i += t->columns)
        add_row(t, &to, &t->cell[i], width);
    free(width);
    if (!to.failed)
        return to.text;
    free(to.text);
    return NULL;
}

int text_table_put(text_table *t, out *to, err *e)
{
    char *text = t ? text_table_lines(t, e) : NULL;
    text_table_free(t);
    out_text(to, text ? text : "");
    free(text);
    return text ? 0 : -1;
}
