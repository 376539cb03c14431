/* Any text as a line of --batch: it is refused with a text, or it has words, none of which is longer than the line; and
 * any lines that name files, of which those that one line writes are no other line's.
 */
#include "cli/batch_files.h"
#include "cli/batch_words.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MOST = 100 }; /* files */

static void must(bool good)
{
    if (!good)
        abort();
}

static void cut(char *text)
{
    char *word[BATCH_WORDS];
    err e = {0};
    size_t length = 0;
    const size_t most = strlen(text);
    if (batch_words_check(text, &e)) {
        must(e.status && *e.text);
        return;
    }
    const int count = batch_words_cut(text, word, &e);
    must(count <= BATCH_WORDS && (count < 0) == (*e.text != '\0'));
    for (int i = 0; i < count; i++) {
        must(word[i] >= text && word[i] <= text + most);
        length += strlen(word[i]) + (i > 0);
    }
    must(length <= most);
}

/* Each line is a file: written, where it begins with w, and of the line after the last where it begins so or with r. */
static void share(char *text)
{
    batch_files f = {0};
    err e = {0};
    int64_t line = 1, writes[MOST + 2] = {0};
    char *at = text, *path;
    for (int i = 0; i < MOST && (path = strsep(&at, "\n")); i++) {
        const bool is_written = *path == 'w' || *path == 'v';
        line += *path == 'w' || *path == 'r';
        must(!batch_files_note(&f, *path ? path + 1 : "a", line, is_written, &e));
        writes[line] += is_written;
    }
    must(!batch_files_sort(&f, &e));
    for (int64_t i = 1; i <= line; i++) {
        err why = {0};
        const int taken = batch_files_take(&f, i, &why);
        must((taken == 0) == (*why.text == '\0'));
        must(i > 1 || taken == 0);
    }
    for (int64_t i = 0; i < f.files; i++) {
        const batch_users *by = &f.users[f.file[i].users];
        must(!by->writes || !by->reads || by->writes == by->reads);
        must(!by->writes || writes[by->writes]);
    }
    batch_files_free(&f);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    if (!text)
        return 0;
    if (size)
        memcpy(text, data, size);
    text[size] = '\0';
    if (size && *text == '@')
        share(text + 1);
    else
        cut(text);
    free(text);
    return 0;
}
