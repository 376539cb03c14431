#include "cli/frames.h"

#include "base/num.h"

#include <string.h>

int frames_asked(const char *text, frames_which *which, int64_t *index, err *e)
{
    static const struct {
        const char *word;
        frames_which which;
    } words[] = {{"last", FRAMES_LAST}, {"all", FRAMES_ALL}, {"rest", FRAMES_REST}, {"undeformed", FRAMES_REST}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (!strcmp(text, words[i].word)) {
            *which = words[i].which;
            return 0;
        }
    *which = FRAMES_ONE;
    if (!num_int(text, INT64_MIN, INT64_MAX, index))
        return 0;
    return err_usage(e, "--frame '%s': expected a frame's index, last, all, rest or undeformed", text);
}
