/* For the fuzz targets of sinew import: any bytes as a mesh are a model whose arrays keep sinew-model(5)'s rules, of
 * elements with an inside, or one error with a text.
 */
#ifndef SINEW_MESH_BYTES_H
#define SINEW_MESH_BYTES_H

#include "base/in.h"
#include "exchange/import_mesh.h"

#include <stdlib.h>
#include <string.h>

typedef int mesh_reader(import_mesh *m, in *s, const import_wishes *w, notes *warnings, err *e);

static inline void mesh_check(const model *m)
{
    for (int i = 0; i < m->arrays.count; i++) {
        err e = {0};
        if (model_check(m, &m->arrays.v[i], "fuzz", 0, &e))
            abort();
    }
    const model_array *node = model_find(m, "element.node");
    if (!node || !node->rows || (node->columns != 8 && node->columns != 4))
        abort();
    for (int64_t i = 0; i < node->rows * node->columns; i++)
        if (node->i32[i] < 0 || node->i32[i] >= model_count(m, "node"))
            abort();
}

static inline void mesh_bytes(mesh_reader *reads, const uint8_t *data, size_t size)
{
    static const char *const rigid[] = {"rigid", "low"};
    import_wishes w = {.scale = 1, .stress = 1, .density = 1, .volume = "tissue", .rigid = rigid};
    import_mesh mesh = {.name = "fuzz"};
    model m = {0};
    notes warnings = {0};
    err e = {0};
    w.rigids = size % 3 == 2 ? 2 : 0;
    in *s = in_memory(data, size, "fuzz", &e);
    int bad = !s || reads(&mesh, s, &w, &warnings, &e) || import_build(&mesh, &w, &m, &warnings, &e);
    if (bad != (e.status != 0) || (bad && !e.text[0]))
        abort();
    if (!bad)
        mesh_check(&m);
    in_close(s);
    notes_free(&warnings);
    import_free(&mesh);
    model_free(&m);
}

#endif
