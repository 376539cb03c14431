#include "slice/image/slice_files.h"

#include "base/mem.h"
#include "base/path.h"

#include <stdlib.h>
#include <string.h>

char *slice_files_cut(const char *pattern, int64_t index, err *e)
{
    numbered names;
    if (!strchr(pattern, '%'))
        return mem_text(pattern, e);
    return numbered_of(&names, pattern, "", e) ? NULL : numbered_name(&names, index, e);
}

/* image may be NULL: a stream takes all images. */
static int check_cut(const tool *t, const char *image, const char *cut, err *e)
{
    if (tool_check_written(t, "--cut", cut, e))
        return -1;
    if (image && path_is_same(image, cut))
        return err_usage(e, "--cut '%.400s' would overwrite the file of -o '%.400s'; expected another file", cut,
                         image);
    return 0;
}

static int check_pattern(const tool *t, const char *image, const char *pattern, int64_t index, err *e)
{
    char *cut = slice_files_cut(pattern, index, e);
    const int failed = cut ? check_cut(t, image, cut, e) : -1;
    free(cut);
    return failed;
}

int slice_files_check(const tool *t, const slice_writer *w, const char *cut, int64_t index, err *e)
{
    char *image = w->stream ? NULL : numbered_name(&w->names, index, e);
    int failed = w->stream || image ? 0 : -1;
    if (image)
        failed = tool_check_written(t, "-o", image, e);
    if (!failed && cut)
        failed = check_pattern(t, image, cut, index, e);
    free(image);
    return failed;
}
