#include "slice/image/slice_mesh.h"

#include "base/mem.h"
#include "model/finite.h"
#include "slice/image/slice_lanes.h"

#include <stdlib.h>
#include <string.h>

static void sort_four(int32_t n[4])
{
    for (int i = 1; i < 4; i++)
        for (int j = i; j > 0 && n[j - 1] > n[j]; j--) {
            int32_t other = n[j];
            n[j] = n[j - 1];
            n[j - 1] = other;
        }
}

/* The nodes of tetrahedra [from, to), each once, to `list`; returns how many. */
static int64_t nodes_of(const slice_mesh *s, int64_t from, int64_t to, int32_t *list)
{
    int64_t count = 0;
    for (int64_t i = 4 * from; i < 4 * to; i++) {
        int64_t k = 0;
        while (k < count && list[k] != s->node[i])
            k++;
        list[k] = s->node[i];
        count += k == count;
    }
    return count;
}

static int make_groups(slice_mesh *s, err *e)
{
    const int64_t groups = (s->tets + SLICE_GROUP - 1) / SLICE_GROUP;
    s->start = mem_array(groups + 1, sizeof *s->start, "tetrahedra", e);
    s->group = s->start ? mem_array(s->tets * 4, sizeof *s->group, "tetrahedra", e) : NULL;
    for (int64_t g = 0; s->group && g < groups; g++) {
        const int64_t from = g * SLICE_GROUP, to = from + SLICE_GROUP < s->tets ? from + SLICE_GROUP : s->tets;
        s->start[g + 1] = s->start[g] + nodes_of(s, from, to, s->group + s->start[g]);
    }
    return s->group ? 0 : -1;
}

int slice_mesh_of(slice_mesh *s, const model *m, const slice_cells *c, const char *where, err *e)
{
    *s = (slice_mesh){0};
    const model_array *node = model_need(m, "element.node", e), *rest = model_need(m, "node.position", e);
    if (!node || !rest || finite_elements(m, where, e))
        return -1;
    if (node->columns != 4)
        return err_set(e, where, 0, "elements of %d nodes; expected tetrahedra, as msds-mesh makes them",
                       (int)node->columns);
    s->nodes = rest->rows;
    s->tets = node->rows;
    s->rest = rest->f64;
    s->node = mem_array(s->tets * 4, sizeof *s->node, "tetrahedra", e);
    s->place = s->node ? mem_array(s->nodes * 3, sizeof *s->place, "nodes", e) : NULL;
    if (!s->place)
        return -1;
    memcpy(s->node, node->i32, (size_t)s->tets * 4 * sizeof *s->node);
    for (int64_t i = 0; i < s->tets; i++)
        sort_four(s->node + 4 * i);
    for (int64_t n = 0; n < s->nodes; n++)
        slice_cells_place(c, s->rest + 3 * n, s->place + 3 * n);
    return make_groups(s, e);
}

void slice_mesh_free(slice_mesh *s)
{
    free(s->node);
    free(s->group);
    free(s->start);
    free(s->place);
    *s = (slice_mesh){0};
}
