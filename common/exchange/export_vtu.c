#include "exchange/export_vtu.h"

#include "base/mem.h"
#include "base/num.h"
#include "mesh/quality.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { BLOCK = 1 << 20 }; /* bytes compressed at a time */

/* Cell types of VTK. */
enum {
    VTK_VERTEX = 1,
    VTK_LINE = 3,
    VTK_TRIANGLE = 5,
    VTK_POLYGON = 7,
    VTK_QUAD = 9,
    VTK_TETRA = 10,
    VTK_HEXAHEDRON = 12
};

static const char *const vtk_types[MODEL_TYPES] = {"Float32", "Float64", "Int32", "Int64", "UInt8", "String"};

typedef struct writer {
    const export_shape *x;
    out *xml, *data; /* the data is appended after the XML, which tells where in it each array begins */
} writer;

/* Frees o, which may be NULL. -1 with e filled where it lacked memory, and what was taken from it is short. */
static int close_memory(out *o, err *e)
{
    return o ? out_close(o, e) : -1;
}

/* Compresses a block into `packed` and notes its size. */
static int pack(const unsigned char *bytes, size_t size, out *packed, uint64_t *packed_size, err *e)
{
    uLongf length = compressBound(size);
    unsigned char *buffer = mem_array((int64_t)length, 1, "compressed data", e);
    if (!buffer)
        return -1;
    int code = compress2(buffer, &length, bytes, size, Z_DEFAULT_COMPRESSION);
    if (code == Z_OK)
        out_write(packed, buffer, length);
    free(buffer);
    *packed_size = length;
    return code == Z_OK ? 0 : err_set(e, NULL, 0, "zlib failed to compress");
}

/* Appends bytes as VTK lays compressed data out: count of blocks, size of a block, size of the last one where it is
 * short (else 0), each block's packed size; then the blocks. */
static int append(writer *w, const void *bytes, size_t size, err *e)
{
    size_t blocks = (size + BLOCK - 1) / BLOCK;
    uint64_t *head = mem_array((int64_t)blocks + 3, sizeof *head, "compressed data", e);
    out *packed = head ? out_memory(e) : NULL;
    int bad = packed ? 0 : -1;
    for (size_t i = 0; !bad && i < blocks; i++) {
        size_t from = i * BLOCK, n = size - from < BLOCK ? size - from : BLOCK;
        bad = pack((const unsigned char *)bytes + from, n, packed, &head[3 + i], e);
    }
    if (!bad) {
        size_t packed_size;
        const unsigned char *all = out_bytes(packed, &packed_size);
        head[0] = blocks;
        head[1] = BLOCK;
        head[2] = size % BLOCK;
        out_write(w->data, head, (blocks + 3) * sizeof *head);
        out_write(w->data, all, packed_size);
    }
    free(head);
    return close_memory(packed, e) || bad ? -1 : 0;
}

/* One DataArray element and its data. tuples < 0: not said (the piece says it). */
static int put_data(writer *w, const char *name, model_type type, int columns, int64_t tuples, const void *bytes,
                    size_t size, err *e)
{
    out_format(w->xml, "<DataArray type=\"%s\" Name=\"%s\"", vtk_types[type], name);
    if (columns > 1)
        out_format(w->xml, " NumberOfComponents=\"%d\"", columns);
    if (tuples >= 0)
        out_format(w->xml, " NumberOfTuples=\"%" PRId64 "\"", tuples);
    out_format(w->xml, " format=\"appended\" offset=\"%" PRId64 "\"/>\n", out_count(w->data));
    return append(w, bytes, size, e);
}

/* Without its axis, where it begins with that. */
static const char *data_name(const model_array *a)
{
    size_t n = strlen(a->axis);
    return !strncmp(a->name, a->axis, n) && a->name[n] == '.' ? a->name + n + 1 : a->name;
}

static int put_array(writer *w, const model_array *a, err *e)
{
    return put_data(w, data_name(a), a->type, a->columns, -1, a->data,
                    (size_t)a->rows * (size_t)a->columns * model_type_size(a->type), e);
}

/* What VTK has a place of its own for is not data too; strings are only in field data. */
static bool is_data(const writer *w, const model_array *a, const char *axis)
{
    static const char *const places[] = {".position", ".node", ".start", ".displacement"};
    if (strcmp(a->axis, axis) != 0 || a->type == MODEL_STR)
        return false;
    size_t n = strlen(axis);
    for (int i = 0; i < 4; i++)
        if (!strncmp(a->name, axis, n) && !strcmp(a->name + n, places[i]) && (i < 3 || w->x->displacement))
            return false;
    return true;
}

/* All arrays over an axis, the frame's before the body's of the same name. */
static int put_arrays(writer *w, const char *axis, err *e)
{
    const model_arrays *list[2] = {w->x->f ? &w->x->f->arrays : NULL, &w->x->m->arrays};
    for (int l = 0; l < 2; l++)
        for (int i = 0; list[l] && i < list[l]->count; i++) {
            const model_array *a = &list[l]->v[i];
            bool replaced = l && w->x->f && frame_find(w->x->f, a->name);
            if (is_data(w, a, axis) && !replaced && put_array(w, a, e))
                return -1;
        }
    return 0;
}

/* Whether put_arrays puts one by this name: what we compute must not stand twice. */
static bool has_data(const writer *w, const char *axis, const char *name)
{
    const model_arrays *list[2] = {w->x->f ? &w->x->f->arrays : NULL, &w->x->m->arrays};
    bool has = false;
    for (int l = 0; l < 2; l++)
        for (int i = 0; list[l] && i < list[l]->count; i++)
            has |= is_data(w, &list[l]->v[i], axis) && !strcmp(data_name(&list[l]->v[i]), name);
    return has;
}

/* A string array: each string with its NUL. */
static int put_strings(writer *w, const model_array *a, err *e)
{
    out *text = out_memory(e);
    if (!text)
        return -1;
    size_t size;
    for (int64_t i = 0; i < a->rows * a->columns; i++)
        out_write(text, a->str[i], strlen(a->str[i]) + 1);
    const unsigned char *bytes = out_bytes(text, &size);
    int bad = put_data(w, a->name, MODEL_STR, a->columns, a->rows, bytes, size, e);
    return close_memory(text, e) || bad ? -1 : 0;
}

static int put_field_data(writer *w, err *e)
{
    static const char *const names[] = {"volume.name", "material.name", "anchor.name"};
    out_text(w->xml, "<FieldData>\n");
    if (w->x->f && put_data(w, "TimeValue", MODEL_F64, 1, 1, &w->x->f->time, sizeof w->x->f->time, e))
        return -1;
    for (int i = 0; i < (w->x->is_surface ? 1 : 3); i++) {
        const model_array *a =
            w->x->is_surface ? surface_part(w->x->m, w->x->s.name, "group.name") : model_find(w->x->m, names[i]);
        if (a && a->rows && put_strings(w, a, e))
            return -1;
    }
    out_text(w->xml, "</FieldData>\n");
    return 0;
}

static int put_point_data(writer *w, err *e)
{
    const export_shape *x = w->x;
    out_format(w->xml, "<PointData%s>\n", x->displacement ? " Vectors=\"displacement\"" : "");
    if (x->displacement && put_data(w, "displacement", MODEL_F64, 3, -1, x->displacement,
                                    3 * (size_t)x->points * sizeof *x->displacement, e))
        return -1;
    if (put_arrays(w, x->point_axis, e))
        return -1;
    out_text(w->xml, "</PointData>\n");
    return 0;
}

/* Each element's material, which the model has by volume. */
static int put_material(writer *w, err *e)
{
    const model_array *volume = model_find(w->x->m, "element.volume"), *of = model_find(w->x->m, "volume.material");
    if (!volume || !of || w->x->is_surface || has_data(w, w->x->cell_axis, "material"))
        return 0;
    int32_t *material = mem_array(volume->rows, sizeof *material, "materials", e);
    if (!material)
        return -1;
    for (int64_t i = 0; i < volume->rows; i++)
        material[i] = of->i32[volume->i32[i]];
    int bad = put_data(w, "material", MODEL_I32, 1, -1, material, (size_t)volume->rows * sizeof *material, e);
    free(material);
    return bad;
}

/* J of each element where a frame moves it: in the middle, and the smallest at its corners. */
static int put_quality(writer *w, err *e)
{
    const export_shape *x = w->x;
    static const char *const names[] = {"quality.j.centre", "quality.j.corner"};
    if (x->is_surface || !x->displacement)
        return 0;
    const quality_mesh mesh = {x->node->i32, x->node->columns, x->cells, x->rest, NULL};
    double *j = mem_array(2 * x->cells, sizeof *j, "J of elements", e);
    if (!j)
        return -1;
    for (int64_t i = 0; i < x->cells; i++) {
        const quality_j of = quality_of(&mesh, i, x->displacement);
        j[i] = of.centre;
        j[x->cells + i] = of.corner;
    }
    const size_t size = (size_t)x->cells * sizeof *j;
    int bad = 0;
    for (int i = 0; !bad && i < 2; i++)
        if (!has_data(w, x->cell_axis, names[i]))
            bad = put_data(w, names[i], MODEL_F64, 1, -1, j + i * x->cells, size, e);
    free(j);
    return bad;
}

static int put_cell_data(writer *w, err *e)
{
    bool volumes = !w->x->is_surface && model_find(w->x->m, "element.volume");
    out_format(w->xml, "<CellData%s>\n", volumes ? " Scalars=\"volume\"" : "");
    if (put_arrays(w, w->x->cell_axis, e) || put_material(w, e) || put_quality(w, e))
        return -1;
    out_text(w->xml, "</CellData>\n");
    return 0;
}

static int put_points(writer *w, bool deformed, err *e)
{
    const export_shape *x = w->x;
    double *at = mem_array(3 * x->points, sizeof *at, "points", e);
    if (!at)
        return -1;
    for (int64_t i = 0; i < x->points; i++)
        export_shape_point(x, i, deformed, &at[3 * i]);
    out_text(w->xml, "<Points>\n");
    int bad = put_data(w, "Points", MODEL_F64, 3, -1, at, 3 * (size_t)x->points * sizeof *at, e);
    out_text(w->xml, "</Points>\n");
    free(at);
    return bad;
}

static uint8_t cell_type(const export_shape *x, int64_t corners)
{
    if (!x->is_surface)
        return corners == 8 ? VTK_HEXAHEDRON : VTK_TETRA;
    static const uint8_t of_corners[] = {VTK_POLYGON, VTK_VERTEX, VTK_LINE, VTK_TRIANGLE, VTK_QUAD};
    return corners <= 4 ? of_corners[corners] : VTK_POLYGON;
}

static int put_cells(writer *w, err *e)
{
    const export_shape *x = w->x;
    int64_t *end = mem_array(x->cells, sizeof *end, "cells", e), sum = 0, corners;
    uint8_t *type = end ? mem_array(x->cells, sizeof *type, "cells", e) : NULL;
    if (!type) {
        free(end);
        return -1;
    }
    for (int64_t i = 0; i < x->cells; i++) {
        export_shape_cell(x, i, &corners);
        end[i] = sum += corners;
        type[i] = cell_type(x, corners);
    }
    /* The corners lie one cell after another already. */
    const int32_t *first = x->cells ? export_shape_cell(x, 0, &corners) : NULL;
    out_text(w->xml, "<Cells>\n");
    int bad = put_data(w, "connectivity", MODEL_I32, 1, -1, first, (size_t)x->corners * sizeof *first, e) ||
              put_data(w, "offsets", MODEL_I64, 1, -1, end, (size_t)x->cells * sizeof *end, e) ||
              put_data(w, "types", MODEL_U8, 1, -1, type, (size_t)x->cells, e);
    out_text(w->xml, "</Cells>\n");
    free(end);
    free(type);
    return bad ? -1 : 0;
}

static int put_grid(writer *w, bool deformed, err *e)
{
    out_text(w->xml, "<UnstructuredGrid>\n");
    if (put_field_data(w, e))
        return -1;
    out_format(w->xml, "<Piece NumberOfPoints=\"%" PRId64 "\" NumberOfCells=\"%" PRId64 "\">\n", w->x->points,
               w->x->cells);
    if (put_point_data(w, e) || put_cell_data(w, e) || put_points(w, deformed, e) || put_cells(w, e))
        return -1;
    out_text(w->xml, "</Piece>\n</UnstructuredGrid>\n");
    return 0;
}

static void copy(out *from, out *to)
{
    size_t size;
    const unsigned char *bytes = out_bytes(from, &size);
    out_write(to, bytes, size);
}

int export_vtu(const export_shape *x, bool deformed, out *to, err *e)
{
    writer w = {.x = x, .xml = out_memory(e)};
    w.data = w.xml ? out_memory(e) : NULL;
    int bad = w.data ? put_grid(&w, deformed, e) : -1;
    if (!bad) {
        /* binary.c is why: no other machine compiles this. */
        out_text(to, "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
                     "byte_order=\"LittleEndian\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n");
        copy(w.xml, to);
        out_text(to, "<AppendedData encoding=\"raw\">\n_");
        copy(w.data, to);
        out_text(to, "\n</AppendedData>\n</VTKFile>\n");
    }
    bad |= close_memory(w.xml, e);
    bad |= close_memory(w.data, e);
    return bad;
}

void export_pvd_begin(out *to)
{
    out_text(to, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n");
}

void export_pvd_add(out *to, double time, const char *file)
{
    char number[NUM_TEXT];
    num_text(time, false, number);
    out_format(to, "<DataSet timestep=\"%s\" group=\"\" part=\"0\" file=\"", number);
    for (const char *p = file; *p; p++)
        if (*p == '&' || *p == '<' || *p == '>' || *p == '"')
            out_format(to, "&#%d;", *p);
        else
            out_write(to, p, 1);
    out_text(to, "\"/>\n");
}

void export_pvd_end(out *to)
{
    out_text(to, "</Collection>\n</VTKFile>\n");
}
