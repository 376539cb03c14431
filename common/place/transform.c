#include "place/transform.h"

#include "base/in.h"
#include "base/mem.h"
#include "base/num.h"
#include "base/space.h"
#include "place/itk.h"
#include "place/links.h"
#include "place/plus_config.h"
#include "place/tum.h"

#include <stdlib.h>
#include <string.h>

#define EXPECTED                                                                                                       \
    "expected a line " TUM_LINE " (m), four lines of a 4 x 4 matrix (mm), a configuration of PLUS, or Slicer's .tfm"

/* ---- numbers: a pose, or a matrix */

typedef struct numbers {
    keyfile k;
    double value[16];
    int count, lines;
    space space;
    bool said; /* in which space it is */
} numbers;

static int take_space(numbers *n, err *e)
{
    if (n->said || n->lines)
        return keyfile_error(&n->k, e, "'%s' after other lines; expected it before the matrix, once", n->k.word[0]);
    n->said = true;
    n->space = !strcmp(n->k.word[0], "RAS") ? SPACE_RAS : SPACE_LPS;
    return 0;
}

static bool is_space(const keyfile *k)
{
    return k->count == 1 && (!strcmp(k->word[0], "RAS") || !strcmp(k->word[0], "LPS"));
}

/* A row of a matrix, or all of it. */
static int take_row(numbers *n, err *e)
{
    const keyfile *k = &n->k;
    if ((k->count != 4 && (k->count != 16 || n->lines)) || n->count + k->count > 16)
        return keyfile_error(k, e, "%d words on line %d of numbers; " EXPECTED, k->count, n->lines + 1);
    for (int i = 0; i < k->count; i++)
        if (num_double(k->word[i], &n->value[n->count++]))
            return keyfile_error(k, e, "'%.100s' is not a finite number; expected a row of a 4 x 4 matrix", k->word[i]);
    n->lines++;
    return 0;
}

static int take_pose(numbers *n, pose *to, err *e)
{
    double time;
    if (n->lines || n->said)
        return keyfile_error(&n->k, e, "a line of %d words after others; expected one line " TUM_LINE, TUM_WORDS);
    if (tum_take(&n->k, &time, to, e))
        return -1;
    n->lines++;
    const int more = keyfile_next(&n->k, e);
    return more > 0 ? keyfile_error(&n->k, e, "a second line; expected one line " TUM_LINE) : more;
}

static int end_matrix(const numbers *n, pose *to, err *e)
{
    err why = {0};
    if (n->count != 16)
        return err_set(e, n->k.name, 0, "%d numbers; " EXPECTED, n->count);
    if (space_pose_of_matrix(n->value, SPACE_LPS, to, &why))
        return err_set(e, n->k.name, 0, "%s", why.text);
    if (n->space == SPACE_RAS)
        *to = space_motion(to);
    return 0;
}

static int read_lines(numbers *n, pose *to, err *e)
{
    int more;
    while ((more = keyfile_next(&n->k, e)) > 0) {
        if (n->k.count == TUM_WORDS)
            return take_pose(n, to, e);
        if (is_space(&n->k) ? take_space(n, e) : take_row(n, e))
            return -1;
    }
    return more ? -1 : end_matrix(n, to, e);
}

static int read_numbers(const transform_file *f, pose *to, err *e)
{
    numbers n = {.count = 0};
    in *s = in_memory(f->bytes, (size_t)f->size, f->name, e);
    if (!s)
        return -1;
    keyfile_open(&n.k, s);
    const int failed = read_lines(&n, to, e);
    in_close(s);
    return failed;
}

/* ---- kinds of files */

typedef enum kind { KIND_WORDS, KIND_NUMBERS, KIND_PLUS, KIND_ITK, KIND_HDF5 } kind;

static bool begins(const char *p, const char *end, const char *with)
{
    const size_t n = strlen(with);
    return (size_t)(end - p) >= n && !memcmp(p, with, n);
}

static const char *past(const char *p, const char *end, const char *among)
{
    while (p < end && *p && strchr(among, *p))
        p++;
    return p;
}

/* Where the first line that is no comment begins. */
static const char *first_line(const char *p, const char *end)
{
    for (;;) {
        p = past(p, end, " \t\r\n");
        if (p == end || *p != '#')
            return p;
        while (p < end && *p != '\n')
            p++;
    }
}

static kind kind_of(const char *bytes, int64_t size)
{
    const char *end = bytes + size;
    if (begins(bytes, end, "\x89HDF\r\n\x1a\n"))
        return KIND_HDF5;
    if (begins(bytes, end, ITK_FIRST))
        return KIND_ITK;
    const char *p = first_line(bytes, end);
    if (p < end && *p == '<')
        return KIND_PLUS;
    if (p < end && *p && strchr("+-.0123456789", *p))
        return KIND_NUMBERS;
    if (begins(p, end, "RAS") || begins(p, end, "LPS")) {
        p = past(p + 3, end, " \t\r");
        return p == end || *p == '\n' || *p == '#' ? KIND_NUMBERS : KIND_WORDS;
    }
    return KIND_WORDS;
}

bool transform_is(const char *bytes, int64_t size)
{
    return kind_of(bytes, size) != KIND_WORDS;
}

int transform_read(const transform_file *f, pose *to, err *e)
{
    const kind is = kind_of(f->bytes, f->size);
    if (f->frames && is != KIND_PLUS)
        return err_set(e, f->name, 0, "has no transforms with names, such as %.130s; expected a configuration of PLUS",
                       f->frames);
    switch (is) {
    case KIND_HDF5:
        return err_set(e, f->name, 0,
                       "is HDF5, as Slicer's .h5; expected text: save the transform as .tfm (in Slicer's Save dialog, "
                       "choose the file format Text (.tfm))");
    case KIND_ITK:
        return itk_read(f, to, e);
    case KIND_PLUS:
        return plus_config_read(f, to, e);
    case KIND_NUMBERS:
        return read_numbers(f, to, e);
    case KIND_WORDS:
        break;
    }
    return err_set(e, f->name, 0, f->size ? "is none of these; " EXPECTED : "is empty; " EXPECTED);
}

/* ---- paths */

char *transform_path(const char *path, const char **frames, err *e)
{
    char from[LINKS_NAME], to[LINKS_NAME];
    const char *colon = strrchr(path, ':');
    char *file = mem_text(path, e);
    *frames = NULL;
    if (file && colon && colon > path && !strchr(colon, '/') && !strchr(colon, '.') &&
        !links_split(colon + 1, strlen(colon + 1), from, to)) {
        file[colon - path] = '\0';
        *frames = colon + 1;
    }
    return file;
}

int transform_marker(const char *path, pose *to, err *e)
{
    transform_file f = {.use = TRANSFORM_MARKER};
    char *file = transform_path(path, &f.frames, e), *bytes = NULL;
    in *s = file ? in_open(file, e) : NULL;
    int failed = -1;
    if (s && in_peek(s, e) != -2 && (f.size = in_all(s, &bytes, e)) >= 0) { /* without a byte order mark */
        f.name = in_name(s);
        f.bytes = bytes;
        failed = transform_read(&f, to, e);
    }
    free(bytes);
    free(file);
    in_close(s);
    return failed;
}
