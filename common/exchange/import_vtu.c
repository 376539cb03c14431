#include "exchange/import_vtu.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/near.h"
#include "base/num.h"
#include "exchange/import_xml.h"
#include "model/known.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Where an array stands. */
typedef enum section { NOWHERE, POINTS, CELLS, POINT_DATA, CELL_DATA, FIELD_DATA } section;

typedef struct placed {
    section where;
    xml_array a;
} placed;

typedef struct reader {
    import_mesh *m;
    const import_wishes *w;
    notes *warnings;
    err *e;
    xml x;
    xml_style style;
    placed *arrays;
    int64_t count, room;
    const char *lined; /* how far lines have been counted: so many */
    int64_t lines;
    int64_t points, cells; /* -1: no piece yet */
    int64_t *cell;         /* elements: which cell it is */
    int64_t cell_room;
} reader;

static int wrong(const reader *r, const char *at, const char *what, const char *expected)
{
    return err_set(r->e, r->x.name, xml_line(&r->x, at), "%.200s; expected %s", what, expected);
}

/* ---- the XML */

static int take_head(reader *r, const xml_tag *tag)
{
    const char *type = xml_value(tag, "type"), *order = xml_value(tag, "byte_order"),
               *header = xml_value(tag, "header_type"), *compressor = xml_value(tag, "compressor");
    char text[200];
    snprintf(text, sizeof text, "a VTK file of %.100s", type ? type : "nothing");
    if (!type || strcmp(type, "UnstructuredGrid") != 0)
        return wrong(r, tag->begin, text, "UnstructuredGrid");
    r->style.big = order && !strcmp(order, "BigEndian");
    r->style.header = header && !strcmp(header, "UInt64") ? 8 : 4;
    r->style.zlib = compressor && *compressor;
    if (r->style.zlib && strcmp(compressor, "vtkZLibDataCompressor") != 0)
        return wrong(r, tag->begin, compressor, "data that is not compressed, or by vtkZLibDataCompressor");
    return 0;
}

static int take_piece(reader *r, const xml_tag *tag)
{
    const char *points = xml_value(tag, "NumberOfPoints"), *cells = xml_value(tag, "NumberOfCells");
    if (r->points >= 0)
        return wrong(r, tag->begin, "a second piece", "one");
    if (!points || !cells || num_int(points, 0, INT32_MAX, &r->points) || num_int(cells, 0, INT32_MAX, &r->cells))
        return wrong(r, tag->begin, "a piece without its counts", "NumberOfPoints and NumberOfCells");
    return 0;
}

static void copy_value(char *to, const xml_tag *tag, const char *key, const char *otherwise)
{
    const char *value = xml_value(tag, key);
    snprintf(to, XML_VALUE, "%s", value ? value : otherwise);
}

static int take_array(reader *r, const xml_tag *tag, section where)
{
    placed p = {.where = where, .a = {.components = 1, .offset = -1, .begin = r->x.at}};
    const char *components = xml_value(tag, "NumberOfComponents"), *offset = xml_value(tag, "offset");
    copy_value(p.a.name, tag, "Name", where == POINTS ? "Points" : "");
    copy_value(p.a.type, tag, "type", "");
    copy_value(p.a.format, tag, "format", "ascii");
    if (components && num_int(components, 1, 1000, &p.a.components))
        return wrong(r, tag->begin, "an invalid NumberOfComponents", "1 to 1000");
    if (offset && num_int(offset, 0, INT64_MAX, &p.a.offset))
        return wrong(r, tag->begin, "an invalid offset", "a number");
    for (r->lined = r->lined ? r->lined : r->x.text; r->lined < tag->begin; r->lined++)
        r->lines += *r->lined == '\n';
    p.a.line = 1 + r->lines;
    p.a.end = p.a.begin;
    if (!tag->closed) {
        const char *end = memchr(p.a.begin, '<', (size_t)(r->x.end - p.a.begin));
        if (!end)
            return wrong(r, tag->begin, "an array without an end", "</DataArray>");
        p.a.end = end;
    }
    if (MEM_ROOM(&r->arrays, &r->room, r->count + 1, "arrays", r->e))
        return -1;
    r->arrays[r->count++] = p;
    return 0;
}

/* What follows the underscore; its end is not looked for: raw data may hold anything. */
static int take_appended(reader *r, const xml_tag *tag)
{
    const char *encoding = xml_value(tag, "encoding"), *under;
    if (!encoding || (strcmp(encoding, "raw") != 0 && strcmp(encoding, "base64") != 0))
        return wrong(r, tag->begin, "appended data of another encoding", "raw or base64");
    under = memchr(r->x.at, '_', (size_t)(r->x.end - r->x.at));
    if (!under)
        return wrong(r, tag->begin, "appended data without its beginning", "an underscore");
    r->style.base64 = !strcmp(encoding, "base64");
    r->style.appended = under + 1;
    r->style.appended_end = r->x.end;
    return 0;
}

static section section_of(const char *name)
{
    static const char *const sections[] = {"", "Points", "Cells", "PointData", "CellData", "FieldData"};
    for (int i = 1; i < 6; i++)
        if (!strcmp(sections[i], name))
            return (section)i;
    return NOWHERE;
}

static int read_tags(reader *r)
{
    xml_tag tag;
    section now = NOWHERE;
    bool head = false;
    int got;
    while ((got = xml_next(&r->x, &tag, r->e)) > 0) {
        if (!head && strcmp(tag.name, "VTKFile") != 0)
            return wrong(r, tag.begin, "no VTK file", "<VTKFile type=\"UnstructuredGrid\">");
        int bad = 0;
        if (!strcmp(tag.name, "VTKFile")) {
            bad = take_head(r, &tag);
            head = true;
        } else if (!strcmp(tag.name, "Piece"))
            bad = take_piece(r, &tag);
        else if (!strcmp(tag.name, "DataArray") || !strcmp(tag.name, "Array"))
            bad = take_array(r, &tag, now);
        else if (!strcmp(tag.name, "AppendedData"))
            return take_appended(r, &tag);
        else if (tag.name[0] != '/' && section_of(tag.name) != NOWHERE)
            now = tag.closed ? NOWHERE : section_of(tag.name);
        else if (tag.name[0] == '/' && section_of(tag.name + 1) != NOWHERE)
            now = NOWHERE;
        if (bad)
            return -1;
    }
    return got;
}

/* ---- arrays */

static const xml_array *array_of(const reader *r, section where, const char *name)
{
    for (int64_t i = 0; i < r->count; i++)
        if (r->arrays[i].where == where && (!name || !strcmp(r->arrays[i].a.name, name)))
            return &r->arrays[i].a;
    return NULL;
}

/* NULL with e filled. */
static double *need(const reader *r, section where, const char *name, int64_t components, int64_t rows)
{
    const xml_array *a = array_of(r, where, name);
    if (!a) {
        err_set(r->e, r->x.name, 0, "no array %s; expected the points and cells of a grid", name ? name : "of points");
        return NULL;
    }
    if (a->components != components && rows >= 0) {
        err_set(r->e, r->x.name, a->line, "array %.100s has %lld components; expected %lld", a->name,
                (long long)a->components, (long long)components);
        return NULL;
    }
    return xml_numbers(&r->x, &r->style, a, rows * components, r->e);
}

static int read_points(reader *r)
{
    double *at = need(r, POINTS, NULL, 3, r->points);
    int bad = at ? 0 : -1;
    for (int64_t i = 0; !bad && i < r->points; i++)
        bad = import_add_node(r->m, at + 3 * i, r->e);
    free(at);
    return bad;
}

/* ---- cells */

enum { WEDGE = 13, PYRAMID = 14, VOXEL = 11, HEXAHEDRON = 12, TETRAHEDRON = 10 };

static const char *cell_words(int type)
{
    if (type == WEDGE)
        return "a wedge";
    if (type == PYRAMID)
        return "a pyramid";
    if (type >= 21 && type <= 37)
        return "of second order";
    return type >= 60 ? "of higher order" : "none that is read";
}

static int refuse_cell(const reader *r, int64_t cell, int type)
{
    const xml_array *a = array_of(r, CELLS, "types");
    return err_set(r->e, r->x.name, a->line, "cell %lld is %s (type %d); expected hexahedra (12) or tetrahedra (10)",
                   (long long)cell, cell_words(type), type);
}

/* Of fewer dimensions: vertices, lines, triangles, polygons, quadrangles, and those of second order. */
static bool is_lower(int type)
{
    return (type >= 1 && type <= 9) || (type >= 21 && type <= 23) || type == 28 || type == 30 || type == 34 ||
           type == 0;
}

static int take_cell(reader *r, int64_t cell, double kind, const double *corner, int64_t corners)
{
    static const int voxel[8] = {0, 1, 3, 2, 4, 5, 7, 6};
    const int type = kind >= 0 && kind < 256 ? (int)kind : 255;
    int32_t own[8];
    if (is_lower(type))
        return 0;
    if (type != HEXAHEDRON && type != TETRAHEDRON && type != VOXEL)
        return refuse_cell(r, cell, type);
    const int64_t expected = type == TETRAHEDRON ? 4 : 8;
    const int64_t line = array_of(r, CELLS, "connectivity")->line;
    if (corners != expected)
        return err_set(r->e, r->x.name, line, "cell %lld has %lld points; expected %lld", (long long)cell,
                       (long long)corners, (long long)expected);
    for (int64_t c = 0; c < corners; c++) {
        const double p = corner[type == VOXEL ? voxel[c] : c];
        if (!(p >= 0 && p < (double)r->points && p == floor(p)))
            return err_set(r->e, r->x.name, line, "cell %lld has a point %g; expected one of the %lld", (long long)cell,
                           p, (long long)r->points);
        own[c] = (int32_t)p;
    }
    if (MEM_ROOM(&r->cell, &r->cell_room, r->m->elements + 1, "elements", r->e))
        return -1;
    r->cell[r->m->elements] = cell;
    return import_add_element(r->m, own, (int32_t)corners, -1, line, r->e);
}

static int read_cells(reader *r)
{
    double *types = need(r, CELLS, "types", 1, r->cells), *corner = NULL;
    double *ends = types ? need(r, CELLS, "offsets", 1, r->cells) : NULL, last = 0;
    int bad = ends ? 0 : -1;
    for (int64_t i = 0; !bad && i < r->cells; i++) {
        if (!(ends[i] >= last && ends[i] < 9e15 && ends[i] == floor(ends[i])))
            bad = err_set(r->e, r->x.name, array_of(r, CELLS, "offsets")->line,
                          "cell %lld ends before it begins; expected offsets that rise", (long long)i);
        last = ends[i];
    }
    if (!bad && !(corner = need(r, CELLS, "connectivity", 1, (int64_t)last)))
        bad = -1;
    for (int64_t i = 0; !bad && i < r->cells; i++) {
        const int64_t from = i ? (int64_t)ends[i - 1] : 0;
        bad = take_cell(r, i, types[i], corner + from, (int64_t)ends[i] - from);
    }
    free(types);
    free(ends);
    free(corner);
    return bad;
}

/* ---- volumes */

/* The strings of an array. */
typedef struct word_list {
    char *text, **at; /* owned; at: in the text */
    int64_t count, room;
} word_list;

/* The i-th, or NULL where there is none or nothing in it. */
static char *word_at(const word_list *w, double i)
{
    char *word = i >= 0 && i < (double)w->count ? w->at[(int64_t)i] : NULL;
    return word && *word ? word : NULL;
}

/* Of the field data; none where there is no such array. */
static int read_words(const reader *r, const char *name, word_list *w)
{
    const xml_array *a = array_of(r, FIELD_DATA, name);
    size_t size = 0;
    if (!a || strcmp(a->type, "String") != 0)
        return 0;
    w->text = xml_strings(&r->x, &r->style, a, &size, r->e);
    for (char *p = w->text; p && p < w->text + size; p += strlen(p) + 1) {
        if (MEM_ROOM(&w->at, &w->room, w->count + 1, "names", r->e))
            return -1;
        w->at[w->count++] = p;
    }
    return w->text ? 0 : -1;
}

static void free_words(word_list *w)
{
    free(w->text);
    free(w->at);
}

/* The volume of that number. */
static int32_t volume_of(reader *r, double number, const word_list *words)
{
    char text[64], *name = word_at(words, number);
    snprintf(text, sizeof text, "volume%.15g", number);
    if (name)
        chars_mend(name);
    return import_add_volume(r->m, name ? name : text, r->e);
}

/* Of an array of cells: each kept element's volume is named by its number. */
static int read_volumes(reader *r)
{
    const bool by_volume = array_of(r, CELL_DATA, "volume") != NULL;
    const char *from = by_volume ? "volume" : "material";
    double *number, before = NAN;
    int32_t volume = -1;
    word_list words = {.count = 0};
    if (!array_of(r, CELL_DATA, from))
        return 0;
    number = need(r, CELL_DATA, from, 1, r->cells);
    const char *key = by_volume ? "volume.name" : "material.name";
    int bad = number ? read_words(r, key, &words) : -1;
    for (int64_t i = 0; !bad && i < r->m->elements; i++) {
        if (number[r->cell[i]] != before)
            volume = volume_of(r, number[r->cell[i]], &words);
        before = number[r->cell[i]];
        r->m->volume[i] = volume;
        bad = volume < 0 ? -1 : 0;
    }
    free(number);
    free_words(&words);
    return bad;
}

/* Which material a volume is of, by name: a VTU does not say what it is made of, so that only a table can. */
static int read_materials(reader *r)
{
    if (!r->w->own_materials) {
        notes_add(r->warnings, "a VTU holds no materials: all elements get the default; --materials gives others");
        return 0;
    }
    if (!array_of(r, CELL_DATA, "material") || !array_of(r, FIELD_DATA, "material.name"))
        return 0;
    double *number = need(r, CELL_DATA, "material", 1, r->cells);
    word_list words = {.count = 0};
    int bad = number ? read_words(r, "material.name", &words) : -1;
    for (int64_t i = 0; !bad && i < r->m->elements; i++) {
        import_volume *v = r->m->volume[i] < 0 ? NULL : &r->m->volumes[r->m->volume[i]];
        const double of = number[r->cell[i]];
        char *name = v && v->material < 0 ? word_at(&words, of) : NULL;
        if (!name)
            continue;
        chars_mend(name);
        v->material = import_add_material(r->m, name, 0, r->e);
        bad = v->material < 0 ? -1 : 0;
    }
    free(number);
    free_words(&words);
    return bad;
}

/* A direction of any length becomes one of length 1. One that sinew-model(5) takes is kept, so that an export reads
 * back to the last bit. 0 0 0 is none.
 */
static int take_direction(const reader *r, const xml_array *a, int64_t cell, const double *v, float *to)
{
    const double most = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (!(isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2])))
        return err_set(r->e, r->x.name, a->line, "cell %lld has %s %g %g %g; expected a direction, or 0 0 0",
                       (long long)cell, a->name, v[0], v[1], v[2]);
    if (most == 0) {
        to[0] = to[1] = to[2] = 0;
        return 0;
    }
    const double x = v[0] / most, y = v[1] / most, z = v[2] / most, length = sqrt(x * x + y * y + z * z);
    const bool kept = fabs(length * most - 1) < .999 * KNOWN_LENGTH; /* room for rounding to single precision */
    to[0] = (float)(kept ? v[0] : x / length);
    to[1] = (float)(kept ? v[1] : y / length);
    to[2] = (float)(kept ? v[2] : z / length);
    return 0;
}

/* The directions of a name, in *to, which is the mesh's; it stays NULL where there are none. */
static int read_directions(reader *r, const char *name, float **to)
{
    const xml_array *a = array_of(r, CELL_DATA, name);
    if (!a || a->components != 3)
        return 0;
    double *along = need(r, CELL_DATA, name, 3, r->cells);
    *to = along ? mem_array(r->m->elements, 3 * sizeof **to, "directions", r->e) : NULL;
    int bad = *to ? 0 : -1;
    for (int64_t i = 0; !bad && i < r->m->elements; i++)
        bad = take_direction(r, a, r->cell[i], &along[3 * r->cell[i]], *to + 3 * i);
    free(along);
    return bad;
}

/* ---- rigid nodes */

static int hold(reader *r, const char *name)
{
    double *number = need(r, POINT_DATA, name, 1, r->points);
    int bad = number ? import_need_rigid(r->m, r->e) : -1;
    for (int64_t i = 0; !bad && i < r->points; i++)
        r->m->rigid[i] |= number[i] != 0;
    free(number);
    return bad;
}

static int read_rigid(reader *r)
{
    const char **words = mem_array(r->count, sizeof *words, "arrays", r->e);
    int count = 0, bad = words ? 0 : -1;
    for (int64_t i = 0; words && i < r->count; i++)
        if (r->arrays[i].where == POINT_DATA)
            words[count++] = r->arrays[i].a.name;
    for (int i = 0; !bad && i < r->w->rigids; i++)
        bad = array_of(r, POINT_DATA, r->w->rigid[i])
                  ? hold(r, r->w->rigid[i])
                  : near_option(r->e, "--rigid", "array of points", r->w->rigid[i], words, count);
    free(words);
    if (!bad && array_of(r, POINT_DATA, "rigid"))
        bad = hold(r, "rigid");
    return bad;
}

static int read_all(reader *r)
{
    if (read_tags(r))
        return -1;
    if (r->points < 0)
        return err_set(r->e, r->x.name, 0, "no piece; expected one with points and cells");
    return read_points(r) || read_cells(r) || read_volumes(r) || read_materials(r) ||
                   read_directions(r, "fibre", &r->m->fibre) || read_directions(r, "normal", &r->m->normal) ||
                   read_rigid(r)
               ? -1
               : 0;
}

int import_vtu(import_mesh *m, in *s, const import_wishes *wishes, notes *warnings, err *e)
{
    char *text = NULL;
    int64_t size = in_peek(s, e) == -2 ? -1 : in_all(s, &text, e); /* a byte order mark goes */
    if (size < 0)
        return -1;
    reader r = {.m = m,
                .w = wishes,
                .warnings = warnings,
                .e = e,
                .x = {.name = m->name, .what = "VTK's XML", .text = text, .at = text, .end = text + size},
                .points = -1};
    int bad = read_all(&r);
    free(r.arrays);
    free(r.cell);
    free(text);
    return bad;
}
