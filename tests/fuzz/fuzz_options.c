/* Any lines as the words of a command line, for a table with every kind of option: what was taken is in its range and
 * makes provenance that the format takes; or one usage error.
 */
#include "cli/opt.h"
#include "model/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MOST = 100 }; /* words */

struct options {
    opt_common common;
    bool flag;
    const char *text, *file;
    int64_t whole;
    double number;
    opt_lengths lengths;
    opt_numbers numbers;
    int choice;
    opt_list list;
};

#define TO(field) offsetof(struct options, field)
static const opt option_table[] = {
    {OPT_INPUT, 'f', "flag", NULL, OPT_FLAG, TO(flag), 0, 0, NULL, 0, "a flag"},
    {OPT_INPUT, 't', "text", "TEXT", OPT_TEXT, TO(text), 0, 0, NULL, 0, "text"},
    {OPT_INPUT, 0, "text-file", "FILE", OPT_TEXT, TO(file), 0, 0, NULL, OPT_FILE, "a file"},
    {OPT_INPUT, 'n', NULL, "N", OPT_INT, TO(whole), 1, 1000, NULL, 0, "whole"},
    {OPT_INPUT, 'x', "number", "X", OPT_NUMBER, TO(number), -1, 1e6, NULL, 0, "a number"},
    {OPT_INPUT, 's', "lengths", "L,L,L", OPT_LENGTHS, TO(lengths), 0, 3, NULL, 0, "lengths"},
    {OPT_INPUT, 'g', "numbers", "X,Y,Z", OPT_NUMBERS, TO(numbers), 3, 3, NULL, 0, "numbers"},
    {OPT_INPUT, 'm', "method", "one|two", OPT_CHOICE, TO(choice), 0, 0, "one|two", 0, "a choice"},
    {OPT_INPUT, 'c', "list", "A=B,...", OPT_LIST, TO(list), 0, 0, NULL, 0, "a list"},
    {0}};
static const opt_tool table = {.name = "fuzz",
                               .usage = "[options] A B",
                               .purpose = "Takes anything.",
                               .example = "fuzz",
                               .operands = "A B",
                               .operands_max = 2,
                               .writes_model = true,
                               .threaded = true,
                               .reads_volumes = true,
                               .options = option_table};

static void must(bool good)
{
    if (!good)
        abort();
}

static void check(const struct options *o, int operands, char **argv)
{
    err e = {0};
    model m = {0};
    must(operands >= 0 && operands <= 2);
    must(o->whole == -1 || (o->whole >= 1 && o->whole <= 1000));
    must(isnan(o->number) || (o->number >= -1 && o->number <= 1e6));
    must(o->lengths.count >= 0 && o->lengths.count <= 3 && (o->numbers.count == 0 || o->numbers.count == 3));
    must(o->choice >= 0 && o->choice <= 1 && o->list.count <= 64 && o->common.threads >= 0);
    for (int i = 0; i < o->list.count; i++)
        must(o->list.value[i] != NULL);
    char *said = opt_provenance(&table, o, operands, argv + 1, &e);
    must(said && !model_prov_add(&m, "fuzz", "1", said, &e));
    free(said);
    model_free(&m);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct options o = {.whole = -1, .number = (double)NAN};
    char name[] = "fuzz", *argv[MOST + 2] = {name}, *text = malloc(size + 1), *at = text, *line;
    err e = {0};
    int argc = 1;
    if (!text)
        return 0;
    if (size)
        memcpy(text, data, size);
    text[size] = '\0';
    while (argc <= MOST && (line = strsep(&at, "\n")))
        argv[argc++] = line;
    argv[argc] = NULL;
    int operands = opt_parse(&table, argc, argv, &o, &e);
    must((operands < 0) == (e.status == STATUS_USAGE) && (operands < 0) == (*e.text != '\0'));
    if (operands >= 0 && !o.common.help && !o.common.version && !o.common.table)
        check(&o, operands, argv);
    free(text);
    return 0;
}
