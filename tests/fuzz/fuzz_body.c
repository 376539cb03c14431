/* Any bytes as a body's file: places whose turns are of length 1 and which lead back where they came from, files
 * without a folder; or one error with a text. */
#include "volume/body.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check_place(const pose *p)
{
    const double x[3] = {.1, -.2, .3};
    double there[3], back[3], square = 0, far = 1;
    for (int i = 0; i < 4; i++)
        square += p->quaternion[i] * p->quaternion[i];
    for (int a = 0; a < 3; a++)
        far = fmax(far, fabs(p->position[a]));
    if (!(fabs(square - 1) < 1e-9) || !isfinite(far))
        abort();
    pose_apply(p, x, there);
    pose_apply_inverse(p, there, back);
    for (int a = 0; a < 3; a++)
        if (far < 1e6 && !(fabs(back[a] - x[a]) < 1e-8))
            abort();
    const pose none = pose_none(), same = pose_compose(p, &none), no_turn = pose_relative(p, &same);
    if (!(fabs(no_turn.quaternion[3] * no_turn.quaternion[3] - 1) < 1e-9))
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    err e = {0};
    body b;
    in *s = in_memory(data, size, "fuzz", &e);
    if (s && !body_read(&b, s, NULL, &e)) {
        check_place(&b.volume);
        for (int i = 0; i < b.parts; i++) {
            check_place(&b.part[i].place);
            if (!(b.part[i].scale > 0) || strchr(b.part[i].file, '/'))
                abort();
        }
        body_free(&b);
    }
    if (!e.status != !e.text[0])
        abort();
    in_close(s);
    return 0;
}
