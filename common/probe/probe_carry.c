#include "probe/probe_carry.h"

#include "base/chars.h"
#include "base/mem.h"
#include "surface/scale.h"

#include <string.h>

int probe_read(probe *p, const char *text, const char *unit, bool anonymous, const model *m, err *e)
{
    if (probe_of(p, text, e))
        return -1;
    if (p->kind != PROBE_CONVEX)
        return 0;
    const num_unit of_file = scale_unit(unit, m, e);
    if (!of_file || probe_load(p, scale_of(of_file), e))
        return -1;
    if (anonymous)
        p->file = "FILE.obj";
    return 0;
}

static int carry_convex(const probe *p, model *m, err *e)
{
    if (model_axis_add(m, "probe-vertex", p->corners, e) || model_axis_add(m, "probe-face", p->faces, e))
        return -1;
    model_array *corner = model_add(m, "probe-vertex.position", e);
    if (corner)
        memcpy(corner->f64, p->corner, 3 * (size_t)p->corners * sizeof *p->corner);
    model_array *face = corner ? model_add(m, "probe-face.vertex", e) : NULL;
    if (face)
        memcpy(face->i32, p->face, 3 * (size_t)p->faces * sizeof *p->face);
    return face ? 0 : -1;
}

int probe_carry(const probe *p, model *m, notes *warnings, err *e)
{
    char text[300];
    model_axis_drop(m, "probe-face", warnings);
    model_axis_drop(m, "probe-vertex", warnings);
    probe_text(p, text, sizeof text);
    chars_mend(text);
    if (model_meta_set(m, "probe.shape", text, e))
        return -1;
    return p->kind == PROBE_CONVEX ? carry_convex(p, m, e) : 0;
}

static int convex_carried(probe *p, const model *m, err *e)
{
    const model_array *corner = model_find(m, "probe-vertex.position"), *face = model_find(m, "probe-face.vertex");
    if (!corner || !face || face->rows < 1 || face->rows > INT32_MAX || corner->rows > INT32_MAX)
        return err_set(e, NULL, 0,
                       "the probe is the OBJ %s, which the model does not hold; expected its corners and triangles "
                       "(probe-vertex.position, probe-face.vertex), as msds-run and tled-run write them",
                       p->file);
    p->corners = (int32_t)corner->rows;
    p->faces = (int32_t)face->rows;
    p->corner = mem_array(p->corners, 3 * sizeof *p->corner, "the probe", e);
    p->face = mem_array(p->faces, 3 * sizeof *p->face, "the probe", e);
    if (!p->corner || !p->face) {
        probe_free(p);
        return -1;
    }
    memcpy(p->corner, corner->f64, 3 * (size_t)p->corners * sizeof *p->corner);
    memcpy(p->face, face->i32, 3 * (size_t)p->faces * sizeof *p->face);
    return 1;
}

int probe_carried(probe *p, const model *m, err *e)
{
    const char *text = model_meta_of(m, "probe.shape");
    err ignored = {0};
    if (!text)
        return 0;
    if (probe_of(p, text, &ignored))
        return err_set(e, m->stream, 0,
                       "metadata, probe.shape: '%.100s' is not a probe; expected one as msds-run writes it", text);
    return p->kind == PROBE_CONVEX ? convex_carried(p, m, e) : 1;
}
