/* See mesh_bytes.h. */
// needs: common/tools/import_mesh.c common/tools/import_model.c common/tools/import_ids.c common/tools/import_vtu.c common/tools/import_xml.c common/tools/import_xml_data.c
#include "tools/import_vtu.h"

#include "mesh_bytes.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    mesh_bytes(import_vtu, data, size);
    return 0;
}
