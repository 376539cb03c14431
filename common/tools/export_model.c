#include "tools/export_model.h"

int export_model(source *from, const char *path, stage *to, const tool *t, err *e)
{
    int got;
    if (stage_open_output(to, t, e) || source_open(from, path, e) || model_write(to->writer, &from->body, e))
        return -1;
    while ((got = source_next(from, e)) > 0)
        if (model_write_frame(to->writer, &from->frame, e))
            return -1;
    return got;
}
