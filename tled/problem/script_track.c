#include "base/mem.h"
#include "base/num.h"
#include "tled/muscle/muscles.h"
#include "tled/problem/script.h"

#include <stdlib.h>
#include <string.h>

/* Of the columns of a log these are levels; either, as what a muscle does without a rise and fall is its level. */
static const char *const logged[] = {"muscle.level.", "muscle.activation."};

typedef struct reader {
    script *s;
    const model *m;
    in *source;
    const char *name;
    bool is_smooth;
    int64_t line;
    char **cell; /* of the line that was read last: borrowed from it; owned */
    int64_t cells, room;
    char **column;           /* the header: targets, each owned; NULL: a column of a log that is no level; owned */
    int64_t columns, header; /* how many, and the header's line */
    double *row;             /* a time, and a level a column, of all rows; owned */
    int64_t rows, row_room;
    muscle_list named; /* by a word */
} reader;

static void free_reader(reader *r)
{
    for (int64_t i = 0; r->column && i < r->columns; i++)
        free(r->column[i]);
    free(r->column);
    free(r->cell);
    free(r->row);
    muscles_free(&r->named);
}

/* The next line that is neither empty nor a comment, cut at its tabs. 1; 0: the end; -1 with e filled. */
static int next_line(reader *r, err *e)
{
    char *text;
    int64_t length;
    while ((length = in_line(r->source, &text, NULL, e)) >= 0 && (!length || *text == '#'))
        ;
    r->line = in_lines(r->source);
    r->cells = 0;
    if (length < 0)
        return length == -1 ? 0 : -1;
    for (char *p = text, *next; p; p = next) {
        next = strchr(p, '\t');
        if (next)
            *next++ = '\0';
        if (MEM_ROOM(&r->cell, &r->room, r->cells + 1, "the track", e))
            return -1;
        r->cell[r->cells++] = p;
    }
    return 1;
}

/* ---- The header */

static const char *level_of_log(const char *cell, const char *prefix)
{
    const size_t n = strlen(prefix);
    return strncmp(cell, prefix, n) ? NULL : cell + n;
}

/* Which columns of a log are levels: *prefix gets what they begin with; NULL: the file is no log. */
static int find_prefix(const reader *r, const char **prefix, err *e)
{
    *prefix = NULL;
    for (size_t k = 0; k < sizeof logged / sizeof *logged; k++)
        for (int64_t i = 1; i < r->cells; i++) {
            if (!level_of_log(r->cell[i], logged[k]))
                continue;
            if (*prefix && *prefix != logged[k])
                return err_set(e, r->name, r->line, "has columns %sNAME and %sNAME; expected one kind", *prefix,
                               logged[k]);
            *prefix = logged[k];
        }
    return 0;
}

static int read_header(reader *r, err *e)
{
    const char *prefix;
    const int got = next_line(r, e);
    if (got < 0)
        return -1;
    if (!got || r->cells < 2 || (strcmp(r->cell[0], "time") != 0 && strcmp(r->cell[0], "time/s") != 0))
        return err_set(e, r->name, got ? r->line : 0,
                       "expected a header first: time, and a column a muscle, between tabs");
    if (find_prefix(r, &prefix, e))
        return -1;
    r->header = r->line;
    r->columns = r->cells - 1;
    r->column = mem_array(r->columns, sizeof *r->column, "the track", e);
    for (int64_t i = 0; r->column && i < r->columns; i++) {
        const char *name = prefix ? level_of_log(r->cell[i + 1], prefix) : r->cell[i + 1];
        if (name && !(r->column[i] = mem_text(name, e)))
            return -1;
    }
    return r->column ? 0 : -1;
}

/* ---- Rows */

static int read_row(reader *r, err *e)
{
    if (r->cells != r->columns + 1)
        return err_set(e, r->name, r->line, "%lld columns; expected %lld, as in the header", (long long)r->cells,
                       (long long)r->columns + 1);
    if (MEM_ROOM(&r->row, &r->row_room, (r->rows + 1) * r->cells, "the track", e))
        return -1;
    double *row = r->row + r->rows * r->cells;
    if (num_double(r->cell[0], &row[0]) || row[0] < 0)
        return err_set(e, r->name, r->line, "'%.200s' is not a time; expected a number from 0, in s", r->cell[0]);
    if (r->rows && row[0] <= row[-r->cells])
        return err_set(e, r->name, r->line, "time %.9g s comes after %.9g s; expected times that rise", row[0],
                       row[-r->cells]);
    for (int64_t i = 1; i < r->cells; i++)
        if (r->column[i - 1] && muscles_level(r->cell[i], &row[i]))
            return err_set(e, r->name, r->line, "level '%.200s' of %.200s; expected a number from 0 to 1", r->cell[i],
                           r->column[i - 1]);
    r->rows++;
    return 0;
}

static int read_rows(reader *r, err *e)
{
    int got;
    while ((got = next_line(r, e)) > 0)
        if (read_row(r, e))
            return -1;
    if (!got && !r->rows)
        return err_set(e, r->name, 0, "has no rows; expected a time and levels in each");
    return got;
}

/* ---- Curves */

static int add_keys(reader *r, int64_t curve, int64_t column, err *e)
{
    script *s = r->s;
    if (script_reserve(s, r->rows, e))
        return -1;
    script_curve *c = &s->curve[curve];
    c->key_first = (int32_t)s->keys;
    c->key_count = (int32_t)r->rows;
    c->end = r->row[(r->rows - 1) * (r->columns + 1)];
    c->from = SCRIPT_OF_TRACK;
    c->line = r->header;
    c->is_smooth = r->is_smooth;
    for (int64_t i = 0; i < r->rows; i++, s->keys++) {
        const double *row = r->row + i * (r->columns + 1);
        s->time[s->keys] = row[0];
        s->value[3 * s->keys] = row[column + 1];
        s->value[3 * s->keys + 1] = s->value[3 * s->keys + 2] = 0;
    }
    return 0;
}

/* A muscle or an expression, which must not be driven yet. */
static int drive(reader *r, script_curve *c, int64_t column, err *e)
{
    const int64_t there = script_find(r->s, c);
    const script_curve *other = there >= 0 && r->s->curve[there].key_count ? &r->s->curve[there] : NULL;
    if (other && other->from == SCRIPT_OF_TRACK)
        return err_set(e, r->name, r->header, "'%.200s' has two columns, the other as '%.200s'; expected one",
                       c->target, other->target);
    if (other)
        return err_set(e, r->name, r->header, "'%.200s' is driven by %.300s too, as '%.200s'; expected one of them",
                       c->target, script_place(r->s, other), other->target);
    const int64_t at = script_add_levels(r->s, r->m, c, true, e);
    return at < 0 ? -1 : add_keys(r, at, column, e);
}

static int drive_muscles(reader *r, char *word, int64_t column, err *e)
{
    if (muscles_named(&r->named, r->m, word, r->name, r->header, e))
        return -1;
    for (int32_t i = 0; i < r->named.count; i++) {
        script_curve c = {.verb = SCRIPT_CONTRACT,
                          .volume = r->named.volume[i],
                          .line = r->header,
                          .from = SCRIPT_OF_TRACK,
                          .target = word};
        if (drive(r, &c, column, e))
            return -1;
    }
    return 0;
}

static int drive_column(reader *r, int64_t column, err *e)
{
    char *word = r->column[column];
    script_curve c = {.verb = SCRIPT_EXPRESS, .line = r->header, .from = SCRIPT_OF_TRACK, .target = word};
    if (*word != '@')
        return drive_muscles(r, word, column, e);
    c.volume = expressions_find(r->s->expressions, word + 1, r->name, r->header, e);
    return c.volume < 0 ? -1 : drive(r, &c, column, e);
}

int script_read_track(script *s, in *source, const model *m, bool smooth, err *e)
{
    reader r = {.s = s, .m = m, .source = source, .name = in_name(source), .is_smooth = smooth};
    free(s->track);
    s->track = mem_text(r.name, e);
    int failed = !s->track || read_header(&r, e) || read_rows(&r, e);
    for (int64_t i = 0; !failed && i < r.columns; i++)
        failed = r.column[i] && drive_column(&r, i, e);
    free_reader(&r);
    return failed ? -1 : 0;
}
