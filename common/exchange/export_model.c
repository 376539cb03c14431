#include "exchange/export_model.h"

int export_model(source *from, const char *path, bool salvage, stage *to, const tool *t, err *e)
{
    int got;
    if (stage_open_output(to, t, e) || source_open_part(from, path, salvage, e))
        return -1;
    if (salvage && model_prov_add(&from->body, t->table->name, SINEW_VERSION, "--salvage", e))
        return -1;
    if (model_write(to->writer, &from->body, e))
        return -1;
    while ((got = source_next(from, e)) > 0)
        if (model_write_frame(to->writer, &from->frame, e))
            return -1;
    return got;
}
