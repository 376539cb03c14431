/* sinew-materials: the laws of tissue, their keys, and the materials that files have. */
#include "cli/tool.h"
#include "inspect/preset_file.h"
#include "model/material_edit.h"

#include <stdio.h>
#include <string.h>

enum { TSV_NONE = -1, TSV_LAWS, TSV_KEYS, TSV_PRESETS };

struct options {
    opt_common common;
    int tsv;
};

#define TO(field) offsetof(struct options, field)
static const opt option_table[] = {{OPT_RESULT, 0, "tsv", "laws|keys|presets", OPT_CHOICE, TO(tsv), 0, 0,
                                    "laws|keys|presets", OPT_OUTPUT,
                                    "print one of the tables alone, as TSV, with all digits"},
                                   {0}};

static const opt_tool table = {
    .name = "sinew-materials",
    .command = "sinew materials",
    .usage = "[options] [FILE...]",
    .purpose = "Lists the laws of tissue, their keys with units and ranges, and the materials of\nthe files that were "
               "installed; or the materials of each FILE.",
    .note = "A file of materials goes to --materials of voxelise, msds-mesh, sinew import and\ntled-run.",
    .example = "sinew materials --tsv presets | grep liver",
    .operands = "FILE...",
    .operands_max = 64,
    .options = option_table,
};

static void put_number(double value, out *to)
{
    char text[NUM_TEXT];
    num_text(value, false, text);
    out_format(to, "%s\t", text);
}

/* ---- laws */

static const char *solver_of(const law_row *of)
{
    return of->form < FORM_STEPPED ? "tled-run" : "msds-run";
}

static int put_laws(out *to, err *e)
{
    static const char *const heads[] = {"<law", "<keys", "<computed by", NULL};
    char words[LAW_WORDS];
    const law_row *law;
    text_table *t = text_table_create(heads, e);
    for (int i = 0; t && (law = law_at(i)); i++) {
        law_words(law, -1, words);
        text_table_cell(t, "%s", law->name);
        text_table_cell(t, "%s", words);
        text_table_cell(t, "%s", solver_of(law));
    }
    out_text(to, "laws (man sinew-laws)\n");
    return text_table_put(t, to, e);
}

static void put_laws_tsv(out *to)
{
    char words[LAW_WORDS];
    const law_row *law;
    out_text(to, "law\tkeys\tcomputed by\tmeaning\tsource\n");
    for (int i = 0; (law = law_at(i)); i++) {
        law_words(law, -1, words);
        out_format(to, "%s\t%s\t%s\t%s\t%s\n", law->name, words, solver_of(law), law->meaning, law->source);
    }
}

/* ---- keys */

static const known *known_key(int key)
{
    return known_find(material_edit_arrays[key]);
}

/* "yeoh, arruda-boyce": the laws that have the key. */
static const char *laws_with(int key, char to[LAW_WORDS])
{
    const law_row *law;
    if (key >= LAW_OWN_KEYS)
        return "all";
    to[0] = '\0';
    for (int i = 0; (law = law_at(i)); i++) {
        const size_t at = strlen(to);
        if (law_keys(law) >> key & 1)
            snprintf(to + at, LAW_WORDS - at, "%s%s", at ? ", " : "", law->name);
    }
    return to;
}

static int put_keys(out *to, err *e)
{
    static const char *const heads[] = {"<key", "<range", "<what it is", NULL};
    char words[KNOWN_WORDS];
    text_table *t = text_table_create(heads, e);
    for (int k = 0; t && k < LAW_ALL_KEYS; k++) {
        known_words(known_key(k), words);
        text_table_cell(t, "%s", law_key_name((law_key)k));
        text_table_cell(t, "%s", words);
        text_table_cell(t, "%s", known_key(k)->meaning);
    }
    out_text(to, "keys\n");
    return text_table_put(t, to, e);
}

static void put_keys_tsv(out *to)
{
    char words[LAW_WORDS];
    out_text(to, "key\tunit\tlowest\thighest\tlaws\tmeaning\n");
    for (int k = 0; k < LAW_ALL_KEYS; k++) {
        const known *of = known_key(k);
        out_format(to, "%s\t%s\t", law_key_name((law_key)k), law_key_unit((law_key)k));
        put_number(of->low, to);
        put_number(of->high, to);
        out_format(to, "%s\t%s\n", laws_with(k, words), of->meaning);
    }
}

/* ---- presets */

static int put_preset(const preset_file *of, out *to, err *e)
{
    static const char *const heads[] = {"<material", "<law", ">E\nPa", ">nu\n1", "<what it is", NULL};
    const model_array *name = model_find(&of->materials, "material.name");
    text_table *t = text_table_create(heads, e);
    for (int64_t i = 0; t && i < name->rows; i++) {
        material one;
        if (materials_of(&of->materials, i, &one, e)) {
            text_table_free(t);
            return -1;
        }
        text_table_cell(t, "%s", name->str[i]);
        text_table_cell(t, "%s", one.law->name);
        text_table_number(t, material_young(&one), text_table_decimals(material_young(&one), 4));
        text_table_cell(t, "%.4g", material_poisson(&one));
        text_table_cell(t, "%s", *of->what[i] ? of->what[i] : "-");
    }
    out_format(to, "%s\n", of->path);
    if (*of->title)
        out_format(to, "  %s\n", of->title);
    return text_table_put(t, to, e);
}

/* A tab would begin another column. */
static void put_path(const char *path, out *to)
{
    for (const char *p = path; *p; p++)
        out_format(to, "%c", *p == '\t' ? ' ' : *p);
}

static int put_preset_tsv(const preset_file *of, out *to, err *e)
{
    const model_array *name = model_find(&of->materials, "material.name");
    char keys[MATERIAL_EDIT_WORDS];
    for (int64_t i = 0; i < name->rows; i++) {
        material one;
        if (materials_of(&of->materials, i, &one, e))
            return -1;
        material_edit_words(&of->materials, i, keys);
        put_path(of->path, to);
        out_format(to, "\t%s\t%s\t%s\t", name->str[i], one.law->name, keys);
        put_number(material_young(&one), to);
        put_number(material_poisson(&one), to);
        out_format(to, "%s\n", of->what[i]);
    }
    return 0;
}

static int put_presets(char *const *path, int count, bool tsv, out *to, err *e)
{
    int status = 0;
    if (tsv)
        out_text(to, "file\tmaterial\tlaw\tkeys\tE/Pa\tnu\tmeaning\n");
    for (int i = 0; !status && i < count; i++) {
        preset_file one;
        if (preset_file_read(&one, path[i], e))
            return -1;
        status = (tsv ? put_preset_tsv : put_preset)(&one, to, e);
        preset_file_free(&one);
    }
    return status;
}

static int put_installed(bool tsv, out *to, err *e)
{
    preset_paths found;
    if (preset_paths_installed(&found, e))
        return -1;
    const int status = put_presets(found.path, found.count, tsv, to, e);
    preset_paths_free(&found);
    return status;
}

/* ---- the tool */

static int put_all(const tool *t, int tsv, out *to, err *e)
{
    if (tsv == TSV_LAWS)
        put_laws_tsv(to);
    else if (tsv == TSV_KEYS)
        put_keys_tsv(to);
    if (tsv == TSV_LAWS || tsv == TSV_KEYS)
        return 0;
    if (t->operands)
        return put_presets(t->operand, t->operands, tsv == TSV_PRESETS, to, e);
    if (tsv == TSV_NONE && (put_laws(to, e) || put_keys(to, e)))
        return -1;
    return put_installed(tsv == TSV_PRESETS, to, e);
}

static int run(const tool *t, const struct options *o, err *e)
{
    if (t->operands && (o->tsv == TSV_LAWS || o->tsv == TSV_KEYS))
        return err_usage(e, "--tsv %s does not read '%.200s'; expected no FILE", o->tsv == TSV_LAWS ? "laws" : "keys",
                         t->operand[0]);
    for (int i = 0; i < t->operands; i++)
        if (!strcmp(t->operand[i], "-") && tool_need_stdin("a file of materials", e))
            return -1;
    out *to = out_open(o->common.output, false, e);
    return to ? out_end(to, put_all(t, o->tsv, to, e), e) : -1;
}

static int run_tool(int argc, char **argv)
{
    struct options o = {.tsv = TSV_NONE};
    err e = {0};
    tool t = {0};
    if (!tool_begin(&t, &table, argc, argv, &o, &e) && !t.done)
        run(&t, &o, &e);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
