#include "base/chars.h"
#include "base/mem.h"
#include "base/near.h"
#include "base/num.h"
#include "surface/names.h"
#include "surface/obj.h"
#include "surface/obj_words.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Positive indices may point to what comes later in the file. Only those that point further than any before them
 * are kept: of these, the first past the final count is the file's first wrong one. */
typedef struct forward {
    int64_t index, line;
} forward;

typedef struct forwards {
    forward *v;
    int64_t count, capacity, furthest;
} forwards;

typedef struct reader {
    obj *o;
    obj_words w;
    const char *keyword; /* of the statement */
    struct {
        int64_t position, v, normal, vn, face_start, face_group, corner_vertex, corner_normal;
    } room;
    forwards vertex, normal;
    names groups;
    bool grouped; /* `current` is the group of the next face */
    int32_t current;
    char *object; /* the last object's name, or NULL */
    char *name;   /* scratch for names */
    int64_t name_room;
} reader;

/* Numbers */

/* All the numbers that are left on the line: how many, or -1. */
static int read_numbers(reader *r, double *value, int most, const char *expected)
{
    int n = 0;
    while (obj_next_word(&r->w)) {
        const char *stop;
        if (n == most)
            return obj_bad_word(&r->w, "too many numbers, from", expected);
        if (num_scan(r->w.p, r->w.end, &stop, &value[n]) || !obj_word_ends(&r->w, stop))
            return obj_bad_word(&r->w, "not a finite number:", expected);
        r->w.p = stop;
        n++;
    }
    return n;
}

/* Stores three numbers and their line as the next row of an array. Its line's end is known only now: p is there, or at
 * a comment, which belongs to the line. */
static int store_row(reader *r, const double *value, double **row, int64_t *row_room, obj_line **line,
                     int64_t *line_room, int64_t *count)
{
    if (*count >= INT32_MAX)
        return err_set(r->w.e, r->w.name, r->w.line, "more than %d vertices or normals; expected a smaller mesh",
                       INT32_MAX);
    if (MEM_ROOM(row, row_room, 3 * (*count + 1), "an OBJ's coordinates", r->w.e) ||
        MEM_ROOM(line, line_room, *count + 1, "an OBJ's lines", r->w.e))
        return -1;
    memcpy(*row + 3 * *count, value, 3 * sizeof *value);
    const char *to = r->w.p;
    while (!obj_line_ends(to, r->w.end))
        to++;
    (*line)[(*count)++] = (obj_line){r->w.line_start - r->o->text, to - r->o->text};
    return 0;
}

static int read_vertex(reader *r)
{
    static const char expected[] = "v x y z, then w, or colours, or nothing";
    double value[8];
    int n = read_numbers(r, value, 8, expected);
    if (n < 0)
        return -1;
    if (n < 3 || n == 5)
        return err_set(r->w.e, r->w.name, r->w.line, "a vertex of %d numbers; expected %s", n, expected);
    obj *o = r->o;
    return store_row(r, value, &o->position, &r->room.position, &o->v, &r->room.v, &o->vertices);
}

static int read_normal(reader *r)
{
    double value[3];
    int n = read_numbers(r, value, 3, "vn x y z");
    if (n < 0)
        return -1;
    if (n < 3)
        return err_set(r->w.e, r->w.name, r->w.line, "a normal of %d numbers; expected vn x y z", n);
    obj *o = r->o;
    return store_row(r, value, &o->normal, &r->room.normal, &o->vn, &r->room.vn, &o->normals);
}

/* Groups */

/* Makes the group of this name current, adding it where it is new. */
static int enter_group(reader *r, const char *name)
{
    r->current = names_number(&r->groups, name, r->w.e);
    r->grouped = true;
    return r->current < 0 ? -1 : 0;
}

/* The words that are left on the line, joined by `joint`, into r->name: their length, or -1. */
static int64_t read_names(reader *r, char joint)
{
    int64_t n = 0;
    while (obj_next_word(&r->w)) {
        const char *stop = obj_word_end(&r->w);
        int64_t length = stop - r->w.p;
        if (mem_grow(&r->name, &r->name_room, n + 4 * length + 2, 1, "a group's name", r->w.e))
            return -1;
        if (n)
            r->name[n++] = joint;
        n += (int64_t)chars_escape(r->w.p, (size_t)length, r->name + n);
        r->w.p = stop;
    }
    return n;
}

static int read_group(reader *r)
{
    int64_t n = read_names(r, ' ');
    if (n < 0)
        return -1;
    return enter_group(r, n ? r->name : "default");
}

/* An object names faces only where no group does: its first face tells, so its name is kept until then. */
static int read_object(reader *r)
{
    int64_t n = read_names(r, '_');
    if (n < 0)
        return -1;
    free(r->object);
    r->object = n ? mem_text(r->name, r->w.e) : NULL;
    r->grouped = false;
    return n && !r->object ? -1 : 0;
}

/* Faces, lines, points */

static int begin_face(reader *r)
{
    obj *o = r->o;
    if (!r->grouped && enter_group(r, r->object ? r->object : "default"))
        return -1;
    if (MEM_ROOM(&o->face_start, &r->room.face_start, o->faces + 2, "an OBJ's faces", r->w.e) ||
        MEM_ROOM(&o->face_group, &r->room.face_group, o->faces + 1, "an OBJ's faces", r->w.e))
        return -1;
    o->face_start[o->faces] = o->corners;
    o->face_group[o->faces++] = r->current;
    return 0;
}

static int add_corner(reader *r, const int32_t *corner)
{
    obj *o = r->o;
    if (MEM_ROOM(&o->corner_vertex, &r->room.corner_vertex, o->corners + 1, "an OBJ's corners", r->w.e) ||
        MEM_ROOM(&o->corner_normal, &r->room.corner_normal, o->corners + 1, "an OBJ's corners", r->w.e))
        return -1;
    o->corner_vertex[o->corners] = corner[0];
    o->corner_normal[o->corners++] = corner[1];
    return 0;
}

static const char forms[] = "v, v/vt, v//vn or v/vt/vn, each from 1 or negative";

/* An index at *p: not 0, at most 2^31 - 1 either way. Steps past it; 0 where there is none. */
static int64_t scan_index(const char **p)
{
    const char *q = *p;
    bool minus = *q == '-';
    q += minus;
    if (*q < '0' || *q > '9')
        return 0;
    int64_t v = 0;
    for (; *q >= '0' && *q <= '9'; q++)
        if (v <= INT32_MAX)
            v = v * 10 + (*q - '0');
    if (v > INT32_MAX)
        return 0;
    *p = q;
    return minus ? -v : v;
}

/* Makes an index as written 0-based: a negative one counts back from the `count` so far; a positive one may point
 * ahead. */
static int resolve(reader *r, int64_t index, int64_t count, forwards *ahead, const char *what, int32_t *to)
{
    if (-index > count)
        return err_set(r->w.e, r->w.name, r->w.line, "%s %lld, but only %lld came before; expected %s", what,
                       (long long)index, (long long)count, forms);
    if (index > count && index > ahead->furthest) {
        if (mem_grow(&ahead->v, &ahead->capacity, ahead->count + 1, sizeof *ahead->v, "an OBJ's indices", r->w.e))
            return -1;
        ahead->v[ahead->count++] = (forward){index, r->w.line};
        ahead->furthest = index;
    }
    *to = (int32_t)(index < 0 ? count + index : index - 1);
    return 0;
}

enum { WITH_TEXTURE = 1, WITH_NORMAL = 2 };

/* One corner in any form: vertex and normal (-1: none), and the form (WITH_...). Texture indices concern nobody here:
 * only their syntax is checked. */
static int read_corner(reader *r, int32_t *corner, int *form)
{
    const char *p = r->w.p;
    int64_t vertex = scan_index(&p), texture = 1, normal = 1;
    *form = 0;
    corner[1] = -1;
    if (*p == '/' && p[1] != '/') {
        p++;
        texture = scan_index(&p);
        *form |= WITH_TEXTURE;
    } else if (*p == '/') {
        p++;
    }
    if (*p == '/') {
        p++;
        normal = scan_index(&p);
        *form |= WITH_NORMAL;
    }
    if (!vertex || !texture || !normal || !obj_word_ends(&r->w, p))
        return obj_bad_word(&r->w, "not a corner:", forms);
    if (resolve(r, vertex, r->o->vertices, &r->vertex, "vertex", &corner[0]))
        return -1;
    if ((*form & WITH_NORMAL) && resolve(r, normal, r->o->normals, &r->normal, "normal", &corner[1]))
        return -1;
    r->w.p = p;
    return 0;
}

static int read_face(reader *r)
{
    int32_t corner[2] = {0};
    int form, first = 0;
    if (begin_face(r))
        return -1;
    int64_t start = r->o->corners;
    while (obj_next_word(&r->w)) {
        const char *word = r->w.p;
        if (read_corner(r, corner, &form) || add_corner(r, corner))
            return -1;
        if (r->o->corners == start + 1)
            first = form;
        if (form != first) {
            r->w.p = word;
            return obj_bad_word(&r->w, "a corner unlike the face's others:", "one form in a face");
        }
    }
    int64_t n = r->o->corners - start;
    if (n < 3)
        return err_set(r->w.e, r->w.name, r->w.line, "a face of %lld corners; expected 3 or more", (long long)n);
    return 0;
}

static int read_line(reader *r)
{
    int32_t corner[2] = {0}, before[2] = {0};
    int form, n = 0;
    for (; obj_next_word(&r->w); n = n < 2 ? n + 1 : 2) {
        if (read_corner(r, corner, &form))
            return -1;
        if (n && (begin_face(r) || add_corner(r, before) || add_corner(r, corner)))
            return -1;
        memcpy(before, corner, sizeof before);
    }
    if (n < 2)
        return err_set(r->w.e, r->w.name, r->w.line, "a line of %d vertices; expected 2 or more", n);
    return 0;
}

static int read_point(reader *r)
{
    int32_t corner[2] = {0};
    int form, n = 0;
    for (; obj_next_word(&r->w); n = 1)
        if (read_corner(r, corner, &form) || begin_face(r) || add_corner(r, corner))
            return -1;
    if (!n)
        return err_set(r->w.e, r->w.name, r->w.line, "a point statement without a vertex; expected p and vertices");
    return 0;
}

/* Statements */

static int pass_over(reader *r)
{
    obj_skip_words(&r->w);
    return 0;
}

/* Curves and surfaces beside polygons. */
static int skip_free_form(reader *r)
{
    if (!r->o->free_form++)
        r->o->free_form_line = r->w.line;
    return pass_over(r);
}

static int refuse_call(reader *r)
{
    r->w.p = r->keyword;
    return obj_bad_word(&r->w, "a statement that runs other files:", "one OBJ that holds all");
}

typedef struct statement {
    const char *words; /* between blanks */
    int (*read)(reader *r);
} statement;

/* In the order of how often they come. */
static const statement statements[] = {
    {"v", read_vertex},
    {"f fo", read_face},
    {"vn", read_normal},
    {"vt s usemtl mtllib mg usemap maplib bevel c_interp d_interp lod shadow_obj trace_obj", pass_over},
    {"g", read_group},
    {"o", read_object},
    {"l", read_line},
    {"p", read_point},
    {"vp cstype deg bmat step curv curv2 surf parm trim hole scrv sp end con ctech stech bsp bzp cdc cdp res",
     skip_free_form},
    {"call csh", refuse_call},
};

enum { STATEMENTS = sizeof statements / sizeof *statements };

static bool is_among(const char *words, const char *word, size_t n)
{
    for (; words; words = strchr(words, ' ')) {
        words += *words == ' ';
        if (!strncmp(words, word, n) && (words[n] == ' ' || !words[n]))
            return true;
    }
    return false;
}

/* Finds the statement whose name is like word, if any, and writes "perhaps 'name'". */
static void suggest(const char *word, char *to, size_t size)
{
    enum { WORDS = 64, TEXT = 100 };
    char text[STATEMENTS][TEXT], *keep;
    const char *known[WORDS];
    int count = 0;
    for (int i = 0; i < STATEMENTS; i++) {
        snprintf(text[i], TEXT, "%s", statements[i].words);
        for (char *w = strtok_r(text[i], " ", &keep); w && count < WORDS; w = strtok_r(NULL, " ", &keep))
            known[count++] = w;
    }
    int near = near_name(word, known, count);
    if (near >= 0)
        snprintf(to, size, "perhaps '%s'", known[near]);
}

static int refuse_unknown(reader *r)
{
    char word[32], expected[64] = "a statement of an OBJ (v, vn, f, g, ...) or a comment (#)";
    size_t n = (size_t)(obj_word_end(&r->w) - r->w.p);
    if (n < sizeof word) {
        memcpy(word, r->w.p, n);
        word[n] = 0;
        suggest(word, expected, sizeof expected);
    }
    return obj_bad_word(&r->w, "unknown statement", expected);
}

static int read_statement(reader *r)
{
    const char *p = r->w.p, *stop;
    if ((*p == 'v' || *p == 'f') && obj_is_blank(p[1])) { /* nearly all */
        r->keyword = r->w.p++;
        return *p == 'v' ? read_vertex(r) : read_face(r);
    }
    stop = obj_word_end(&r->w);
    size_t n = (size_t)(stop - p);
    for (int i = 0; i < STATEMENTS; i++)
        if (is_among(statements[i].words, r->w.p, n)) {
            r->keyword = r->w.p;
            r->w.p = stop;
            return statements[i].read(r);
        }
    return refuse_unknown(r);
}

static int read_lines(reader *r)
{
    for (; r->w.p < r->w.end; obj_next_line(&r->w))
        if (obj_next_word(&r->w) && read_statement(r))
            return -1;
    return 0;
}

/* Bytes that no OBJ has, wherever they are: a NUL, a CR without its LF. */
static int check_bytes(reader *r)
{
    const char *text = r->o->text, *nul = memchr(text, 0, (size_t)r->o->size);
    if (nul)
        return err_set(r->w.e, r->w.name, obj_line_number(r->o, nul - text),
                       "a NUL byte; expected an OBJ, which is text");
    for (const char *cr = strchr(text, '\r'); cr; cr = strchr(cr + 1, '\r'))
        if (cr[1] && cr[1] != '\n')
            return err_set(r->w.e, r->w.name, obj_line_number(r->o, cr - text),
                           "a CR within the line; expected lines that end with LF or CR LF");
    return 0;
}

static int check_ahead(reader *r, const forwards *ahead, int64_t count, const char *what)
{
    for (int64_t i = 0; i < ahead->count; i++)
        if (ahead->v[i].index > count)
            return err_set(r->w.e, r->w.name, ahead->v[i].line, "%s %lld, but the file has %lld; expected %s", what,
                           (long long)ahead->v[i].index, (long long)count, forms);
    return 0;
}

static int finish(reader *r)
{
    obj *o = r->o;
    if (check_ahead(r, &r->vertex, o->vertices, "vertex") || check_ahead(r, &r->normal, o->normals, "normal"))
        return -1;
    if (mem_grow(&o->face_start, &r->room.face_start, o->faces + 1, sizeof *o->face_start, "an OBJ's faces", r->w.e))
        return -1;
    o->face_start[o->faces] = o->corners;
    o->group = r->groups.name; /* handed over */
    o->groups = r->groups.count;
    r->groups.name = NULL;
    r->groups.count = 0;
    return 0;
}

int obj_read(obj *o, in *s, err *e)
{
    reader r = {.o = o};
    *o = (obj){0};
    o->name = mem_text(in_name(s), e);
    o->size = o->name ? in_all(s, &o->text, e) : -1;
    int code = o->size < 0 ? -1 : 0;
    if (!code) {
        const char *start = o->text + (strncmp(o->text, "\xef\xbb\xbf", 3) ? 0 : 3); /* a byte order mark */
        r.w = (obj_words){o->name, start, o->text + o->size, start, 1, e};
        code = check_bytes(&r) || read_lines(&r) || finish(&r) ? -1 : 0;
    }
    free(r.vertex.v);
    free(r.normal.v);
    names_free(&r.groups);
    free(r.name);
    free(r.object);
    if (code)
        obj_free(o);
    return code;
}
