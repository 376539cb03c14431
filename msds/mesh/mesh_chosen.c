#include "msds/mesh/mesh_chosen.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/near.h"
#include "base/num.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

bool mesh_chosen_has(const mesh_chosen *c, int64_t value)
{
    for (int i = 0; i < c->count; i++)
        if (c->value[i] == value)
            return true;
    return false;
}

static int unknown_label(const volume *labels, const char *option, const char *name, err *e)
{
    const char **list = mem_array(labels->labels, sizeof *list, "names", e);
    for (int i = 0; list && i < labels->labels; i++)
        list[i] = labels->label[i].name;
    if (list)
        near_option(e, option, "label", name, list, labels->labels);
    free(list);
    return -1;
}

int mesh_chosen_add(mesh_chosen *c, const volume *labels, const char *option, const char *name, err *e)
{
    const int before = c->count;
    int64_t value;
    if (c->count == MESH_CHOSEN)
        return err_usage(e, "%s: more than %d labels; expected fewer, or ones of fewer names", option, MESH_CHOSEN);
    if (!num_int(name, INT64_MIN, INT64_MAX, &value)) {
        c->value[c->count++] = value;
        return 0;
    }
    for (int i = 0; i < labels->labels && c->count < MESH_CHOSEN; i++)
        if (chars_mean(name, labels->label[i].name))
            c->value[c->count++] = labels->label[i].value;
    return c->count > before ? 0 : unknown_label(labels, option, name, e);
}

int mesh_chosen_read(const volume *labels, int64_t voxel, const char *where, int64_t *to, err *e)
{
    const double value = voxel < 0 ? 0 : volume_value(labels, voxel);
    *to = 0;
    if (!(fabs(value) <= 9e15) || fabs(value - floor(value)) > 0)
        return err_set(e, where, 0, "voxel %" PRId64 " is %g; expected labels, which are whole numbers", voxel, value);
    *to = (int64_t)value;
    return 0;
}
