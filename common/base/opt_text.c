/* What a table of options says of itself: usage, synopsis, provenance. */
#include "base/mem.h"
#include "base/opt.h"
#include "base/opt_complete.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* "-s, --size H|HX,HY,HZ" */
static void put_option(const opt *o, char *to, size_t size)
{
    int n = 0;
    if (o->letter)
        n = snprintf(to, size, "-%c%s", o->letter, o->name ? ", " : "");
    if (o->name)
        n += snprintf(to + n, size - (size_t)n, "--%s", o->name);
    if (o->arg)
        snprintf(to + n, size - (size_t)n, " %s", o->arg);
}

enum { USAGE_LINES = 24 };

enum { USAGE_COLUMNS = 80 };

/* Puts text that stays in one piece behind what is there, or on the next line. Returns the column that it ends in. */
static size_t put_piece(const char *text, size_t length, size_t column, int *lines, out *to)
{
    const bool fits = column && column + 1 + length <= USAGE_COLUMNS;
    *lines += !fits;
    if (to)
        out_format(to, "%s%.*s", fits ? " " : column ? "\n  " : "  ", (int)length, text);
    return (fits ? column + 1 : 2) + length;
}

/* The options from number `from` on one after another, lines broken between words of what is said of them. Returns how
 * many lines; to may be NULL. */
static int put_packed(const opt_tool *tool, int from, out *to)
{
    const opt *o;
    size_t column = 0;
    int lines = 0;
    for (int i = from; (o = opt_at(tool, i)); i++) {
        char name[96], help[160];
        if (o->flags & OPT_HIDDEN)
            continue;
        put_option(o, name, sizeof name - 1);
        strcat(name, ":");
        column = put_piece(name, strlen(name), column, &lines, to);
        const opt *next = opt_at(tool, i + 1);
        snprintf(help, sizeof help, "%s%s", o->help, next && !(next->flags & OPT_HIDDEN) ? ";" : "");
        for (const char *word = help; *word; word += strspn(word, " ")) {
            size_t length = strcspn(word, " ");
            column = put_piece(word, length, column, &lines, to);
            word += length;
        }
    }
    if (to)
        out_text(to, "\n");
    return lines;
}

/* How many of its own options have a line each: all, or as many as leave room for the rest. */
static int apart(const opt_tool *tool)
{
    int lines = 2, own = opt_own(tool), count = own;
    for (int i = 0; i < own; i++)
        lines += !(opt_at(tool, i)->flags & OPT_HIDDEN);
    while (count > 0 && lines + put_packed(tool, count, NULL) > USAGE_LINES)
        lines -= !(opt_at(tool, --count)->flags & OPT_HIDDEN);
    return count;
}

void opt_usage(const opt_tool *tool, out *to)
{
    const opt *o;
    int own = opt_own(tool), alone = apart(tool);
    out_format(to, "usage: %s", tool->name);
    for (int i = 0; i < own; i++)
        if ((o = opt_at(tool, i))->flags & OPT_REQUIRED)
            out_format(to, " --%s %s", o->name, o->arg);
    if (!*tool->operands)
        out_format(to, " [options]\n%s\n", tool->purpose);
    else
        out_format(to, tool->operands_min ? " [options] %s\n%s\n" : " [options] [%s]\n%s\n", tool->operands,
                   tool->purpose);
    for (int i = 0; i < alone; i++) {
        char name[80];
        o = opt_at(tool, i);
        if (o->flags & OPT_HIDDEN)
            continue;
        put_option(o, name, sizeof name);
        out_format(to, strlen(name) > 30 ? "  %s  %s\n" : "  %-30s  %s\n", name, o->help);
    }
    put_packed(tool, alone, to);
}

/* mdoc wants its special characters away from macros' arguments: '|' is a delimiter and stands by itself, and a word
 * such as Pa is a macro unless \& is before it. */
static void put_mdoc_arg(const char *arg, out *to)
{
    for (const char *p = arg; *p; p++) {
        const bool begins = p == arg || p[-1] == '|';
        if (begins && isupper((unsigned char)p[0]) && islower((unsigned char)p[1]) && (!p[2] || p[2] == '|'))
            out_text(to, "\\&");
        if (*p == '|')
            out_text(to, " | ");
        else
            out_write(to, p, 1);
    }
}

static void put_mdoc(const opt_tool *tool, out *to)
{
    const opt *o;
    out_format(to, ".Nm %s\n", tool->name);
    for (int i = 0; (o = opt_at(tool, i)); i++) {
        if (o->flags & (OPT_HIDDEN | OPT_ALSO))
            continue;
        out_text(to, o->flags & OPT_REQUIRED ? ".Fl" : ".Op Fl");
        if (o->letter)
            out_format(to, " %c", o->letter);
        else
            out_format(to, " -%s", o->name);
        if (o->arg) {
            out_text(to, " Ar ");
            put_mdoc_arg(o->arg, to);
        }
        out_text(to, "\n");
    }
    if (*tool->operands) {
        out_text(to, tool->operands_min ? ".Ar " : ".Op Ar ");
        put_mdoc_arg(tool->operands, to);
        out_text(to, "\n");
    }
}

int opt_table(const opt_tool *tool, const char *kind, out *to, err *e)
{
    if (!strcmp(kind, "mdoc"))
        put_mdoc(tool, to);
    else if (!strcmp(kind, "bash"))
        opt_complete_bash(tool, to);
    else if (!strcmp(kind, "zsh"))
        opt_complete_zsh(tool, to);
    else
        return err_usage(e, "--table '%s': expected mdoc, bash or zsh", kind);
    return 0;
}

/* Paths stay out of results. */
static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash && slash[1] ? slash + 1 : path;
}

/* A word of the command line, in single quotes where it would not stay one as it is. */
static void put_word(const char *text, out *to)
{
    out_text(to, out_count(to) ? " " : "");
    if (*text && !strpbrk(text, " \t\n\r\v\f'\"\\")) {
        out_text(to, text);
        return;
    }
    out_text(to, "'");
    for (const char *p = text; *p; p++)
        out_write(to, *p == '\'' ? "'\\''" : p, *p == '\'' ? 4 : 1);
    out_text(to, "'");
}

/* The text of an option or an operand; of a file's name only its base, or that it is one. */
static void put_text(bool file, const char *text, const void *options, out *to)
{
    const opt_common *common = options;
    if (file)
        text = common->anonymous ? "FILE" : base_name(text);
    put_word(text, to);
}

static void put_number(const char *before, double value, out *to)
{
    char text[NUM_TEXT];
    num_text(value, false, text);
    out_format(to, "%s%s", before, text);
}

static void put_lengths(const opt_lengths *l, out *to)
{
    for (int i = 0; i < l->count; i++) {
        put_number(i ? "," : " ", l->value[i].value, to);
        out_text(to, l->value[i].unit ? num_unit_name(l->value[i].unit) : "");
    }
}

static void put_numbers(const opt_numbers *l, out *to)
{
    for (int i = 0; i < l->count; i++)
        put_number(i ? "," : " ", l->value[i], to);
}

static void put_choice(const opt *o, int value, out *to)
{
    const char *p = o->choices;
    for (int i = 0; i < value; i++)
        p = strchr(p, '|') + 1;
    out_format(to, " %.*s", (int)strcspn(p, "|"), p);
}

static void put_name(const opt *o, out *to)
{
    out_text(to, out_count(to) ? " " : "");
    if (o->letter)
        out_format(to, "-%c", o->letter);
    else
        out_format(to, "--%s", o->name);
}

/* Writes the option as it stands; what is off or was not given (texts, lists) is left out. */
static void put_value(const opt *o, const void *options, out *to)
{
    const void *at = (const char *)options + o->to;
    const opt_list *list = at;
    if ((o->kind == OPT_FLAG && !*(const bool *)at) || (o->kind == OPT_TEXT && !*(const char *const *)at) ||
        (o->kind == OPT_LENGTHS && !((const opt_lengths *)at)->count) ||
        (o->kind == OPT_NUMBERS && !((const opt_numbers *)at)->count) ||
        (o->kind == OPT_NUMBER && isnan(*(const double *)at)) || (o->kind == OPT_INT && *(const int64_t *)at < 0))
        return;
    if (o->kind == OPT_LIST) {
        for (int i = 0; i < list->count; i++) {
            put_name(o, to);
            put_text(o->flags & OPT_FILE, list->value[i], options, to);
        }
        return;
    }
    put_name(o, to);
    if (o->kind == OPT_TEXT)
        put_text(o->flags & OPT_FILE, *(const char *const *)at, options, to);
    else if (o->kind == OPT_INT)
        out_format(to, " %lld", (long long)*(const int64_t *)at);
    else if (o->kind == OPT_NUMBER)
        put_number(" ", *(const double *)at, to);
    else if (o->kind == OPT_LENGTHS)
        put_lengths(at, to);
    else if (o->kind == OPT_NUMBERS)
        put_numbers(at, to);
    else if (o->kind == OPT_CHOICE)
        put_choice(o, *(const int *)at, to);
}

char *opt_provenance(const opt_tool *tool, const void *options, int operands, char *const *operand, err *e)
{
    out *to = out_memory(e);
    if (!to)
        return NULL;
    for (int i = 0; i < opt_own(tool); i++)
        if (!(opt_at(tool, i)->flags & (OPT_OUTPUT | OPT_ALSO)))
            put_value(opt_at(tool, i), options, to);
    for (int i = 0; i < operands; i++)
        put_text(true, operand[i], options, to);
    out_write(to, "", 1);
    size_t size;
    char *text = mem_text((const char *)out_bytes(to, &size), e);
    out_discard(to);
    return text;
}
