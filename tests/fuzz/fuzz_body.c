/* Any bytes as a body's file: places whose turns are of length 1 and which lead back where they came from, files
 * without a folder; or one error with a text. */
#include "volume/body.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check_place(const body_place *p)
{
    const double x[3] = {.1, -.2, .3}, none[4] = {0, 0, 0, 1};
    double there[3], back[3], turn[4], square = 0, far = 1;
    for (int i = 0; i < 4; i++)
        square += p->turn[i] * p->turn[i];
    for (int a = 0; a < 3; a++)
        far = fmax(far, fabs(p->move[a]));
    if (!(fabs(square - 1) < 1e-9) || !isfinite(far))
        abort();
    body_put(p, x, there);
    body_back(p, there, back);
    for (int a = 0; a < 3; a++)
        if (far < 1e6 && !(fabs(back[a] - x[a]) < 1e-8))
            abort();
    body_turn(p, none, turn);
    body_turn_back(p, turn, turn);
    if (!(fabs(turn[3] * turn[3] - 1) < 1e-9))
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    err e = {0};
    body b;
    in *s = in_memory(data, size, "fuzz", &e);
    if (s && !body_read(&b, s, &e)) {
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
