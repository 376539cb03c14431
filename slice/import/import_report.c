#include "slice/import/import_report.h"

#include <inttypes.h>

static void print_volume(const volume *v, const tool *t)
{
    tool_say(t,
             "volume: %" PRId64 " x %" PRId64 " x %" PRId64
             " voxels of %.6g x %.6g x %.6g mm, first at %.6g, %.6g, %.6g mm LPS",
             v->size[0], v->size[1], v->size[2], volume_spacing(v, 0), volume_spacing(v, 1), volume_spacing(v, 2),
             v->origin[0], v->origin[1], v->origin[2]);
}

/* Those that were used, or those that were left out, by tag. */
static int print_elements(const dicom_elements *list, bool used, const tool *t, err *e)
{
    static const char *const heads[] = {"<tag", ">files", "<name", NULL};
    int64_t count = 0;
    text_table *rows = text_table_create(heads, e);
    for (int64_t i = 0; rows && i < list->count; i++) {
        const dicom_element *one = &list->one[i];
        if (one->used != used)
            continue;
        text_table_cell(rows, "(%04x,%04x)", (unsigned)one->group, (unsigned)one->element);
        text_table_count(rows, one->files);
        text_table_cell(rows, "%s", one->name);
        count++;
    }
    const char *plural = count == 1 ? "" : "s";
    const char *what = used ? "used" : "left out";
    const int rc = rows ? tool_table(t, rows, e, "%" PRId64 " element%s %s", count, plural, what) : -1;
    text_table_free(rows);
    return rc;
}

int import_print(const import_report *r, const volume *v, const tool *t, err *e)
{
    print_volume(v, t);
    if (r->kind != IMPORT_DICOM) {
        tool_say(t,
                 "kept: the voxels, where they lie, and names of labels; every other key of the header was left out");
        return 0;
    }
    if (print_elements(&r->elements, true, t, e) || print_elements(&r->elements, false, t, e))
        return -1;
    if (r->private_geometry)
        tool_say(t, "the distance between planes is from a maker's private elements");
    if (r->own_frame)
        tool_say(t, "positions are in the volume's own frame, not the patient's");
    if (r->burned)
        tool_say(t, "annotation burned in: stated by %" PRId64 " file%s", r->burned, r->burned == 1 ? "" : "s");
    else if (r->unsaid)
        tool_say(t, "annotation burned in: not stated by %" PRId64 " file%s: look at the images", r->unsaid,
                 r->unsaid == 1 ? "" : "s");
    return 0;
}
