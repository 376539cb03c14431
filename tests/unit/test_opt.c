/* Command lines: every kind of value, what is refused, and what the texts say. */
#include "cli/opt.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

struct options {
    opt_common common;
    bool open;
    const char *name;
    int64_t cells;
    double level, weight;
    opt_lengths size;
    opt_numbers gravity;
    int device;
    opt_list set;
    const char *file;
};

#define TO(field) offsetof(struct options, field)
static const opt options[] = {
    {OPT_ACTION, 's', "size", "H|HX,HY,HZ", OPT_LENGTHS, TO(size), 1, 3, NULL, OPT_REQUIRED, "voxel sides"},
    {OPT_ACTION, 'n', "cells", "N", OPT_INT, TO(cells), 1, 100, NULL, 0, "cells"},
    {OPT_INPUT, 0, "level", "L", OPT_NUMBER, TO(level), 0, 1, NULL, 0,
     "a level, which is said in so many words that they do not go into one line of it [mm; default as much as it "
     "takes]"},
    {OPT_INPUT, 0, "weight", "W", OPT_NUMBER, TO(weight), 1e-12, 1e15, NULL, 0, "weight"},
    {OPT_ACTION, 'g', NULL, "X,Y,Z", OPT_NUMBERS, TO(gravity), 3, 3, NULL, 0, "gravity (m/s2)"},
    {OPT_NUMERICS, 'd', NULL, "DEVICE", OPT_CHOICE, TO(device), 0, 0, "auto|cuda|cpu", OPT_OUTPUT, "device"},
    {OPT_INPUT, 0, "open", NULL, OPT_FLAG, TO(open), 0, 0, NULL, 0, "open"},
    {OPT_INPUT, 0, "name", "NAME", OPT_TEXT, TO(name), 0, 0, NULL, 0, "name"},
    {OPT_INPUT, 'm', NULL, "KEY=VALUE", OPT_LIST, TO(set), 0, 0, NULL, 0, "set"},
    {OPT_INPUT, 0, "file", "FILE", OPT_TEXT, TO(file), 0, 0, NULL, OPT_FILE, "file"},
    {OPT_INPUT, 0, "recorded-to", "FILE", OPT_TEXT, TO(file), 0, 0, NULL, OPT_FILE | OPT_ALSO, "file"},
    {0}};
static const opt_tool table = {.name = "tool",
                               .command = "sinew tool",
                               .usage = "-s H [options] surface.obj > model\n-s H [options] - < surface.obj > model",
                               .purpose = "Does a thing.",
                               .note = "All is in m.",
                               .example = "sinew tool -s 1 a.obj",
                               .operands = "surface.obj|-",
                               .operands_min = 1,
                               .operands_max = 2,
                               .writes_model = true,
                               .threaded = true,
                               .reads_volumes = true,
                               .options = options};

enum { WORDS = 16 };

/* Parses the words of line; fills o. Returns opt_parse's answer. */
static int parse(const char *line, struct options *o, char **argv, char *copy, err *e)
{
    int argc = 0;
    *o = (struct options){.cells = -1, .level = NAN, .weight = NAN};
    *e = (err){0};
    strcpy(copy, line);
    for (char *word = strtok(copy, " "); word && argc < WORDS; word = strtok(NULL, " "))
        argv[argc++] = word;
    return opt_parse(&table, argc, argv, o, e);
}

static void values(void)
{
    struct options o;
    err e;
    char *argv[WORDS], copy[256];
    int n = parse("tool a.obj -s2.5mm,1,4cm --cells=7 -g 0,0,-9.81 -d cpu --open -m a=1 -m b=2 -qz -- -b.obj", &o, argv,
                  copy, &e);
    ok(n == 2 && !strcmp(argv[1], "a.obj") && !strcmp(argv[2], "-b.obj"), "operands come first, -- ends options");
    ok(o.size.count == 3 && o.size.value[0].unit == 1000 && o.size.value[1].unit == 0, "lengths, joined to the letter");
    ok(o.cells == 7 && o.gravity.value[2] == -9.81 && o.device == 2 && o.open, "integer, numbers, choice, flag");
    ok(o.set.count == 2 && !strcmp(o.set.value[1], "b=2"), "a list");
    ok(o.common.quiet && o.common.gzip && !o.common.text, "common letters bundle");
    char *text = opt_provenance(&table, &o, n, argv + 1, &e);
    ok(text && !strcmp(text, "-s 2.5mm,1,4cm -n 7 -g 0,0,-9.81 --open -m a=1 -m b=2 a.obj -b.obj"),
       "provenance: in the table's order, without what does not change the result: %s", text);
    free(text);
    n = parse("tool -s 1 /some/where/face.obj", &o, argv, copy, &e);
    text = opt_provenance(&table, &o, n, argv + 1, &e);
    ok(text && !strcmp(text, "-s 1 face.obj"), "provenance: base names, nothing that was not given: %s", text);
    free(text);
    o.set = (opt_list){.count = 2, .value = {"skin/a", "an 'apple'"}};
    o.file = "some where/the file.txt";
    o.size.value[0].value = 0.2;
    text = opt_provenance(&table, &o, n, argv + 1, &e);
    ok(text && !strcmp(text, "-s 0.2 -m skin/a -m 'an '\\''apple'\\''' --file 'the file.txt' face.obj"),
       "provenance: names stay whole, blanks are quoted, numbers are short: %s", text);
    free(text);
    ok(parse("tool -h", &o, argv, copy, &e) == 0 && o.common.help, "-h wants nothing else");
}

static void refused(void)
{
    static const struct {
        const char *line, *text;
    } bad[] = {
        {"tool a.obj", "missing option -s, --size; expected -s H|HX,HY,HZ"},
        {"tool -s 1", "missing operand; expected surface.obj|-"},
        {"tool -s 1 a b c", "extra operand 'c'"},
        {"tool -s 1 a --sise 2", "no option --sise; did you mean --size?"},
        {"tool -s 1 a -x", "no option -x"},
        {"tool -s 1,2,3,4 a", "expected H|HX,HY,HZ"},
        {"tool -s 1kg a", "expected H|HX,HY,HZ"},
        {"tool -s 1 a -n 0", "a whole number from 1 to 100"},
        {"tool -s 1 a -n x", "a whole number from 1 to 100"},
        {"tool -s 1 a --level 1.5", "a number from 0 to 1"},
        {"tool -s 1 a --level nan", "a number from 0 to 1"},
        {"tool -s 1 a --weight x", "a number from 1e-12 to 1e15"},
        {"tool -s 1 a --weight 0", "a number from 1e-12 to 1e15"},
        {"tool -s 1 a -g 0,0", "X,Y,Z, numbers between commas"},
        {"tool -s 1 a -d gpu", "expected auto|cuda|cpu"},
        {"tool -s 1 a --open=yes", "--open takes no value"},
        {"tool -s 1 a -n", "-n needs a value: N"},
        {"tool -s 1 a --ve", "could be several"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct options o;
        err e;
        char *argv[WORDS], copy[256];
        int n = parse(bad[i].line, &o, argv, copy, &e);
        ok(n == -1 && e.status == STATUS_USAGE && strstr(e.text, bad[i].text), "%s: %s", bad[i].line, e.text);
    }
    struct options o = {.cells = -1};
    err e = {0};
    char tool[] = "tool", option[] = "-s1", none[] = "", *argv[] = {tool, none, option};
    ok(opt_parse(&table, 3, argv, &o, &e) == -1 && e.status == STATUS_USAGE &&
           strstr(e.text, "operand '' is empty; expected surface.obj|-"),
       "an operand without text: %s", e.text);
}

static const char help[] = "usage: sinew tool -s H [options] surface.obj > model\n"
                           "       sinew tool -s H [options] - < surface.obj > model\n"
                           "\n"
                           "Does a thing.\n"
                           "\n"
                           "Input:\n"
                           "      --level L          a level, which is said in so many words that they do\n"
                           "                         not go into one line of it\n"
                           "                         [mm; default as much as it takes]\n"
                           "      --weight W         weight\n"
                           "      --open             open\n"
                           "      --name NAME        name\n"
                           "  -m KEY=VALUE           set\n"
                           "      --file, --recorded-to FILE\n"
                           "                         file\n"
                           "\n"
                           "What happens:\n"
                           "  -s, --size H|HX,HY,HZ  voxel sides\n"
                           "  -n, --cells N          cells\n"
                           "  -g X,Y,Z               gravity (m/s2)\n"
                           "\n"
                           "Numerics:\n"
                           "  -d DEVICE              device\n"
                           "\n"
                           "Common:\n";

static void texts(void)
{
    err e = {0};
    out *to = out_memory(&e);
    opt_help(&table, to);
    out_write(to, "", 1);
    size_t size;
    const char *text = (const char *)out_bytes(to, &size), *end = "Manual: man tool, man 7 sinew\n";
    ok(!strncmp(text, help, strlen(help)), "the help, group by group: %s", text);
    ok(strstr(text, "\n\nAll is in m.\n\nExample:\n  sinew tool -s 1 a.obj\n\n") &&
           !strcmp(text + strlen(text) - strlen(end), end),
       "and its end");
    ok(!strstr(text, "--table") && strstr(text, "--memory SIZE"), "--table is hidden, what all tools have is not");
    out_discard(to);

    to = out_memory(&e);
    ok(!opt_table(&table, "mdoc", to, &e) && !opt_table(&table, "bash", to, &e) && !opt_table(&table, "zsh", to, &e),
       "tables");
    out_write(to, "", 1);
    text = (const char *)out_bytes(to, &size);
    ok(strstr(text, ".Fl s Ar H | HX,HY,HZ\n.Op Fl n Ar N\n"), "mdoc synopsis");
    ok(strstr(text, "-d) compopt +o default; COMPREPLY=($(compgen -W 'auto cuda cpu' -- \"$word\")); return ;;\n") &&
           strstr(text, "complete -o default -F _sinew_complete_tool tool\n"),
       "bash completion");
    ok(strstr(text, "#compdef tool\n") && strstr(text, "'(-n --cells)'{-n+,--cells=}'[cells]:N: '") &&
           strstr(text, "'*:surface.obj|-:_files -g \"*.(obj|obj.gz)(-.)\"'\n"),
       "zsh completion");
    ok(opt_table(&table, "html", to, &e) == -1 && e.status == STATUS_USAGE, "another kind is refused");
    out_discard(to);
}

/* One option at a time, as lines of a live run set them. */
static void one(void)
{
    struct options o = {.cells = -1};
    err e = {0};
    ok(!opt_set(&table, "cells", "7", &o, &e) && o.cells == 7, "an option is set by its name: %s", e.text);
    ok(opt_set(&table, "cells", "x", &o, &e) && strstr(e.text, "--cells 'x': expected a whole number"), "%s", e.text);
    e = (err){0};
    ok(opt_set(&table, "none", "1", &o, &e) && strstr(e.text, "no option --none"), "%s", e.text);
}

int main(void)
{
    values();
    one();
    refused();
    texts();
    return done_testing();
}
