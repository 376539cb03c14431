/* See mesh_bytes.h. */
// needs: common/exchange/import_mesh.c common/exchange/import_model.c common/exchange/import_ids.c common/exchange/import_msh.c common/exchange/import_tokens.c
#include "exchange/import_msh.h"

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
