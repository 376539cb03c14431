#include "model/model_share.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

static int share_array(model_arrays *to, const model_array *from, err *e)
{
    model_array a = *from;
    a.lent = true;
    a.name = mem_text(from->name, e);
    a.unit = mem_text(from->unit, e);
    a.axis = mem_text(from->axis, e);
    if (a.name && a.unit && a.axis && model_arrays_take(to, &a, e))
        return 0;
    model_array_free(&a);
    return -1;
}

static int share_arrays(model_arrays *to, const model_arrays *from, err *e)
{
    for (int i = 0; i < from->count; i++)
        if (share_array(to, &from->v[i], e))
            return -1;
    return 0;
}

/* "TOOL VERSION OPTIONS", or without the third. */
static int copy_line(model *to, const char *line, err *e)
{
    char *tool = mem_text(line, e), *version = tool ? strchr(tool, ' ') : NULL;
    char *options = version ? strchr(version + 1, ' ') : NULL;
    if (version)
        *version++ = '\0';
    if (options)
        *options++ = '\0';
    const int failed = version ? model_prov_add(to, tool, version, options ? options : "", e) : -1;
    free(tool);
    return failed;
}

static int copy_provenance(model *to, const model *from, err *e)
{
    for (int i = 0; i < from->provs; i++)
        if (copy_line(to, from->prov[i], e))
            return -1;
    return 0;
}

static int copy_blocks(model *to, const model *from, err *e)
{
    for (int i = 0; i < from->block_count; i++) {
        model_block b = from->blocks[i];
        b.payload = mem_array((int64_t)b.length, 1, "the model", e);
        if (!b.payload)
            return -1;
        memcpy(b.payload, from->blocks[i].payload, b.length);
        if (model_block_take(to, &b, e)) {
            free(b.payload);
            return -1;
        }
    }
    return 0;
}

int model_share(model *to, const model *from, err *e)
{
    for (int i = 0; i < from->metas; i++)
        if (model_meta_set(to, from->meta[i].key, from->meta[i].value, e))
            return -1;
    for (int i = 0; i < from->axis_count; i++)
        if (model_axis_add(to, from->axes[i].name, from->axes[i].count, e))
            return -1;
    if (copy_provenance(to, from, e) || share_arrays(&to->arrays, &from->arrays, e) || copy_blocks(to, from, e))
        return -1;
    to->stream = from->stream ? mem_text(from->stream, e) : NULL;
    return from->stream && !to->stream ? -1 : 0;
}

int frame_share(frame *to, const frame *from, err *e)
{
    to->index = from->index;
    to->time = from->time;
    return share_arrays(&to->arrays, &from->arrays, e);
}
