// needs: voxelise/volumes.c voxelise/volumes_file.c
/* The reader of --volumes files, over a small OBJ: whatever it takes must be a plan that holds together. */
#include "model/materials.h"
#include "surface/obj.h"
#include "voxelise/volumes.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char surface[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\ng skin\nf 1 2 3\ng skull_left muscle_a\nf 1 2 3\n"
                              "g muscle_b\nf 3 2 1\ng points\np 1\n";

static void check_plan(const volumes *v, int32_t materials)
{
    for (int32_t i = 0; i < v->volumes; i++) {
        const volumes_volume *a = &v->volume[i], *before = i ? a - 1 : NULL;
        if (a->material < 0 || a->material >= materials || a->level < 0 || a->priority < 0 || !*a->name ||
            !*a->surfaces)
            abort();
        if (before ? a->level > before->level + 1 || a->level < before->level : a->level != 0)
            abort();
    }
    for (int64_t i = 0; i < v->members; i++)
        if (v->member[i].volume < 0 || v->member[i].volume >= v->volumes || v->member[i].surface >= v->surfaces)
            abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    obj o = {0};
    model m = {0};
    volumes v = {0};
    notes warnings = {0};
    err e = {0};
    in *text = in_memory(surface, sizeof surface - 1, "surface.obj", &e);
    in *file = in_memory(data, size, "volumes", &e);
    if (text && file && !obj_read(&o, text, &e) && !materials_default(&m, &e)) {
        if (volumes_read(&v, file, &o, &m, &warnings, &e) == 0)
            check_plan(&v, (int32_t)model_count(&m, "material"));
        else if (!e.status || !*e.text)
            abort();
    }
    volumes_free(&v);
    notes_free(&warnings);
    model_free(&m);
    obj_free(&o);
    in_close(text);
    in_close(file);
    return 0;
}
