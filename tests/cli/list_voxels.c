/* list_voxels FILE [OUT [raw]]: what common/volume reads of a volume image, its sizes, spacing, origin and a checksum
 * of its voxels, for the tests; and writes it again as NRRD, gzip or raw.
 */
#include "base/checksum.h"
#include "volume/nrrd.h"

#include <stdio.h>

static void put(const volume *v)
{
    size_t size = volume_type_size(v->type);
    printf("size %lld %lld %lld\n", (long long)v->size[0], (long long)v->size[1], (long long)v->size[2]);
    printf("spacing %.9g %.9g %.9g\n", volume_spacing(v, 0), volume_spacing(v, 1), volume_spacing(v, 2));
    printf("origin %.9g %.9g %.9g\n", v->origin[0], v->origin[1], v->origin[2]);
    printf("voxels %08x of %zu bytes each\n", checksum_add(0, v->data, (size_t)volume_count(v) * size), size);
}

int main(int argc, char **argv)
{
    volume v = {0};
    err e = {0};
    if (argc > 1 && !volume_load(&v, argv[1], NULL, &e))
        put(&v);
    if (argc > 2 && !e.status) {
        out *to = out_open(argv[2], false, &e);
        if (to) {
            nrrd_write(&v, argc == 3, to, &e);
            out_close(to, &e);
        }
    }
    if (e.status)
        fprintf(stderr, "voxels: %s\n", e.text);
    volume_free(&v);
    return argc > 1 ? e.status : 2;
}
