#include "base/opt_complete.h"

#include "base/spelling.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* One of the names between '|', which is lower case if it is meant as it stands; p is moved on. NULL at the end. */
static const char *next_word(const char **p, bool choices, char word[64])
{
    while (**p) {
        size_t n = strcspn(*p, "|");
        bool literal = n > 0 && n < 64;
        for (size_t i = 0; i < n && !choices; i++)
            literal = literal && (islower((unsigned char)(*p)[i]) || isdigit((unsigned char)(*p)[i]));
        if (literal)
            snprintf(word, 64, "%.*s", (int)n, *p);
        *p += n + ((*p)[n] == '|');
        if (literal)
            return word;
    }
    return NULL;
}

/* What a value may be, each after `between` but the first. Returns how many. */
static int put_words(const opt *o, const char *between, out *to)
{
    const char *p = o->choices ? o->choices : o->arg;
    char word[64];
    int count = 0;
    while (next_word(&p, o->choices, word)) {
        if (to)
            out_format(to, "%s%s", count ? between : "", word);
        count++;
    }
    return count;
}

/* The endings of the files that a metavariable or operand means, NULL-terminated; none: any file. */
static const char *const *endings_of(const char *arg)
{
    static const char *const any[] = {NULL}, *const obj[] = {"obj", "obj.gz", NULL}, *const pgm[] = {"pgm", NULL};
    static const char *const volume[] = {"nrrd", "nhdr", "mha", "mhd", NULL};
    if (strstr(arg, ".obj") || !strcmp(arg, "OBJ"))
        return obj;
    if (strstr(arg, ".pgm"))
        return pgm;
    if (!strcmp(arg, "VOLUME") || !strcmp(arg, "LABELS") || !strcmp(arg, "volume"))
        return volume;
    return any;
}

static bool is_file(const opt *o)
{
    return o->flags & OPT_FILE;
}

/* What the tool is called by, to the end of the line. */
static void put_tool_names(const opt_tool *tool, out *to)
{
    const char *american = spelling_american(tool->name);
    out_format(to, " %s", tool->name);
    if (american)
        out_format(to, " %s", american);
    out_text(to, "\n");
}

/* ---- bash */

static void put_bash_files(const char *arg, out *to)
{
    const char *const *ending = endings_of(arg);
    if (!*ending) {
        out_text(to, "COMPREPLY=()");
        return;
    }
    out_text(to, "compopt -o filenames; COMPREPLY=($(compgen -d -- \"$word\"");
    for (; *ending; ending++)
        out_format(to, "; compgen -f -X '!*.%s' -- \"$word\"", *ending);
    out_text(to, "))");
}

static void put_bash_value(const opt *o, out *to)
{
    out_text(to, "    ");
    if (o->letter)
        out_format(to, "-%c%s", o->letter, o->name ? "|" : "");
    if (o->name)
        out_format(to, "--%s", o->name);
    out_text(to, ") ");
    if (put_words(o, "", NULL)) {
        out_text(to, "compopt +o default; COMPREPLY=($(compgen -W '");
        put_words(o, " ", to);
        out_text(to, "' -- \"$word\"))");
        if (o->choices && strchr(o->choices, ':'))
            out_text(to, "; compopt -o nospace");
    } else if (is_file(o)) {
        put_bash_files(o->arg, to);
    } else {
        out_text(to, "compopt +o default; COMPREPLY=()");
    }
    out_text(to, "; return ;;\n");
}

/* The name of the tool's function. */
static void put_bash_name(const opt_tool *tool, out *to)
{
    out_text(to, "_sinew_complete_");
    for (const char *p = tool->name; *p; p++)
        out_write(to, *p == '-' ? "_" : p, 1);
}

void opt_complete_bash(const opt_tool *tool, out *to)
{
    const opt *o;
    put_bash_name(tool, to);
    out_text(to, "() {\n"
                 "    local IFS=$' \\n' word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
                 "    [[ $before == = ]] && before=${COMP_WORDS[COMP_CWORD-2]}\n"
                 "    [[ $word == = ]] && word=\n"
                 "    case $before in\n");
    for (int i = 0; (o = opt_at(tool, i)); i++)
        if (o->arg && !(o->flags & OPT_HIDDEN))
            put_bash_value(o, to);
    out_text(to, "    esac\n"
                 "    if [[ $word == -* ]]; then\n"
                 "        COMPREPLY=($(compgen -W '");
    for (int i = 0; (o = opt_at(tool, i)); i++)
        if (o->name && !(o->flags & OPT_HIDDEN))
            out_format(to, "%s--%s", i ? " " : "", o->name);
    out_text(to, "' -- \"$word\"))\n    else\n        IFS=$'\\n'\n        ");
    if (tool->operands_max > 0)
        put_bash_files(tool->operands, to);
    else
        out_text(to, "compopt +o default; COMPREPLY=()");
    out_text(to, "\n    fi\n}\ncomplete -o default -F ");
    put_bash_name(tool, to);
    put_tool_names(tool, to);
}

/* ---- zsh */

/* Text within a specification of _arguments, which stands in single quotes. */
static void put_zsh_text(const char *text, out *to)
{
    for (const char *p = text; *p; p++) {
        if (*p == '\'')
            out_text(to, "'\\''");
        else
            out_format(to, "%s%c", strchr("[]:\\", *p) ? "\\" : "", *p);
    }
}

static void put_zsh_files(const char *arg, out *to)
{
    const char *const *ending = endings_of(arg);
    out_text(to, "_files");
    for (int i = 0; ending[i]; i++)
        out_format(to, "%s%s", i ? "|" : " -g \"*.(", ending[i]);
    out_text(to, *ending ? ")(-.)\"" : "");
}

static void put_zsh_action(const opt *o, out *to)
{
    out_text(to, ":");
    put_zsh_text(o->arg, to);
    out_text(to, ":");
    const bool parts = o->choices && strchr(o->choices, ':');
    if (parts) { /* a colon ends an action */
        out_text(to, "compadd -S \"\" - ");
        for (const char *p = o->choices; *p; p++)
            out_text(to, *p == '|' ? " " : *p == ':' ? "\\:" : (const char[]){*p, 0});
    } else if (put_words(o, "", NULL)) {
        out_text(to, "(");
        put_words(o, " ", to);
        out_text(to, ")");
    } else if (is_file(o)) {
        put_zsh_files(o->arg, to);
    } else {
        out_text(to, " ");
    }
}

static void put_zsh_option(const opt *o, out *to)
{
    const bool again = o->kind == OPT_LIST, both = o->letter && o->name;
    const char *joined = o->arg ? "+" : "", *equals = o->arg ? "=" : "";
    out_text(to, again ? " \\\n    '*" : " \\\n    '");
    if (both && !again)
        out_format(to, "(-%c --%s)", o->letter, o->name);
    if (both)
        out_format(to, "'{-%c%s,--%s%s}'[", o->letter, joined, o->name, equals);
    else if (o->letter)
        out_format(to, "-%c%s[", o->letter, joined);
    else
        out_format(to, "--%s%s[", o->name, equals);
    put_zsh_text(o->help, to);
    out_text(to, "]");
    if (o->arg)
        put_zsh_action(o, to);
    out_text(to, "'");
}

void opt_complete_zsh(const opt_tool *tool, out *to)
{
    const opt *o;
    const bool many = tool->operands_max > 1;
    out_text(to, "#compdef");
    put_tool_names(tool, to);
    out_text(to, "_arguments -s -S");
    for (int i = 0; (o = opt_at(tool, i)); i++)
        if (!(o->flags & OPT_HIDDEN))
            put_zsh_option(o, to);
    if (tool->operands_max > 0) {
        out_format(to, " \\\n    '%s:", many ? "*" : "1");
        put_zsh_text(tool->operands, to);
        out_text(to, ":");
        put_zsh_files(tool->operands, to);
        out_text(to, "'");
    }
    out_text(to, "\n");
}
