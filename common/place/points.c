#include "place/points.h"

#include "base/keyfile.h"
#include "base/mem.h"
#include "base/space.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- a point */

static int add(points *p, const char *place, const points_one *one, const char *name, err *e)
{
    if (p->count == POINTS_MOST)
        return err_set(e, place, one->line, "more than %d points; expected those that were picked", POINTS_MOST);
    if (MEM_ROOM(&p->one, &p->room, p->count + 1, "points", e))
        return -1;
    p->one[p->count] = *one;
    p->one[p->count].name = mem_text(name, e);
    return p->one[p->count++].name ? 0 : -1;
}

/* All have names, or none has. */
static int check_names(points *p, const char *place, err *e)
{
    p->named = p->count && *p->one[0].name;
    for (int64_t i = 0; i < p->count; i++)
        if (!*p->one[i].name == p->named)
            return err_set(e, place, p->one[i].line, "a point %s a name, after others %s; expected all of one kind",
                           p->named ? "without" : "with", p->named ? "with one" : "without");
    if (!p->named)
        return 0;
    if (lookup_add(&p->names, p->one, sizeof *p->one, (int32_t)p->count, e))
        return -1;
    for (int64_t i = 0; i < p->count; i++)
        if (lookup_find(&p->names, p->one, sizeof *p->one, p->one[i].name) != i)
            return err_set(e, place, p->one[i].line, "a second point '%.100s'; expected each name once",
                           p->one[i].name);
    return 0;
}

/* ---- text */

static int take_words(points *p, const keyfile *k, num_unit unit, err *e)
{
    points_one one = {.line = k->line};
    const int first = k->count - 3;
    if (first != 0 && first != 1)
        return keyfile_error(k, e, "%d words; expected x y z, or NAME x y z", k->count);
    for (int i = 0; i < 3; i++) {
        double v;
        if (num_double(k->word[first + i], &v))
            return keyfile_error(k, e, "'%.100s' is not a finite number; expected x y z, or NAME x y z",
                                 k->word[first + i]);
        one.at[i] = num_length_in((num_length){v, unit}, unit, num_unit_of("m"));
    }
    return add(p, k->name, &one, first ? k->word[0] : "", e);
}

static int read_text(points *p, in *s, num_unit unit, err *e)
{
    keyfile k;
    int more;
    if (!unit)
        return err_set(e, in_name(s), 0, "is text, whose unit is not said; expected --unit with " NUM_UNITS);
    keyfile_open(&k, s);
    while ((more = keyfile_next(&k, e)) > 0)
        if (take_words(p, &k, unit, e))
            return -1;
    return more;
}

/* ---- .fcsv */

static const char fcsv_first[] = "# Markups fiducial file";

enum { COLUMN_X, COLUMN_Y, COLUMN_Z, COLUMN_LABEL, COLUMNS, FIELDS = 64 };

typedef struct fcsv {
    in *source;
    const char *name;
    bool shown, has_space;
    space space;
    int column[COLUMNS];
} fcsv;

static int bad(const fcsv *f, err *e, const char *what, const char *expected)
{
    return err_set(e, f->name, in_lines(f->source), "%.120s; expected %s", what, expected);
}

/* Cuts a line at its commas, in place; a field in quotes may have some, and two quotes for one. Returns how many, -1: a
 * quote has no end, or there are more. */
static int cut(char *line, char *field[FIELDS])
{
    int n = 0;
    for (char *p = line;; p++) {
        if (n == FIELDS)
            return -1;
        field[n++] = p;
        if (*p == '"') {
            char *to = p;
            for (p++; *p && (*p != '"' || p[1] == '"'); p++) {
                p += *p == '"';
                *to++ = *p;
            }
            if (!*p++)
                return -1;
            *to = '\0';
        }
        p += strcspn(p, ",");
        if (!*p)
            return n;
        *p = '\0';
    }
}

static int take_columns(fcsv *f, char *text, err *e)
{
    static const char *const names[COLUMNS] = {"x", "y", "z", "label"};
    char *field[FIELDS];
    const int count = cut(text, field);
    for (int i = 0; i < COLUMNS; i++)
        f->column[i] = -1;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < COLUMNS; i++)
            if (!strcmp(field[k], names[i]))
                f->column[i] = k;
    if (f->column[COLUMN_X] < 0 || f->column[COLUMN_Y] < 0 || f->column[COLUMN_Z] < 0)
        return bad(f, e, "columns", "x, y and z among them");
    return 0;
}

static int take_space(fcsv *f, const char *text, err *e)
{
    f->has_space = true;
    f->space = !strcmp(text, "RAS") || !strcmp(text, "0") ? SPACE_RAS : SPACE_LPS;
    if (f->space == SPACE_RAS || !strcmp(text, "LPS") || !strcmp(text, "1"))
        return 0;
    return bad(f, e, "CoordinateSystem", "LPS (or 1) or RAS (or 0)");
}

static int take_header(fcsv *f, char *line, err *e)
{
    char *value = strchr(line, '=');
    if (!value)
        return 0;
    value += 1 + strspn(value + 1, " ");
    if (strstr(line, "CoordinateSystem"))
        return take_space(f, value, e);
    return strstr(line, "columns") ? take_columns(f, value, e) : 0;
}

static int take_row(fcsv *f, points *p, char *line, err *e)
{
    char *field[FIELDS];
    const int label = f->column[COLUMN_LABEL];
    points_one one = {.line = in_lines(f->source)};
    for (const char *c = line; *c; c++)
        if ((unsigned char)*c < ' ')
            return bad(f, e, "a control character", "a point in a line of text");
    if (!f->has_space)
        return bad(f, e, "a point before the axes are known", "# CoordinateSystem = LPS or RAS");
    const int count = cut(line, field);
    for (int i = 0; i < 3; i++)
        if (f->column[i] >= count || num_double(field[f->column[i]], &one.at[i]))
            return bad(f, e, "a point", "finite numbers x, y and z, as the columns say");
    space_point_of_mm(one.at, f->space, one.at);
    for (int i = 0; i < 2 && f->shown; i++)
        one.at[i] = -one.at[i];
    return add(p, f->name, &one, label >= 0 && label < count ? field[label] : "", e);
}

static int read_fcsv(points *p, in *s, bool shown, err *e)
{
    fcsv f = {.source = s, .name = in_name(s), .shown = shown, .column = {1, 2, 3, 11}};
    char *line;
    int64_t length;
    while ((length = in_line(s, &line, NULL, e)) >= 0) {
        if (!*line)
            continue;
        if (*line == '#' ? take_header(&f, line, e) : take_row(&f, p, line, e))
            return -1;
    }
    return length == -2 ? -1 : 0;
}

/* ---- any */

static int read_bytes(points *p, const char *bytes, int64_t size, const char *place, const points_wish *wish, err *e)
{
    if (*bytes == '{')
        return err_set(e, place, 0,
                       "is JSON, as Slicer's .mrk.json; expected text: save the points as .fcsv (in "
                       "Slicer's Save dialog, choose the file format Markups Fiducial CSV)");
    in *s = in_memory(bytes, (size_t)size, place, e);
    if (!s)
        return -1;
    const bool is_fcsv = !strncmp(bytes, fcsv_first, strlen(fcsv_first));
    const int failed = is_fcsv ? read_fcsv(p, s, wish->shown, e) : read_text(p, s, wish->unit, e);
    in_close(s);
    return failed ? -1 : check_names(p, place, e);
}

int points_read(points *p, in *s, const points_wish *wish, err *e)
{
    char *bytes = NULL;
    int failed = -1;
    if (in_peek(s, e) != -2) { /* steps over a byte order mark */
        const int64_t size = in_all(s, &bytes, e);
        failed = size < 0 ? -1 : read_bytes(p, bytes, size, in_name(s), wish, e);
    }
    free(bytes);
    return failed;
}

void points_free(points *p)
{
    for (int64_t i = 0; i < p->count; i++)
        free(p->one[i].name);
    free(p->one);
    lookup_free(&p->names);
    *p = (points){.count = 0};
}

/* ---- pairs */

int points_pair(const points *a, const points *b, const char *a_name, const char *b_name, bool by_order, int64_t *pair,
                err *e)
{
    const bool by_name = a->named && b->named && !by_order;
    for (int64_t i = 0; i < a->count; i++) {
        pair[i] = by_name ? lookup_find(&b->names, b->one, sizeof *b->one, a->one[i].name) : i;
        if (pair[i] < 0)
            return err_set(e, a_name, a->one[i].line,
                           "'%.100s' has no partner in %.200s; expected the same names in both, or --by-order",
                           a->one[i].name, b_name);
    }
    if (a->count != b->count)
        return err_set(e, b_name, 0, "has %lld points, but %.200s has %lld; expected as many", (long long)b->count,
                       a_name, (long long)a->count);
    return 0;
}
