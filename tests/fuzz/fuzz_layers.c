// needs: voxelise/volumes.c voxelise/volumes_file.c voxelise/layers.c voxelise/depths.c voxelise/voxels.c
// needs: voxelise/climb.c voxelise/surfaces/grid.c voxelise/surfaces/crossing.c voxelise/inside.c
// needs: voxelise/surfaces/expansion.c voxelise/surfaces/meet.c voxelise/shares.c voxelise/pieces.c voxelise/cuts.c
// needs: voxelise/surfaces/outward.c
/* Any bytes as a --layers file, beside a plan of volumes: layers with names of their own, deeper and deeper, of
 * materials that there are; or one error with a text.
 */
#include "model/materials.h"
#include "surface/obj.h"
#include "voxelise/layers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char surface[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\ng skin\nf 1 2 3\ng muscle_b\nf 3 2 1\n";

static void check(const layers *l, int64_t materials)
{
    for (int64_t i = 0; i < l->layers; i++) {
        const layers_layer *a = &l->layer[i];
        if (!(a->depth > 0) || (i && a->depth < a[-1].depth) || a->material < 0 || a->material >= materials ||
            !*a->name)
            abort();
        for (int64_t j = 0; j < i; j++)
            if (!strcasecmp(a->name, l->layer[j].name))
                abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    obj o = {0};
    model m = {0};
    volumes v = {0};
    layers l = {0};
    err e = {0};
    in *text = in_memory(surface, sizeof surface - 1, "surface.obj", &e);
    in *file = in_memory(data, size, "layers", &e);
    if (!text || obj_read(&o, text, &e) || materials_default(&m, &e) || volumes_by_name(&v, &o, &m, &e))
        abort();
    if (file && !layers_read(&l, file, num_unit_of("mm"), &v, &m, &e))
        check(&l, model_count(&m, "material"));
    else if (!e.status || !*e.text)
        abort();
    layers_free(&l);
    volumes_free(&v);
    model_free(&m);
    obj_free(&o);
    in_close(text);
    in_close(file);
    return 0;
}
