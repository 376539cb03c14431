/* Any bytes as a record: its frames' numbers are what a frame may have, and what is read, written and read again is the
 * same; or one error with a text.
 */
#include "live/record.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check_frame(const record_frame *f)
{
    double row[7];
    if (f->index < 0 || !isfinite(f->time) || f->steps < -1 || f->of < -1 || strlen(f->path) >= RECORD_WORD)
        abort();
    pose_to_row(&f->at, row);
    for (int i = 0; f->has_pose && i < 7; i++)
        if (!isfinite(row[i]))
            abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const record_of of[] = {{"model", "0x1"}};
    err e = {0};
    keyfile k;
    record_frame f;
    replay_kind kind;
    int got = -1;
    in *s = in_memory(data, size, "fuzz", &e);
    replay *r = s ? replay_take(s, "toy", of, 1, &e) : NULL;
    while (r && (got = replay_next(r, &kind, &k, &f, &e)) > 0) {
        if (k.count < 1 || !*k.word[0])
            abort();
        if (kind == REPLAY_FRAME)
            check_frame(&f);
    }
    if ((got < 0) != (e.text[0] != '\0'))
        abort();
    replay_close(r);
    return 0;
}
