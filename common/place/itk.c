#include "place/itk.h"

#include "base/in.h"
#include "base/num.h"
#include "base/space.h"

#include <stdio.h>
#include <string.h>

enum { MATRIX = 12, CENTRE = 3 };

typedef struct reading {
    in *source;
    const char *name;
    int transforms;
    double matrix[MATRIX], centre[CENTRE];
    bool has_matrix, has_centre;
} reading;

static int bad(const reading *r, err *e, const char *what, const char *expected)
{
    return err_set(e, r->name, in_lines(r->source), "%.120s; expected %s", what, expected);
}

/* The value of a line `key: value`, or NULL. */
static const char *value_of(const char *line, const char *key)
{
    const size_t n = strlen(key);
    return !strncmp(line, key, n) && line[n] == ':' ? line + n + 1 + strspn(line + n + 1, " \t") : NULL;
}

static int take_type(reading *r, const char *type, err *e)
{
    static const char *const names[] = {"AffineTransform", "MatrixOffsetTransformBase"};
    static const char *const ends[] = {"_double_3_3", "_float_3_3"};
    if (r->transforms++)
        return bad(r, e, "a second transform", "one, an affine one of three dimensions");
    for (int i = 0; i < 4; i++) {
        const char *name = names[i / 2];
        const size_t n = strlen(name);
        if (!strncmp(type, name, n) && !strcmp(type + n, ends[i % 2]))
            return 0;
    }
    return bad(r, e, type, "AffineTransform_double_3_3, as Slicer saves a linear transform as .tfm");
}

static int take_numbers(reading *r, const char *text, double *to, int count, bool *has, err *e)
{
    char expected[40];
    snprintf(expected, sizeof expected, "%d finite numbers, once", count);
    if (*has || num_words(text, text + strlen(text), to, count) != count)
        return bad(r, e, count == MATRIX ? "Parameters" : "FixedParameters", expected);
    *has = true;
    return 0;
}

static int take_line(reading *r, char *line, err *e)
{
    const char *value;
    for (size_t n = strlen(line); n && strchr(" \t\r", line[n - 1]);)
        line[--n] = '\0';
    if (!*line || *line == '#')
        return 0;
    if ((value = value_of(line, "Transform")))
        return take_type(r, value, e);
    if (!r->transforms)
        return bad(r, e, line, "Transform: AffineTransform_double_3_3");
    if ((value = value_of(line, "Parameters")))
        return take_numbers(r, value, r->matrix, MATRIX, &r->has_matrix, e);
    if ((value = value_of(line, "FixedParameters")))
        return take_numbers(r, value, r->centre, CENTRE, &r->has_centre, e);
    return bad(r, e, line, "Parameters: or FixedParameters:");
}

static int read_lines(reading *r, err *e)
{
    char *line;
    int64_t length;
    while ((length = in_line(r->source, &line, NULL, e)) >= 0)
        if (take_line(r, line, e))
            return -1;
    if (length == -2)
        return -1;
    if (!r->transforms || !r->has_matrix || !r->has_centre)
        return err_set(e, r->name, 0, "ends without %s; expected Transform:, Parameters: and FixedParameters:",
                       !r->transforms  ? "Transform:"
                       : r->has_matrix ? "FixedParameters:"
                                       : "Parameters:");
    return 0;
}

/* y = A (x - c) + t + c, with A row by row, and t after it. */
static void matrix_of(const reading *r, double m[16])
{
    for (int i = 0; i < 3; i++) {
        m[4 * i + 3] = r->matrix[9 + i] + r->centre[i];
        for (int j = 0; j < 3; j++) {
            m[4 * i + j] = r->matrix[3 * i + j];
            m[4 * i + 3] -= r->matrix[3 * i + j] * r->centre[j];
        }
        m[12 + i] = 0;
    }
    m[15] = 1;
}

static pose inverse(const pose *p)
{
    const pose none = pose_none();
    return pose_relative(p, &none);
}

int itk_read(const transform_file *f, pose *to, err *e)
{
    reading r = {.name = f->name};
    double m[16];
    pose back;
    err why = {0};
    r.source = in_memory(f->bytes, (size_t)f->size, f->name, e);
    if (!r.source)
        return -1;
    const int failed = read_lines(&r, e);
    in_close(r.source);
    if (failed)
        return -1;
    matrix_of(&r, m);
    if (space_pose_of_matrix(m, SPACE_LPS, &back, &why))
        return err_set(e, f->name, 0, "%s", why.text);
    *to = inverse(&back);
    if (f->use == TRANSFORM_MARKER)
        *to = space_motion(to);
    return 0;
}

void itk_write(const pose *p, transform_use use, out *to)
{
    const pose lps = use == TRANSFORM_MARKER ? space_motion(p) : *p, back = inverse(&lps);
    double m[16];
    char text[NUM_TEXT];
    space_matrix_of_pose(&back, SPACE_LPS, m);
    out_text(to, ITK_FIRST " V1.0\n#Transform 0\nTransform: AffineTransform_double_3_3\nParameters:");
    for (int i = 0; i < MATRIX; i++) {
        num_text(i < 9 ? m[4 * (i / 3) + i % 3] : m[4 * (i - 9) + 3], false, text);
        out_text(to, " ");
        out_text(to, text);
    }
    out_text(to, "\nFixedParameters: 0 0 0\n");
}
