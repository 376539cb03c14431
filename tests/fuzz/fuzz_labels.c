/* Any line as msds-mesh's --names and any bytes after it as the image of --labels (NRRD, without its first line): every
 * element has a volume that there is, whose names differ; or one error with a text.
 */
// needs: msds/mesh/mesh_labels.c msds/mesh/mesh_chosen.c msds/mesh/mesh_tets.c
#include "model/materials.h"
#include "msds/mesh/mesh_labels.h"
#include "msds/mesh/mesh_tets.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check(const model *m)
{
    const model_array *of = model_find(m, "element.volume"), *name = model_find(m, "volume.name");
    for (int64_t n = 0; n < of->rows; n++)
        if (of->i32[n] < 0 || of->i32[n] >= name->rows)
            abort();
    for (int64_t i = 0; i < name->rows; i++)
        for (int64_t j = 0; j < i; j++)
            if (!strcmp(name->str[i], name->str[j]))
                abort();
}

static void label(volume *labels, const char *names)
{
    err e = {0};
    model m = {0};
    material of = materials_fallback();
    /* As far as the image, of mm: some elements are outside. */
    const mesh_box box = {{3, 3, 3}, {0, 0, 0}, {{.004, 0, 0}, {0, .004, 0}, {0, 0, .004}}};
    if (mesh_box_add(&m, &box, &e) || materials_make(&m, &of, &e))
        abort();
    int status =
        (*names ? mesh_label_names(labels, names, &e) : 0) || mesh_label(&m, labels, "fuzz", NULL, NULL, NULL, &e);
    if (status != (e.text[0] != '\0'))
        abort();
    if (!status)
        check(&m);
    model_free(&m);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char first[] = "NRRD0004\n";
    const size_t n = sizeof first - 1;
    const uint8_t *end = size ? memchr(data, '\n', size) : NULL;
    volume labels = {0};
    err e = {0};
    if (!end)
        return 0;
    size_t line = (size_t)(end - data), rest = size - line - 1;
    char *names = calloc(line + 1, 1), *image = malloc(n + rest);
    if (names && image) {
        memcpy(names, data, line);
        memcpy(image, first, n);
        memcpy(image + n, end + 1, rest);
        in *s = in_memory(image, n + rest, "fuzz", &e);
        if (s && !volume_read(&labels, s, NULL, NULL, &e))
            label(&labels, names);
        in_close(s);
        volume_free(&labels);
    }
    free(names);
    free(image);
    return 0;
}
