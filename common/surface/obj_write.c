#include "surface/obj.h"

#include "surface/obj_words.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void obj_free(obj *o)
{
    for (int32_t g = 0; g < o->groups; g++)
        free(o->group[g]);
    free(o->group);
    free(o->name);
    free(o->text);
    free(o->position);
    free(o->v);
    free(o->normal);
    free(o->vn);
    free(o->face_start);
    free(o->face_group);
    free(o->corner_vertex);
    free(o->corner_normal);
    *o = (obj){0};
}

void obj_notes(const obj *o, notes *warnings)
{
    if (o->free_form)
        notes_add(warnings,
                  "%s:%lld: free-form curves and surfaces are skipped, %lld line%s from here on; to have them, convert "
                  "them to "
                  "polygons",
                  o->name, (long long)o->free_form_line, (long long)o->free_form, o->free_form == 1 ? "" : "s");
}

void obj_box(const obj *o, double low[3], double high[3])
{
    for (int a = 0; a < 3; a++) {
        low[a] = INFINITY;
        high[a] = -INFINITY;
    }
    for (int64_t i = 0; i < (o->corners ? o->corners : o->vertices); i++)
        for (int a = 0; a < 3; a++) {
            double x = o->position[3 * (o->corners ? o->corner_vertex[i] : i) + a];
            low[a] = fmin(low[a], x);
            high[a] = fmax(high[a], x);
        }
}

int64_t obj_line_number(const obj *o, int64_t offset)
{
    int64_t line = 1;
    for (int64_t i = 0; i < offset; i++)
        line += o->text[i] == '\n';
    return line;
}

/* The length of the blank or continuation at p, or 0. */
static int64_t blank(const char *p)
{
    return obj_is_blank(*p) ? 1 : obj_continues(p);
}

static const char *skip_blanks(const char *p, const char *end)
{
    while (p < end && blank(p))
        p += blank(p);
    return p;
}

static const char *skip_word(const char *p, const char *end)
{
    while (p < end && !blank(p))
        p++;
    return p;
}

/* Writes text with each continuation as a blank: one line. */
static void write_joined(const char *from, const char *to, out *sink)
{
    const char *p = from;
    while (p < to) {
        int64_t n = obj_continues(p);
        if (!n) {
            p++;
            continue;
        }
        out_write(sink, from, (size_t)(p - from));
        out_write(sink, " ", 1);
        from = p += n;
    }
    out_write(sink, from, (size_t)(p - from));
}

/* How many digits give nine of the surface's extent: one more for each power of ten that the farthest coordinate is
 * above it. Of the vertices that something uses, if any is. */
static int digits_of(const obj *o)
{
    double extent = 0, farthest = 0, low[3], high[3];
    obj_box(o, low, high);
    for (int a = 0; a < 3; a++) {
        extent = fmax(extent, high[a] - low[a]);
        farthest = fmax(farthest, fmax(-low[a], high[a]));
    }
    int digits = 9;
    while (extent < farthest && digits < 17) {
        extent *= 10;
        digits++;
    }
    return digits;
}

/* The line again with other numbers after its keyword. */
static void write_row(const obj *o, obj_line line, const double *value, int digits, out *sink)
{
    const char *from = o->text + line.from, *to = o->text + line.to;
    const char *first = skip_blanks(skip_word(skip_blanks(from, to), to), to), *rest = first;
    for (int i = 0; i < 3; i++)
        rest = skip_word(skip_blanks(rest, to), to);
    write_joined(from, first, sink);
    out_format(sink, "%.*g %.*g %.*g", digits, value[0], digits, value[1], digits, value[2]);
    write_joined(rest, to, sink);
}

static bool same(const double *a, const double *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

void obj_write(const obj *o, const double *position, const double *normal, out *to)
{
    int digits = digits_of(o);
    int64_t at = 0, v = 0, n = 0, normals = normal ? o->normals : 0;
    while (v < o->vertices || n < normals) {
        bool vertex = n == normals || (v < o->vertices && o->v[v].from < o->vn[n].from);
        int64_t i = vertex ? v++ : n++;
        const double *was = vertex ? &o->position[3 * i] : &o->normal[3 * i];
        const double *is = vertex ? &position[3 * i] : &normal[3 * i];
        obj_line line = vertex ? o->v[i] : o->vn[i];
        if (same(was, is))
            continue;
        out_write(to, o->text + at, (size_t)(line.from - at));
        write_row(o, line, is, vertex ? digits : 9, to);
        at = line.to;
    }
    out_write(to, o->text + at, (size_t)(o->size - at));
}
