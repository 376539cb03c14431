/* The help of a tool: how it is called, and its options by group, one a line, as long as it takes. */
#include "cli/opt.h"

#include <stdio.h>
#include <string.h>

enum {
    COLUMNS = 80,
    NAME = 160,    /* bytes of an option's names and value */
    NAME_MOST = 26 /* columns: behind a longer one, what is said of it begins on the next line */
};

static const char *const headings[OPT_GROUPS] = {
    [OPT_INPUT] = "Input",   [OPT_ACTION] = "What happens", [OPT_NUMERICS] = "Numerics",
    [OPT_RESULT] = "Output", [OPT_COMMON] = "Common",
};

const char *opt_command(const opt_tool *tool)
{
    return tool->command ? tool->command : tool->name;
}

void opt_usage(const opt_tool *tool, out *to)
{
    const char *line = tool->usage, *before = "usage:";
    while (line) {
        const size_t n = strcspn(line, "\n");
        out_format(to, "%-6s %s %.*s\n", before, opt_command(tool), (int)n, line);
        line = line[n] ? line + n + 1 : NULL;
        before = "";
    }
}

static bool is_shown(const opt *o)
{
    return !(o->flags & (OPT_HIDDEN | OPT_ALSO));
}

/* "-t, --time SECONDS", "    --rest, --equilibrium TOL" of option i. Returns its columns. */
static int names_of(const opt_tool *tool, int i, char to[NAME])
{
    const opt *o = opt_at(tool, i), *also;
    int n = 0;
    if (o->letter)
        n = snprintf(to, NAME, "-%c%s", o->letter, o->name ? ", " : "");
    if (o->name)
        n += snprintf(to + n, NAME - (size_t)n, "%s--%s", o->letter ? "" : "    ", o->name);
    while ((also = opt_at(tool, ++i)) && also->flags & OPT_ALSO)
        n += snprintf(to + n, NAME - (size_t)n, ", --%s", also->name);
    if (o->arg)
        n += snprintf(to + n, NAME - (size_t)n, " %s", o->arg);
    return n;
}

/* The columns of the longest names that have what is said of them beside them. */
static int widest(const opt_tool *tool)
{
    const opt *o;
    char names[NAME];
    int most = 0;
    for (int i = 0; (o = opt_at(tool, i)); i++) {
        const int n = is_shown(o) ? names_of(tool, i, names) : 0;
        most = n > most && n <= NAME_MOST ? n : most;
    }
    return most;
}

/* How much of a text stays on one line: a word, or what is in brackets where a line can hold that. */
static int piece(const char *text, int room)
{
    const int all = *text == '[' ? (int)strcspn(text, "]") + 1 : 0;
    return all && all <= room ? all : (int)strcspn(text, " ");
}

/* Writes text in lines between `column` and the last; `at` is where the first begins. */
static void put_wrapped(const char *text, int at, int column, out *to)
{
    bool first = true;
    while (*text) {
        const int n = piece(text, COLUMNS - column);
        if (!first && at + 1 + n > COLUMNS) {
            out_format(to, "\n%*s", column, "");
            at = column;
            first = true;
        }
        out_format(to, "%s%.*s", first ? "" : " ", n, text);
        at += n + !first;
        first = false;
        text += n;
        text += strspn(text, " ");
    }
    out_text(to, "\n");
}

static void put_option(const opt_tool *tool, int i, int width, out *to)
{
    char names[NAME];
    const int column = 2 + width + 2;
    if (names_of(tool, i, names) > width)
        out_format(to, "  %s\n%*s", names, column, "");
    else
        out_format(to, "  %-*s  ", width, names);
    put_wrapped(opt_at(tool, i)->help, column, column, to);
}

static void put_group(const opt_tool *tool, opt_group group, int width, out *to)
{
    const opt *o;
    bool any = false;
    for (int i = 0; (o = opt_at(tool, i)); i++) {
        if (o->group != group || !is_shown(o))
            continue;
        if (!any)
            out_format(to, "\n%s:\n", headings[group]);
        any = true;
        put_option(tool, i, width, to);
    }
}

void opt_help(const opt_tool *tool, out *to)
{
    const int width = widest(tool);
    opt_usage(tool, to);
    out_format(to, "\n%s\n", tool->purpose);
    for (int group = OPT_INPUT; group < OPT_GROUPS; group++)
        put_group(tool, (opt_group)group, width, to);
    if (tool->note)
        out_format(to, "\n%s\n", tool->note);
    out_format(to, "\nExample:\n  %s\n\nManual: man %s, man 7 sinew\n", tool->example, tool->name);
}
