#include "surface/coincident.h"

#include "base/mem.h"
#include "surface/hash.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static uint64_t hash_position(const double *p)
{
    uint64_t h = 0, bits;
    for (int a = 0; a < 3; a++) {
        const double x = p[a] + 0.; /* no -0 */
        memcpy(&bits, &x, sizeof bits);
        h = hash_next(h, bits);
    }
    return h;
}

static bool same_place(const double *a, const double *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Where in the table the first point at this place is, or is to be. table: points + 1; 0: free. */
static int64_t find(const int32_t *table, int64_t size, const double *position, const double *p)
{
    int64_t at = (int64_t)(hash_position(p) & (uint64_t)(size - 1));
    while (table[at] && !same_place(position + 3 * ((int64_t)table[at] - 1), p))
        at = (at + 1) & (size - 1);
    return at;
}

int64_t coincident_places(const double *position, int64_t count, int32_t *place, err *e)
{
    const int64_t size = hash_size(count);
    int32_t *table = mem_array(size, sizeof *table, "the vertices' places", e);
    int64_t places = 0;
    if (!table)
        return -1;
    for (int64_t i = 0; i < count; i++) {
        const int64_t at = find(table, size, position, position + 3 * i);
        if (table[at]) {
            place[i] = place[table[at] - 1];
        } else {
            table[at] = (int32_t)(i + 1);
            place[i] = (int32_t)places++;
        }
    }
    free(table);
    return places;
}
