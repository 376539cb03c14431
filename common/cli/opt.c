#include "cli/opt.h"

#include "base/near.h"
#include "cli/spelling.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MODELS = 1 << 12, THREADED = 1 << 13, VOLUMES = 1 << 14 };

#define OUTPUT (OPT_OUTPUT | OPT_FILE | OPT_WRITES | OPT_JOB)

/* The options that every tool has. MODELS: only those that write a model; THREADED: only those with threads; VOLUMES:
 * those that read volume images. */
#define COMMON(field) offsetof(opt_common, field)
static const opt common_options[] = {
    {OPT_COMMON, 'o', "output", "FILE", OPT_TEXT, COMMON(output), 0, 0, NULL, OUTPUT,
     "write FILE, whole or not at all [default stdout]"},
    {OPT_COMMON, 0, "text", NULL, OPT_FLAG, COMMON(text), 0, 0, NULL, OPT_OUTPUT | MODELS,
     "write the model as text [default binary]"},
    {OPT_COMMON, 'z', "gzip", NULL, OPT_FLAG, COMMON(gzip), 0, 0, NULL, OPT_OUTPUT | MODELS,
     "compress the output with gzip"},
    {OPT_COMMON, 0, "anonymous-names", NULL, OPT_FLAG, COMMON(anonymous), 0, 0, NULL, OPT_OUTPUT | MODELS,
     "write no names of files into the model"},
    {OPT_COMMON, 0, "threads", "N", OPT_INT, COMMON(threads), 1, 1024, NULL, OPT_OUTPUT | THREADED,
     "threads [default SINEW_THREADS, or all processors]"},
    {OPT_COMMON, 0, "memory", "SIZE", OPT_SIZE, COMMON(memory), 0, 0, NULL, OPT_OUTPUT | VOLUMES,
     "most memory for volumes, e.g. 2GB [default any]"},
    {OPT_COMMON, 'q', "quiet", NULL, OPT_FLAG, COMMON(quiet), 0, 0, NULL, OPT_OUTPUT, "print only warnings and errors"},
    {OPT_COMMON, 'v', "verbose", NULL, OPT_FLAG, COMMON(verbose), 0, 0, NULL, OPT_OUTPUT, "print more"},
    {OPT_COMMON, 'h', "help", NULL, OPT_FLAG, COMMON(help), 0, 0, NULL, OPT_OUTPUT | OPT_ALONE, "print this help"},
    {OPT_COMMON, 'V', "version", NULL, OPT_FLAG, COMMON(version), 0, 0, NULL, OPT_OUTPUT | OPT_ALONE,
     "print the version"},
    {OPT_COMMON, 0, "table", "mdoc|bash|zsh", OPT_TEXT, COMMON(table), 0, 0, NULL, OPT_OUTPUT | OPT_HIDDEN | OPT_ALONE,
     "for make"},
    {0}};

static bool is_end(const opt *o)
{
    return o->group == OPT_END;
}

int opt_own(const opt_tool *tool)
{
    int n = 0;
    while (!is_end(&tool->options[n]))
        n++;
    return n;
}

const opt *opt_at(const opt_tool *tool, int i)
{
    const opt *o = tool->options;
    for (; !is_end(o); o++)
        if (!i--)
            return o;
    for (o = common_options; !is_end(o); o++) {
        if ((o->flags & MODELS && !tool->writes_model) || (o->flags & THREADED && !tool->threaded) ||
            (o->flags & VOLUMES && !tool->reads_volumes))
            continue;
        if (!i--)
            return o;
    }
    return NULL;
}

static const opt *find_letter(const opt_tool *tool, char letter)
{
    const opt *o;
    for (int i = 0; (o = opt_at(tool, i)); i++)
        if (o->letter == letter)
            return o;
    return NULL;
}

static int unknown_option(const opt_tool *tool, const char *name, size_t length, err *e)
{
    const char *names[64];
    char word[64];
    const opt *o;
    int n = 0;
    for (int i = 0; (o = opt_at(tool, i)) && n < 64; i++)
        if (o->name && !(o->flags & OPT_HIDDEN))
            names[n++] = o->name;
    snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word - 1), name);
    int near = near_name(word, names, n);
    if (near >= 0)
        return err_usage(e, "no option --%s; did you mean --%s?", word, names[near]);
    return err_usage(e, "no option --%s", word);
}

/* An exact name, or the only one that begins so. count: how many begin so. */
static const opt *look_up(const opt_tool *tool, const char *name, size_t length, int *count)
{
    const opt *o, *found = NULL;
    *count = 0;
    for (int i = 0; (o = opt_at(tool, i)); i++) {
        if (!o->name || strncmp(o->name, name, length) != 0 || (o->flags & OPT_HIDDEN && o->name[length]))
            continue;
        if (!o->name[length])
            return o;
        found = o;
        ++*count;
    }
    return *count == 1 ? found : NULL;
}

static const opt *find_name(const opt_tool *tool, const char *name, size_t length, err *e)
{
    char british[64];
    int count;
    const opt *found = look_up(tool, name, length, &count);
    if (!count && !found && spelling_british(name, length, british, sizeof british))
        found = look_up(tool, british, strlen(british), &count);
    if (found)
        return found;
    if (count > 1)
        err_usage(e, "--%.*s could be several options; write more of it", (int)length, name);
    else
        unknown_option(tool, name, length, e);
    return NULL;
}

const char *opt_dashed(const opt *o, char to[64])
{
    if (o->name && strcmp(o->name, "output") != 0)
        snprintf(to, 64, "--%s", o->name);
    else
        snprintf(to, 64, "-%c", o->letter);
    return to;
}

static int bad_value(const opt *o, const char *text, const char *expected, err *e)
{
    char name[64];
    if (o->name)
        snprintf(name, sizeof name, "--%s", o->name);
    else
        snprintf(name, sizeof name, "-%c", o->letter);
    return err_usage(e, "%s '%s': expected %s", name, text, expected);
}

/* As people write it: 1e9, not 1e+09. */
static const char *bound_text(double bound, char to[32])
{
    snprintf(to, 32, "%g", bound);
    char *e = strchr(to, 'e'), *digits = e ? e + 1 : NULL;
    if (!e)
        return to;
    char *power = digits + strspn(digits, "+-0");
    digits += *digits == '-';
    memmove(digits, power, strlen(power) + 1);
    return to;
}

/* "a number from 0 to 1": what the table allows. */
static const char *range_text(const opt *o, const char *what, char *to, size_t size)
{
    char low[32], high[32];
    if (o->low == 0 && o->high == 0)
        snprintf(to, size, "%s", what);
    else if (isinf(o->high))
        snprintf(to, size, "%s, at least %s", what, bound_text(o->low, low));
    else
        snprintf(to, size, "%s from %s to %s", what, bound_text(o->low, low), bound_text(o->high, high));
    return to;
}

static bool in_range(const opt *o, double value)
{
    return (o->low == 0 && o->high == 0) || (value >= o->low && value <= o->high);
}

static int set_int(const opt *o, const char *text, int64_t *to, err *e)
{
    char want[128];
    if (num_int(text, INT64_MIN, INT64_MAX, to) || !in_range(o, (double)*to))
        return bad_value(o, text, range_text(o, "a whole number", want, sizeof want), e);
    return 0;
}

static int set_number(const opt *o, const char *text, double *to, err *e)
{
    char want[128];
    if (num_double(text, to) || !in_range(o, *to))
        return bad_value(o, text, range_text(o, "a number", want, sizeof want), e);
    return 0;
}

static int set_lengths(const opt *o, const char *text, opt_lengths *to, err *e)
{
    int most = o->high > 0 ? (int)o->high : 6;
    to->count = num_lengths_of(text, to->value, most);
    if (to->count >= 1 && to->count >= (int)o->low)
        return 0;
    char want[128];
    snprintf(want, sizeof want, "%s (%s), each a number with or without " NUM_UNITS, o->arg,
             most > 1 ? "between commas" : "a length");
    return bad_value(o, text, want, e);
}

static int set_numbers(const opt *o, const char *text, opt_numbers *to, err *e)
{
    to->count = num_list(text, to->value, o->high > 0 ? (int)o->high : 6);
    if (to->count >= 1 && to->count >= (int)o->low)
        return 0;
    char want[128];
    snprintf(want, sizeof want, "%s, numbers between commas", o->arg);
    return bad_value(o, text, want, e);
}

int opt_choice(const char *choices, const char *word)
{
    const size_t length = strlen(word);
    for (int i = 0;; i++) {
        const size_t n = strcspn(choices, "|");
        if (length == n && !strncmp(choices, word, n))
            return i;
        if (!choices[n])
            return -1;
        choices += n + 1;
    }
}

static int set_choice(const opt *o, const char *text, int *to, err *e)
{
    char british[64];
    int found = opt_choice(o->choices, text);
    if (found < 0 && spelling_british(text, strlen(text), british, sizeof british))
        found = opt_choice(o->choices, british);
    if (found < 0)
        return bad_value(o, text, o->choices, e);
    *to = found;
    return 0;
}

static int add_to_list(const opt *o, const char *text, opt_list *to, err *e)
{
    if (to->count == (int)(sizeof to->value / sizeof *to->value))
        return bad_value(o, text, "at most 64 of these", e);
    to->value[to->count++] = text;
    return 0;
}

static int set_value(const opt *o, const char *text, void *options, err *e)
{
    void *to = (char *)options + o->to;
    switch (o->kind) {
    case OPT_FLAG:
        *(bool *)to = true;
        return 0;
    case OPT_TEXT:
        *(const char **)to = text;
        return *text ? 0 : bad_value(o, text, o->arg, e);
    case OPT_INT:
        return set_int(o, text, to, e);
    case OPT_SIZE:
        return num_size_of(text, to) ? bad_value(o, text, "a size such as 500MB or 2GiB", e) : 0;
    case OPT_NUMBER:
        return set_number(o, text, to, e);
    case OPT_LENGTHS:
        return set_lengths(o, text, to, e);
    case OPT_NUMBERS:
        return set_numbers(o, text, to, e);
    case OPT_CHOICE:
        return set_choice(o, text, to, e);
    case OPT_LIST:
        return add_to_list(o, text, to, e);
    }
    return -1;
}

/* A command line being read. */
typedef struct scan {
    const opt_tool *tool;
    int argc, at;
    char **argv;
    void *options;
    uint64_t seen;        /* bit i: option i was given */
    bool is_job;          /* of --batch */
    const void *defaults; /* of its options */
    bool has_either;      /* it has one of OPT_EITHER */
} scan;

static void mark_seen(scan *s, const opt *o)
{
    const opt *other;
    for (int i = 0; i < 64 && (other = opt_at(s->tool, i)); i++)
        if (other == o)
            s->seen |= UINT64_C(1) << i;
}

static int refuse_in_job(const opt *o, err *e)
{
    char name[64];
    return err_usage(e,
                     o->flags & OPT_ALONE ? "a job with %s; expected a run without --batch for that"
                                          : "a job with %s; expected it on the command line, for all jobs",
                     opt_dashed(o, name));
}

/* With --batch. */
static int refuse_for_all(const opt *o, err *e)
{
    char name[64];
    return err_usage(e,
                     o->flags & OPT_ALONE ? "%s with --batch; expected one of them"
                                          : "%s with --batch; expected it in the lines of jobs",
                     opt_dashed(o, name));
}

static int check_batch(const scan *s, err *e)
{
    const opt *o;
    int count;
    const opt *batch = look_up(s->tool, "batch", strlen("batch"), &count);
    bool is_batch = false;
    for (int i = 0; i < 64 && (o = opt_at(s->tool, i)); i++)
        is_batch = is_batch || (o == batch && s->seen >> i & 1);
    for (int i = 0; is_batch && i < 64 && (o = opt_at(s->tool, i)); i++)
        if (s->seen >> i & 1 && (o->flags & OPT_ALONE || (o->flags & OPT_JOB && o->flags & OPT_WRITES)))
            return refuse_for_all(o, e);
    if (is_batch && !strcmp(*(const char *const *)((const char *)s->options + batch->to), "-"))
        return err_usage(e, "--batch -: standard input has the model; expected the name of a file");
    return 0;
}

static size_t size_of(const opt *o)
{
    static const size_t sizes[] = {
        [OPT_FLAG] = sizeof(bool),           [OPT_TEXT] = sizeof(const char *), [OPT_INT] = sizeof(int64_t),
        [OPT_SIZE] = sizeof(int64_t),        [OPT_NUMBER] = sizeof(double),     [OPT_LENGTHS] = sizeof(opt_lengths),
        [OPT_NUMBERS] = sizeof(opt_numbers), [OPT_CHOICE] = sizeof(int),        [OPT_LIST] = sizeof(opt_list)};
    return sizes[o->kind];
}

/* Takes back those of OPT_EITHER that the command line has. */
static void forget_either(scan *s)
{
    const opt *o;
    for (int i = 0; !s->has_either && (o = opt_at(s->tool, i)); i++)
        if (o->flags & OPT_EITHER)
            memcpy((char *)s->options + o->to, (const char *)s->defaults + o->to, size_of(o));
    s->has_either = true;
}

/* value: what is joined to the option, or NULL to take the next word. */
static int take(scan *s, const opt *o, const char *value, err *e)
{
    mark_seen(s, o);
    if (s->is_job && !(o->flags & OPT_JOB))
        return refuse_in_job(o, e);
    if (s->is_job && o->flags & OPT_EITHER)
        forget_either(s);
    if (o->kind != OPT_FLAG && !value) {
        if (s->at + 1 >= s->argc)
            return err_usage(e, "%s needs a value: %s", s->argv[s->at], o->arg);
        value = s->argv[++s->at];
    }
    return set_value(o, value ? value : "", s->options, e);
}

static int take_long(scan *s, const char *word, err *e)
{
    const char *equals = strchr(word, '=');
    size_t length = equals ? (size_t)(equals - word) : strlen(word);
    const opt *o = find_name(s->tool, word, length, e);
    if (!o)
        return -1;
    if (equals && o->kind == OPT_FLAG)
        return err_usage(e, "--%s takes no value", o->name);
    return take(s, o, equals ? equals + 1 : NULL, e);
}

int opt_set(const opt_tool *tool, const char *name, const char *text, void *options, err *e)
{
    const opt *o = find_name(tool, name, strlen(name), e);
    return o ? set_value(o, text, options, e) : -1;
}

/* "-qv", "-s2.5", "-s 2.5" */
static int take_letters(scan *s, const char *letters, err *e)
{
    for (; *letters; letters++) {
        const opt *o = find_letter(s->tool, *letters);
        if (!o)
            return err_usage(e, "no option -%c", *letters);
        if (o->kind != OPT_FLAG)
            return take(s, o, letters[1] ? letters + 1 : NULL, e);
        if (take(s, o, NULL, e))
            return -1;
    }
    return 0;
}

static int missing_option(const opt *o, err *e)
{
    if (o->letter)
        return err_usage(e, "missing option -%c, --%s; expected -%c %s", o->letter, o->name, o->letter, o->arg);
    return err_usage(e, "missing option --%s; expected --%s %s", o->name, o->name, o->arg);
}

static int check_required(const scan *s, int operands, err *e)
{
    const opt *o;
    for (int i = 0; i < 64 && (o = opt_at(s->tool, i)); i++)
        if (!s->is_job && o->flags & OPT_REQUIRED && !(s->seen >> i & 1))
            return missing_option(o, e);
    if (operands < s->tool->operands_min)
        return err_usage(e, "missing operand; expected %s", s->tool->operands);
    if (operands > s->tool->operands_max)
        return err_usage(e, "extra operand '%s'; expected %s", s->argv[s->tool->operands_max + 1],
                         *s->tool->operands ? s->tool->operands : "none");
    for (int i = 1; i <= operands; i++)
        if (!*s->argv[i])
            return err_usage(e, "operand '' is empty; expected %s", s->tool->operands);
    return 0;
}

static int parse(scan s, err *e)
{
    const int argc = s.argc;
    char **const argv = s.argv;
    const opt_common *common = s.options;
    bool only_operands = false;
    int operands = 0;
    for (s.at = 1; s.at < argc; s.at++) {
        char *word = argv[s.at];
        int bad = 0;
        if (only_operands || word[0] != '-' || !word[1])
            argv[++operands] = word;
        else if (!strcmp(word, "--"))
            only_operands = true;
        else
            bad = word[1] == '-' ? take_long(&s, word + 2, e) : take_letters(&s, word + 1, e);
        if (bad)
            return -1;
    }
    if (common->help || common->version || common->table)
        return operands;
    return check_required(&s, operands, e) || check_batch(&s, e) ? -1 : operands;
}

int opt_parse(const opt_tool *tool, int argc, char **argv, void *options, err *e)
{
    return parse((scan){.tool = tool, .argc = argc, .argv = argv, .options = options}, e);
}

int opt_parse_job(const opt_tool *tool, int argc, char **argv, void *options, const void *defaults, err *e)
{
    return parse(
        (scan){.tool = tool, .argc = argc, .argv = argv, .options = options, .is_job = true, .defaults = defaults}, e);
}
