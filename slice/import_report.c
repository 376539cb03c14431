#include "slice/import_report.h"

#include <inttypes.h>

static void print_volume(const volume *v, const tool *t)
{
    tool_say(t,
             "volume: %" PRId64 " x %" PRId64 " x %" PRId64
             " voxels of %.6g x %.6g x %.6g mm, first at %.6g, %.6g, %.6g mm LPS",
             v->size[0], v->size[1], v->size[2], volume_spacing(v, 0), volume_spacing(v, 1), volume_spacing(v, 2),
             v->origin[0], v->origin[1], v->origin[2]);
}

static void print_elements(const dicom_elements *list, bool used, const tool *t)
{
    for (int64_t i = 0; i < list->count; i++) {
        const dicom_element *one = &list->one[i];
        if (one->used == used)
            tool_say(t, "%s: (%04x,%04x) %s, %" PRId64 " file%s", used ? "used" : "left out", (unsigned)one->group,
                     (unsigned)one->element, one->name, one->files, one->files == 1 ? "" : "s");
    }
}

void import_print(const import_report *r, const volume *v, const tool *t)
{
    print_volume(v, t);
    if (r->kind != IMPORT_DICOM) {
        tool_say(t,
                 "kept: the voxels, where they lie, and names of labels; every other key of the header was left out");
        return;
    }
    print_elements(&r->elements, true, t);
    print_elements(&r->elements, false, t);
    if (r->private_geometry)
        tool_say(t, "the distance between planes is from a maker's private elements");
    if (r->own_frame)
        tool_say(t, "positions are in the volume's own frame, not the patient's");
    if (r->burned)
        tool_say(t, "annotation burned in: said by %" PRId64 " file%s", r->burned, r->burned == 1 ? "" : "s");
    else if (r->unsaid)
        tool_say(t, "annotation burned in: not said by %" PRId64 " file%s; look", r->unsaid, r->unsaid == 1 ? "" : "s");
}
