/* See mesh_bytes.h. */
// needs: common/exchange/import_mesh.c common/exchange/import_model.c common/exchange/import_ids.c
// needs: common/exchange/import_vtu.c common/exchange/import_xml.c
#include "exchange/import_vtu.h"

#include "mesh_bytes.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    mesh_bytes(import_vtu, data, size);
    return 0;
}
