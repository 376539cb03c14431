/* Any bytes as a file of points: finite places and names that pair with themselves, or one error with a text; and
 * whatever points there are, a motion whose turn is of length 1, or one error. */
#include "place/points.h"
#include "place/registration.h"

#include <math.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check_motion(const points *p)
{
    double *x = calloc((size_t)(6 * p->count + 1), sizeof *x), square = 0;
    int64_t *pair = calloc((size_t)(p->count + 1), sizeof *pair);
    registration r;
    err e = {0};
    if (!x || !pair || points_pair(p, p, "a", "b", false, pair, &e))
        abort();
    double *y = x + 3 * p->count;
    for (int64_t i = 0; i < p->count; i++) {
        if (pair[i] != i)
            abort();
        for (int a = 0; a < 3; a++) {
            x[3 * i + a] = p->one[i].at[a];
            if (!isfinite(x[3 * i + a]))
                abort();
        }
    }
    const int failed = registration_fit(x, x, p->count, "fuzz", &r, y, &e);
    for (int i = 0; i < 4; i++)
        square += r.at.quaternion[i] * r.at.quaternion[i];
    if (failed != (e.status ? -1 : 0) || (!failed && !(fabs(square - 1) < 1e-9)))
        abort();
    free(x);
    free(pair);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    for (int shown = 0; shown < 2; shown++) {
        err e = {0};
        points p = {.count = 0};
        const points_wish wish = {num_unit_of("mm"), shown};
        in *s = in_memory(data, size, "fuzz", &e);
        const int failed = s ? points_read(&p, s, &wish, &e) : -1;
        if (failed != (e.status ? -1 : 0) || !e.status != !e.text[0])
            abort();
        if (!failed)
            check_motion(&p);
        points_free(&p);
        in_close(s);
    }
    return 0;
}
