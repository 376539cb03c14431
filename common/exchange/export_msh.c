#include "exchange/export_msh.h"

#include "base/num.h"

#include <inttypes.h>

enum { POINT = 15, TETRAHEDRON = 4, HEXAHEDRON = 5 };

/* Each node's number and three of its own. */
static void put_rows(const double *value, int64_t rows, out *to)
{
    char text[NUM_TEXT];
    for (int64_t i = 0; i < rows; i++) {
        out_format(to, "%" PRId64, i + 1);
        for (int a = 0; a < 3; a++) {
            num_text(value[3 * i + a], false, text);
            out_format(to, " %s", text);
        }
        out_text(to, "\n");
    }
}

/* A name as it can stand between quotes on a line. */
static void put_name(const char *name, out *to)
{
    for (const char *p = name; *p; p++)
        if (*p == '"')
            out_text(to, "'");
        else
            out_write(to, (unsigned char)*p < ' ' ? " " : p, 1);
}

static int64_t count_rigid(const model_array *rigid)
{
    int64_t count = 0;
    for (int64_t i = 0; rigid && i < rigid->rows; i++)
        count += rigid->u8[i] != 0;
    return count;
}

static void put_groups(const model_array *name, bool rigid, out *to)
{
    const int64_t volumes = name ? name->rows : 0;
    if (!volumes && !rigid)
        return;
    out_format(to, "$PhysicalNames\n%" PRId64 "\n", volumes + rigid);
    for (int64_t v = 0; v < volumes; v++) {
        out_format(to, "3 %" PRId64 " \"", v + 1);
        put_name(name->str[v], to);
        out_text(to, "\"\n");
    }
    if (rigid)
        out_format(to, "0 %" PRId64 " \"rigid\"\n", volumes + 1);
    out_text(to, "$EndPhysicalNames\n");
}

static void put_elements(const export_shape *x, const model_array *volume, const model_array *rigid, int64_t group,
                         out *to)
{
    int64_t corners, number = 0;
    out_format(to, "$Elements\n%" PRId64 "\n", x->cells + count_rigid(rigid));
    for (int64_t i = 0; i < x->cells; i++) {
        const int32_t *node = export_shape_cell(x, i, &corners);
        const int64_t of = volume ? volume->i32[i] + 1 : 0;
        out_format(to, "%" PRId64 " %d 2 %" PRId64 " %" PRId64, ++number, corners == 8 ? HEXAHEDRON : TETRAHEDRON, of,
                   of ? of : 1);
        for (int64_t c = 0; c < corners; c++)
            out_format(to, " %" PRId64, (int64_t)node[c] + 1);
        out_text(to, "\n");
    }
    for (int64_t i = 0; rigid && i < rigid->rows; i++)
        if (rigid->u8[i])
            out_format(to, "%" PRId64 " %d 2 %" PRId64 " %" PRId64 " %" PRId64 "\n", ++number, POINT, group, group,
                       i + 1);
    out_text(to, "$EndElements\n");
}

void export_msh(const export_shape *x, out *to)
{
    const model_array *volume = model_find(x->m, "element.volume"), *rigid = model_find(x->m, "node.rigid");
    const model_array *name = volume ? model_find(x->m, "volume.name") : NULL;
    out_text(to, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
    put_groups(name, count_rigid(rigid) > 0, to);
    out_format(to, "$Nodes\n%" PRId64 "\n", x->points);
    put_rows(x->rest, x->points, to);
    out_text(to, "$EndNodes\n");
    put_elements(x, volume, rigid, (name ? name->rows : 0) + 1, to);
}

void export_msh_frame(const export_shape *x, out *to)
{
    char time[NUM_TEXT];
    if (!x->displacement)
        return;
    num_text(x->f->time, false, time);
    out_format(to, "$NodeData\n1\n\"displacement\"\n1\n%s\n3\n%" PRId64 "\n3\n%" PRId64 "\n", time, x->f->index,
               x->points);
    put_rows(x->displacement, x->points, to);
    out_text(to, "$EndNodeData\n");
}
