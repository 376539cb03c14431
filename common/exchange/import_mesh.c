#include "exchange/import_mesh.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

int import_add_node(import_mesh *m, const double *position, err *e)
{
    if (m->nodes == INT32_MAX)
        return err_set(e, m->name, 0, "more than %d nodes", INT32_MAX);
    if (MEM_ROOM(&m->position, &m->position_room, 3 * (m->nodes + 1), "nodes", e))
        return -1;
    memcpy(m->position + 3 * m->nodes++, position, 3 * sizeof *position);
    return 0;
}

int import_add_element(import_mesh *m, const int32_t *corner, int32_t columns, int32_t volume, int64_t line, err *e)
{
    if (m->columns && m->columns != columns)
        return err_set(e, m->name, line,
                       "an element of %d nodes among elements of %d; expected hexahedra alone or tetrahedra alone",
                       columns, m->columns);
    m->columns = columns;
    if (m->elements == INT32_MAX / 8)
        return err_set(e, m->name, line, "more than %d elements", INT32_MAX / 8);
    if (MEM_ROOM(&m->corner, &m->corner_room, columns * (m->elements + 1), "elements", e) ||
        MEM_ROOM(&m->volume, &m->volume_room, m->elements + 1, "elements", e) ||
        MEM_ROOM(&m->line, &m->line_room, m->elements + 1, "elements", e))
        return -1;
    memcpy(m->corner + columns * m->elements, corner, (size_t)columns * sizeof *corner);
    m->volume[m->elements] = volume;
    m->line[m->elements++] = line;
    return 0;
}

int32_t import_add_volume(import_mesh *m, const char *name, err *e)
{
    for (int64_t i = m->volume_names.count; i < m->volume_count; i++)
        if (names_number(&m->volume_names, m->volumes[i].name, e) < 0)
            return -1;
    const int32_t at = names_find(&m->volume_names, name);
    if (at >= 0)
        return at;
    if (MEM_ROOM(&m->volumes, &m->volumes_room, m->volume_count + 1, "volumes", e))
        return -1;
    m->volumes[m->volume_count] = (import_volume){mem_text(name, e), -1};
    return m->volumes[m->volume_count].name ? (int32_t)m->volume_count++ : -1;
}

int32_t import_add_material(import_mesh *m, const char *name, int64_t line, err *e)
{
    for (int64_t i = m->material_names.count; i < m->materials; i++)
        if (names_number(&m->material_names, m->material[i].name, e) < 0)
            return -1;
    const int32_t at = names_find(&m->material_names, name);
    if (at >= 0)
        return at;
    if (MEM_ROOM(&m->material, &m->material_room, m->materials + 1, "materials", e))
        return -1;
    m->material[m->materials] = (import_material){.name = mem_text(name, e), .of = {.density = NAN}, .line = line};
    return m->material[m->materials].name ? (int32_t)m->materials++ : -1;
}

int import_need_rigid(import_mesh *m, err *e)
{
    if (!m->rigid)
        m->rigid = mem_array(m->nodes, 1, "rigid nodes", e);
    return m->rigid ? 0 : -1;
}

int import_resolve(import_mesh *m, err *e)
{
    for (int64_t i = 0; i < m->elements * m->columns; i++) {
        int32_t node = import_ids_find(&m->node_id, m->corner[i]);
        if (node < 0)
            return err_set(e, m->name, m->line[i / m->columns], "no node has the number %d; expected one that is given",
                           m->corner[i]);
        m->corner[i] = node;
    }
    return 0;
}

void import_free(import_mesh *m)
{
    for (int64_t i = 0; i < m->volume_count; i++)
        free(m->volumes[i].name);
    for (int64_t i = 0; i < m->materials; i++) {
        free(m->material[i].name);
        free(m->material[i].written);
    }
    names_free(&m->volume_names);
    names_free(&m->material_names);
    import_ids_free(&m->node_id);
    free(m->position);
    free(m->corner);
    free(m->volume);
    free(m->line);
    free(m->fibre);
    free(m->normal);
    free(m->volumes);
    free(m->material);
    free(m->rigid);
    *m = (import_mesh){.name = m->name};
}
