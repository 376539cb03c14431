/* See mesh_bytes.h. */
// needs: common/tools/import_mesh.c common/tools/import_model.c common/tools/import_ids.c common/tools/import_inp.c common/tools/import_inp_end.c common/tools/import_sets.c
#include "tools/import_inp.h"

#include "mesh_bytes.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    mesh_bytes(import_inp, data, size);
    return 0;
}
