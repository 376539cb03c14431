#include "console/cases.h"

#include "base/mem.h"
#include "base/path.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { NAME = 256 };

static const char *const models[] = {".sinew", ".sinew.gz", ".model", ".result", NULL};
static const char *const volumes[] = {".nrrd", ".mha", ".mhd", ".nhdr", NULL};

/* The length of the ending that the name has of these, or 0. */
static size_t ending(const char *name, const char *const *list)
{
    const size_t n = strlen(name);
    for (; *list; list++)
        if (n > strlen(*list) && !strcasecmp(name + n - strlen(*list), *list))
            return strlen(*list);
    return 0;
}

static bool is_folder(const char *path)
{
    struct stat s;
    return !stat(path, &s) && S_ISDIR(s.st_mode);
}

static const char *base_of(const char *path)
{
    return path + path_folder(path);
}

/* ---- one case */

static void free_case(console_case *one)
{
    free(one->name);
    free(one->model);
    free(one->volume);
    free(one->labels);
    free(one->picture);
    free(one->body);
    free(one->skin);
    free(one->bones);
    free(one->expressions);
}

/* A name that no case has: this, or with the next number. */
static char *free_name(const cases *c, const char *name, err *e)
{
    char text[NAME + 16];
    snprintf(text, sizeof text, "%.*s", NAME, name);
    for (int i = 2; cases_find(c, text) >= 0; i++)
        snprintf(text, sizeof text, "%.*s-%d", NAME, name, i);
    return mem_text(text, e);
}

/* Takes over what `one` holds; its name is replaced by one that is free. */
static int add(cases *c, console_case one, const char *name, err *e)
{
    one.name = free_name(c, name, e);
    if (!one.name || MEM_ROOM(&c->list, &c->capacity, c->count + 1, "cases", e)) {
        free_case(&one);
        return -1;
    }
    c->list[c->count++] = one;
    return 0;
}

/* The folder's own name: of what it is a link to, or "." stands for. */
static int name_folder(const char *folder, char name[NAME], err *e)
{
    char *whole = realpath(folder, NULL);
    if (!whole)
        return err_system(e, folder, errno, "cannot open");
    snprintf(name, NAME, "%s", base_of(whole));
    free(whole);
    return 0;
}

/* ---- folders */

typedef struct listing_of {
    struct dirent **list;
    int count;
} listing_of;

static int visible(const struct dirent *one)
{
    return one->d_name[0] != '.';
}

static int open_listing(listing_of *l, const char *folder, err *e)
{
    l->count = scandir(folder, &l->list, visible, alphasort);
    return l->count < 0 ? err_system(e, folder, errno, "cannot list") : 0;
}

static void close_listing(listing_of *l)
{
    for (int i = 0; i < l->count; i++)
        free(l->list[i]);
    free(l->list);
}

static char *join(const char *folder, const char *name, err *e)
{
    const size_t n = strlen(folder) + strlen(name) + 2;
    char *path = mem_array((int64_t)n, 1, "a path", e);
    if (path)
        snprintf(path, n, "%s%s%s", folder, folder[strlen(folder) - 1] == '/' ? "" : "/", name);
    return path;
}

static bool is_labels(const char *name)
{
    return strstr(name, "label") != NULL;
}

/* The first name of these endings, or the one that begins so; labels or not. NULL: none. */
static const char *pick(const listing_of *l, const char *const *endings, const char *preferred, bool labels)
{
    const char *first = NULL;
    for (int i = 0; i < l->count; i++) {
        const char *name = l->list[i]->d_name;
        if (!ending(name, endings) || is_labels(name) != labels)
            continue;
        if (!strncmp(name, preferred, strlen(preferred)))
            return name;
        first = first ? first : name;
    }
    return first;
}

/* Takes the files that have fixed names in the folder of a case. */
static int take_named(console_case *one, const char *folder, const listing_of *l, err *e)
{
    const struct {
        const char *name;
        char **to;
    } files[] = {{"picture.png", &one->picture},
                 {"body.txt", &one->body},
                 {"skin.obj", &one->skin},
                 {"skeleton.obj", &one->bones},
                 {"expressions.txt", &one->expressions}};
    for (int i = 0; i < l->count; i++)
        for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
            if (strcmp(l->list[i]->d_name, files[k].name) != 0)
                continue;
            *files[k].to = join(folder, files[k].name, e);
            if (!*files[k].to)
                return -1;
        }
    return 0;
}

/* Fills one with what the folder has. 1: it is a case; 0: it is none; -1: e filled. */
static int look_into(console_case *one, const char *folder, const listing_of *l, err *e)
{
    const char *model = pick(l, models, "mesh", false), *volume = pick(l, volumes, "volume", false);
    const char *labels = pick(l, volumes, "labels", true);
    *one = (console_case){0};
    if (!model || (!volume && strncmp(model, "mesh.", 5) != 0))
        return 0;
    one->model = join(folder, model, e);
    one->volume = volume ? join(folder, volume, e) : NULL;
    one->labels = labels ? join(folder, labels, e) : NULL;
    if (one->model && (one->volume || !volume) && (one->labels || !labels) && !take_named(one, folder, l, e))
        return 1;
    free_case(one);
    return -1;
}

static int add_model(cases *c, const char *path, const char *volume, err *e)
{
    char name[NAME];
    console_case one = {.model = mem_text(path, e), .volume = volume ? mem_text(volume, e) : NULL};
    if (!one.model || (volume && !one.volume)) {
        free_case(&one);
        return -1;
    }
    snprintf(name, sizeof name, "%.*s", (int)(strlen(base_of(path)) - ending(path, models)), base_of(path));
    return add(c, one, name, e);
}

/* A folder within a folder, where it is a case. */
static int add_inner(cases *c, const char *path, const char *name, err *e)
{
    listing_of l = {0};
    console_case one;
    if (open_listing(&l, path, e))
        return -1;
    const int is = look_into(&one, path, &l, e);
    close_listing(&l);
    return is > 0 ? add(c, one, name, e) : is;
}

static int add_all(cases *c, const char *folder, const listing_of *l, err *e)
{
    int failed = 0;
    for (int i = 0; i < l->count && !failed; i++) {
        char *path = join(folder, l->list[i]->d_name, e);
        if (!path)
            return -1;
        if (is_folder(path))
            failed = add_inner(c, path, l->list[i]->d_name, e);
        else if (ending(path, models))
            failed = add_model(c, path, NULL, e);
        free(path);
    }
    return failed;
}

static int add_folder(cases *c, const char *folder, err *e)
{
    char name[NAME];
    listing_of l = {0};
    console_case one;
    const int before = c->count;
    if (open_listing(&l, folder, e))
        return -1;
    const int is = look_into(&one, folder, &l, e);
    int failed = is < 0 ? -1 : 0;
    if (is > 0 && name_folder(folder, name, e)) {
        free_case(&one);
        failed = -1;
    } else if (is > 0) {
        failed = add(c, one, name, e);
    } else if (!is) {
        failed = add_all(c, folder, &l, e);
    }
    close_listing(&l);
    if (!failed && c->count == before)
        return err_set(e, folder, 0,
                       "there is no case; expected a model (.sinew) and its volume (.nrrd, .mha or "
                       ".mhd), or folders of these");
    return failed;
}

/* ---- all */

int cases_add(cases *c, char *const *operand, int count, err *e)
{
    for (int i = 0; i < count; i++) {
        const bool paired = i + 1 < count && ending(operand[i + 1], volumes) && !is_folder(operand[i + 1]);
        struct stat s;
        if (stat(operand[i], &s))
            return err_system(e, operand[i], errno, "cannot open");
        if (ending(operand[i], volumes) && !S_ISDIR(s.st_mode))
            return err_set(e, operand[i], 0, "a volume without a model; expected the model's name before it");
        const char *volume = paired ? operand[i + 1] : NULL;
        if (S_ISDIR(s.st_mode) ? add_folder(c, operand[i], e) : add_model(c, operand[i], volume, e))
            return -1;
        i += !S_ISDIR(s.st_mode) && paired;
    }
    return 0;
}

int cases_find(const cases *c, const char *name)
{
    for (int i = 0; i < c->count; i++)
        if (!strcmp(c->list[i].name, name))
            return i;
    return -1;
}

void cases_free(cases *c)
{
    for (int i = 0; i < c->count; i++)
        free_case(&c->list[i]);
    free(c->list);
    *c = (cases){0};
}
