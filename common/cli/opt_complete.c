#include "cli/opt_complete.h"

#include "cli/spelling.h"

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

/* ---- names out of a model that stands on the line */

static bool has_names(const opt *o)
{
    return o->choices && strchr(o->choices, '@');
}

static bool any_names(const opt_tool *tool)
{
    const opt *o;
    for (int i = 0; (o = opt_at(tool, i)); i++)
        if (has_names(o))
            return true;
    return false;
}

/* Arguments of the scripts' _sinew_names: the words that are offered besides, what follows a name, the keys. */
static void put_names_call(const opt *o, const char *quote, out *to)
{
    const char *p = o->choices;
    char word[64], follows[2] = "";
    int count = 0;
    out_format(to, "_sinew_names %s", quote);
    while (next_word(&p, true, word))
        if (*word != '@')
            out_format(to, "%s%s", count++ ? " " : "", word);
        else if (!isalnum((unsigned char)word[strlen(word) - 1]))
            follows[0] = word[strlen(word) - 1];
    out_format(to, "%s %s%s%s", quote, quote, follows, quote);
    p = o->choices;
    while (next_word(&p, true, word))
        if (*word == '@')
            out_format(to, " %.*s", (int)(strlen(word) - 1 - (follows[0] != 0)), word + 1);
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

/* The names of the tool, in both spellings, and the end of the line. */
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

/* Offers names from the models among the words of the command, and behind `<`. The names are not trusted: none is
 * evaluated by the shell, and its special characters are quoted. */
static const char bash_names[] =
    "_sinew_names() {\n"
    "    local suffix=$2 element=${value##*,} list file name quoted tool=${sinew:-${COMP_WORDS[0]}} info\n"
    "    local words=$1\n"
    "    list=${word%\"$element\"}\n"
    "    compopt +o default\n"
    "    COMPREPLY=()\n"
    "    [[ $suffix == = && $element == *=* ]] && return\n"
    "    for name in $words; do\n"
    "        [[ $name == \"$element\"* ]] && COMPREPLY+=(\"$list$name\")\n"
    "    done\n"
    "    shift 2\n"
    "    info=$(type -P sinew-info) || info=${tool%/*}/sinew-info\n"
    "    for file in \"${COMP_WORDS[@]:1}\"; do\n"
    "        file=${file//\\\\/} file=${file#[\\\"\\']} file=${file%[\\\"\\']}\n"
    "        [[ $file == '~/'* ]] && file=$HOME/${file:2}\n"
    "        [[ -f $file && -r $file && $file != - ]] || continue\n"
    "        while IFS= read -r name; do\n"
    "            printf -v quoted %q \"$name\"\n"
    "            [[ $name == \"$element\"* || $quoted == \"$element\"* ]] && COMPREPLY+=(\"$list$quoted$suffix\")\n"
    "        done < <(\"$info\" --names \"${@/#/--get=}\" -- \"$file\" 2>/dev/null </dev/null)\n"
    "    done\n"
    "    [[ $suffix ]] && compopt -o nospace\n"
    "}\n";

static void put_bash_value(const opt *o, out *to)
{
    out_text(to, "    ");
    if (o->letter)
        out_format(to, "-%c%s", o->letter, o->name ? "|" : "");
    if (o->name)
        out_format(to, "--%s", o->name);
    out_text(to, ") ");
    if (has_names(o)) {
        put_names_call(o, "'", to);
    } else if (put_words(o, "", NULL)) {
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
    if (any_names(tool))
        out_text(to, bash_names);
    put_bash_name(tool, to);
    /* bash cuts words at `=`: the option is the word before those that belong to the value. */
    out_text(to, "() {\n"
                 "    local IFS=$' \\n' word=${COMP_WORDS[COMP_CWORD]} value at=$((COMP_CWORD - 1))\n"
                 "    while ((at > 0)) && [[ ${COMP_WORDS[at]} == = || (${COMP_WORDS[at]} != -* && ${COMP_WORDS[at+1]} "
                 "== =) ]]; do\n"
                 "        ((at--))\n"
                 "    done\n"
                 "    printf -v value %s \"${COMP_WORDS[@]:at+1:COMP_CWORD-at}\"\n"
                 "    value=${value#=}\n"
                 "    [[ $word == = ]] && word=\n"
                 "    case ${COMP_WORDS[at]} in\n");
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
    if (has_names(o)) {
        out_text(to, " ");
        put_names_call(o, "\"", to);
        return;
    }
    const bool parts = o->choices && strchr(o->choices, ':');
    if (parts) { /* a colon ends an action */
        out_text(to, "compadd -S \"\" - ");
        for (const char *p = o->choices; *p; p++) {
            if (*p == ':')
                out_text(to, "\\");
            out_write(to, *p == '|' ? " " : p, 1);
        }
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

/* The same as in bash. zsh leaves redirections out of the words, but the line has them. */
static const char zsh_names[] =
    "_sinew_names() {\n"
    "    local suffix=$2 file info=${commands[sinew-info]:-${words[1]:h}/sinew-info}\n"
    "    local -a names plain\n"
    "    plain=(${=1})\n"
    "    shift 2\n"
    "    compset -P '*,'\n"
    "    [[ $suffix == = && $PREFIX == *=* ]] && return 1\n"
    "    for file in ${(Q)${(z)BUFFER}}; do\n"
    "        file=${file/#\\~\\//$HOME/}\n"
    "        [[ -f $file && -r $file && $file != - ]] || continue\n"
    "        names+=(${(f)\"$($info --names --get=${^@} -- $file 2>/dev/null </dev/null)\"})\n"
    "    done\n"
    "    (( $#plain )) && compadd -- $plain\n"
    "    (( $#names )) || return $(( ! $#plain ))\n"
    "    if [[ -n $suffix ]]; then compadd -S $suffix -- $names; else compadd -- $names; fi\n"
    "}\n";

static void put_zsh_option(const opt *o, out *to)
{
    const bool again = o->kind == OPT_LIST, both = o->letter && o->name;
    const char *joined = o->arg ? "+" : "";
    const char *equals = o->arg ? "=" : "";
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
    if (any_names(tool))
        out_text(to, zsh_names);
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
