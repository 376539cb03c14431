/* See mesh_bytes.h. */
// needs: common/tools/import_mesh.c common/tools/import_model.c common/tools/import_ids.c common/tools/import_msh.c common/tools/import_tokens.c
#include "tools/import_msh.h"

#include "mesh_bytes.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int read_msh(import_mesh *m, in *s, const import_wishes *w, notes *warnings, err *e)
{
    (void)warnings;
    return import_msh(m, s, w, e);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    mesh_bytes(read_msh, data, size);
    return 0;
}
