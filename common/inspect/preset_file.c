#include "inspect/preset_file.h"

#include "base/chars.h"
#include "base/keyfile.h"
#include "base/mem.h"
#include "base/path.h"
#include "cli/installed.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A comment as text that steers no terminal and no table. NULL with e filled. */
static char *text_of(const char *comment, err *e)
{
    char *text = mem_text(comment ? comment : "", e);
    for (char *p = text; p && *p; p++)
        if (*p == '\t')
            *p = ' ';
    if (text) {
        chars_mend(text);
        chars_tame(text);
    }
    return text;
}

/* What a line says: of the file, where it is the first, or of the next material. */
static int take_comment(preset_file *to, const keyfile *k, int words, int64_t *next, err *e)
{
    if (k->line == 1 && !words && k->comment) {
        free(to->title);
        return (to->title = text_of(k->comment, e)) ? 0 : -1;
    }
    if (!words)
        return 0;
    return (to->what[(*next)++] = text_of(k->comment, e)) ? 0 : -1;
}

/* The materials are in the order of their lines. */
static int take_comments(preset_file *to, in *s, err *e)
{
    char *text;
    keyfile k;
    int64_t next = 0, length;
    keyfile_open(&k, s);
    while ((length = in_line(s, &text, NULL, e)) >= 0) {
        const int words = keyfile_take(&k, text, length, in_lines(s), e);
        if (words < 0 || take_comment(to, &k, words, &next, e))
            return -1;
    }
    return length == -1 ? 0 : -1;
}

/* The same bytes twice: for the materials, and for their comments. */
static int read_bytes(preset_file *to, const char *bytes, int64_t size, const char *name, err *e)
{
    in *s = in_memory(bytes, (size_t)size, name, e);
    int status = s && !materials_read(&to->materials, s, e) ? 0 : -1;
    in_close(s);
    if (status || !(to->what = mem_array(model_count(&to->materials, "material"), sizeof *to->what, "materials", e)))
        return -1;
    s = in_memory(bytes, (size_t)size, name, e);
    status = s ? take_comments(to, s, e) : -1;
    in_close(s);
    return status;
}

int preset_file_take(preset_file *to, in *s, err *e)
{
    *to = (preset_file){.path = mem_text(in_name(s), e), .title = mem_text("", e)};
    char *bytes = NULL;
    const int64_t size = to->path && to->title ? in_all(s, &bytes, e) : -1;
    const int status = size < 0 ? -1 : read_bytes(to, bytes, size, in_name(s), e);
    free(bytes);
    if (status)
        preset_file_free(to);
    return status;
}

int preset_file_read(preset_file *to, const char *path, err *e)
{
    in *s = in_open(path, e);
    const int status = s ? preset_file_take(to, s, e) : -1;
    in_close(s);
    return status;
}

void preset_file_free(preset_file *of)
{
    for (int64_t i = 0; of->what && i < model_count(&of->materials, "material"); i++)
        free(of->what[i]);
    free(of->what);
    free(of->title);
    free(of->path);
    model_free(&of->materials);
    *of = (preset_file){0};
}

/* ---- those that were installed */

static const char ending[] = ".materials";

static int is_preset(const struct dirent *entry)
{
    const size_t n = strlen(entry->d_name);
    return n >= sizeof ending && !strcmp(entry->d_name + n + 1 - sizeof ending, ending);
}

static int take_paths(preset_paths *to, const char *folder, struct dirent *const *list, int count, err *e)
{
    char path[INSTALLED_PATH];
    to->path = mem_array(count, sizeof *to->path, "files of materials", e);
    const int n = to->path ? snprintf(path, sizeof path, "%.3800s/", folder) : 0;
    for (int i = 0; to->path && i < count; i++) {
        if (!(to->path[i] = path_join(path, (size_t)n, list[i]->d_name, e)))
            return -1;
        to->count++;
    }
    return to->path ? 0 : -1;
}

int preset_paths_installed(preset_paths *to, err *e)
{
    char folder[INSTALLED_PATH];
    struct dirent **list;
    *to = (preset_paths){0};
    if (!installed_find("share/sinew/materials", "samples", "face.materials", folder))
        return err_set(e, NULL, 0, "the files of materials are not where they were installed; expected FILE...");
    const int count = scandir(folder, &list, is_preset, alphasort);
    if (count < 0)
        return err_system(e, folder, errno, "cannot list it");
    const int status = take_paths(to, folder, list, count, e);
    for (int i = 0; i < count; i++)
        free(list[i]);
    free(list);
    if (status)
        preset_paths_free(to);
    return status;
}

void preset_paths_free(preset_paths *of)
{
    for (int i = 0; i < of->count; i++)
        free(of->path[i]);
    free(of->path);
    *of = (preset_paths){0};
}
