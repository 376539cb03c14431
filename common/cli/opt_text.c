/* What a table of options says of itself: the synopsis, provenance. */
#include "base/mem.h"
#include "base/path.h"
#include "cli/opt.h"
#include "cli/opt_complete.h"
#include "cli/spelling.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

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
        if (*p == '\'')
            out_text(to, "'\\''");
        else
            out_write(to, p, 1);
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

/* The same of NAME=FILE. */
static void put_named(const char *text, const void *options, out *to)
{
    char word[1024];
    const opt_common *common = options;
    const char *equals = strpbrk(text, "=:");
    if (!equals || !path_is_obj(equals + 1)) {
        put_word(text, to);
        return;
    }
    snprintf(word, sizeof word, "%.*s%s", (int)(equals + 1 - text), text,
             common->anonymous ? "FILE" : base_name(equals + 1));
    put_word(word, to);
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

/* A value of a list: a choice, or NAME=CHOICE, as the table spells it; what is neither stays as it is. */
static const char *spelled(const opt *o, const char *text, char *to, size_t size)
{
    char british[64];
    const char *equals = strrchr(text, '='), *word = equals ? equals + 1 : text;
    if (!o->choices || !spelling_british(word, strlen(word), british, sizeof british) ||
        opt_choice(o->choices, british) < 0)
        return text;
    const int length = snprintf(to, size, "%.*s%s", (int)(word - text), text, british);
    return length < (int)size ? to : text;
}

/* Writes the option as it stands; what is off or was not given (texts, lists) is left out. */
static void put_value(const opt *o, const void *options, out *to)
{
    const void *at = (const char *)options + o->to;
    const opt_list *list = at;
    char text[1024];
    if ((o->kind == OPT_FLAG && !*(const bool *)at) || (o->kind == OPT_TEXT && !*(const char *const *)at) ||
        (o->kind == OPT_LENGTHS && !((const opt_lengths *)at)->count) ||
        (o->kind == OPT_NUMBERS && !((const opt_numbers *)at)->count) ||
        (o->kind == OPT_NUMBER && isnan(*(const double *)at)) || (o->kind == OPT_INT && *(const int64_t *)at < 0) ||
        (o->kind == OPT_CHOICE && *(const int *)at < 0))
        return;
    if (o->kind == OPT_LIST) {
        for (int i = 0; i < list->count; i++) {
            put_name(o, to);
            if (o->flags & OPT_NAMED)
                put_named(list->value[i], options, to);
            else
                put_text(o->flags & OPT_FILE, spelled(o, list->value[i], text, sizeof text), options, to);
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
