/* Batches: the words of a line, and which lines may have a file. */
#include "cli/batch_files.h"
#include "cli/batch_words.h"

#include "tap.h"

#include <stdio.h>
#include <string.h>

/* The words of a line, each between < and >, or what is wrong. */
static const char *words(const char *line)
{
    static char text[1024];
    char copy[1024], *word[BATCH_WORDS];
    err e = {0};
    snprintf(copy, sizeof copy, "%s", line);
    const int count = batch_words_cut(copy, word, &e);
    snprintf(text, sizeof text, "%s", e.text);
    for (int i = 0; i < count; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "<%s>", word[i]);
    return text;
}

static void cuts(void)
{
    static const struct {
        const char *line, *words;
    } cases[] = {{"", ""},
                 {" \t", ""},
                 {"# -o x", ""},
                 {"-o x # y", "<-o><x>"},
                 {"-o x#y", "<-o><x#y>"},
                 {"\t-o  x ", "<-o><x>"},
                 {"-o 'a b' \"c 'd'\"", "<-o><a b><c 'd'>"},
                 {"a' 'b\" \"c", "<a b c>"},
                 {"'' \"\"", "<><>"},
                 {"'a\\b' \"a\\\"b\" a\\ b \\#", "<a\\b><a\"b><a b><#>"},
                 {"a\\", "<a\\>"},
                 {"'a", "a quote has no end; expected another on the line"},
                 {"\"a\\\"", "a quote has no end; expected another on the line"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        ok(!strcmp(words(cases[i].line), cases[i].words), "words of [%s]: %s", cases[i].line, words(cases[i].line));
    char many[2 * BATCH_WORDS + 4] = "";
    for (int i = 0; i < BATCH_WORDS; i++)
        strcat(many, "a ");
    ok(strlen(words(many)) == 3 * BATCH_WORDS, "as many words as there may be");
    strcat(many, "a");
    ok(strstr(words(many), "more than 64 words") != NULL, "one more");
}

static void takes(void)
{
    static const struct {
        int64_t line;
        const char *path;
        bool is_written, may;
    } cases[] = {{1, "none/a", true, true},    {2, "none/b", false, true},      {3, "none/b", true, false},
                 {4, "none/b", false, true},   {5, "none/a", false, false},     {6, "none/c", true, true},
                 {7, "/dev/null", true, true}, {8, "/dev/null", true, true},    {9, "none/c", true, false},
                 {10, "none/d", true, true},   {11, "/./tmp/../e", true, true}, {12, "/e", true, false}};
    err e = {0};
    batch_files f = {0};
    int bad = 0;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        bad += batch_files_note(&f, cases[i].path, cases[i].line, cases[i].is_written, &e) != 0;
    ok(!bad && !batch_files_sort(&f, &e), "files of lines");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        err why = {0};
        ok((batch_files_take(&f, cases[i].line, &why) == 0) == cases[i].may, "line %d: %s", (int)cases[i].line,
           why.text);
    }
    batch_files_free(&f);
}

/* A line that may not have one of its files has none of them. */
static void leaves(void)
{
    err e = {0};
    batch_files f = {0};
    int bad = batch_files_note(&f, "none/a", 1, true, &e) || batch_files_note(&f, "none/b", 2, true, &e) ||
              batch_files_note(&f, "none/a", 2, true, &e) || batch_files_note(&f, "none/b", 4, true, &e) ||
              batch_files_sort(&f, &e);
    ok(!bad && !batch_files_take(&f, 1, &e), "the first line");
    ok(batch_files_take(&f, 2, &e) && strstr(e.text, "the job of line 1 writes"), "one that has its file: %s", e.text);
    ok(!batch_files_take(&f, 4, &e), "and one with the other file of that");
    batch_files_free(&f);
}

int main(void)
{
    cuts();
    takes();
    leaves();
    return done_testing();
}
