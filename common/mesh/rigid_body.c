#include "mesh/rigid_body.h"

#include "base/chars.h"
#include "base/near.h"

int32_t rigid_body_find(const model *m, const char *name, const char *place, int64_t line, err *e)
{
    const model_array *names = model_find(m, "body.name");
    if (!names || !model_find(m, "node.body"))
        return err_set(e, place, line, "'%.200s': the model has no rigid bodies; expected some from attach --part",
                       name);
    for (int64_t i = 0; i < names->rows; i++)
        if (chars_mean(name, names->str[i]))
            return (int32_t)i;
    return near_unknown(e, place, line, "body", name, (const char *const *)names->str,
                        names->rows < INT32_MAX ? (int)names->rows : INT32_MAX);
}

pose rigid_body_pose(const frame *f, int32_t body)
{
    const model_array *at = f ? frame_find(f, "body.pose") : NULL;
    if (!at || at->type != MODEL_F64 || at->columns != 7 || body >= at->rows)
        return pose_none();
    return pose_of_row(at->f64 + 7 * (int64_t)body);
}
