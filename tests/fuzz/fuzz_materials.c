// needs: common/inspect/preset_file.c
/* Any bytes as a file of materials: a table whose rows are all valid, or one error with a text. What was read can be
 * read over itself as an override; and so can the default table, where the names fit. What sinew materials reads of it
 * has text for each row, or is refused with it. */
#include "base/chars.h"
#include "inspect/preset_file.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int read_bytes(int (*reads)(model *, in *, err *), model *m, const uint8_t *data, size_t size, err *e)
{
    in *s = in_memory(data, size, "fuzz", e);
    int status = s ? reads(m, s, e) : -1;
    if (s)
        in_close(s);
    return status;
}

static void check_table(const model *m)
{
    for (int64_t i = 0; i < model_count(m, "material"); i++) {
        material a;
        err e = {0};
        if (materials_of(m, i, &a, &e) && material_young(&a) < 1e300 && material_young(&a) > 1e-300)
            abort();
    }
}

/* Whether the file is refused as when its materials alone are read. */
static void check_preset(const uint8_t *data, size_t size, bool refused)
{
    preset_file of;
    err e = {0};
    in *s = in_memory(data, size, "fuzz", &e);
    const int status = s ? preset_file_take(&of, s, &e) : -1;
    if ((status != 0) != refused || refused != (*e.text != '\0'))
        abort();
    for (int64_t i = 0; !status && i < model_count(&of.materials, "material"); i++)
        if (!chars_utf8(of.what[i]))
            abort();
    if (!status)
        preset_file_free(&of);
    in_close(s);
}

static void change_default(const uint8_t *data, size_t size)
{
    model m = {0};
    err e = {0};
    if (materials_default(&m, &e))
        abort();
    if (!read_bytes(materials_override, &m, data, size, &e))
        check_table(&m);
    else if (!e.text[0])
        abort();
    model_free(&m);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    model m = {0};
    err e = {0};
    const bool refused = read_bytes(materials_read, &m, data, size, &e) != 0;
    if (refused) {
        if (!e.text[0])
            abort();
    } else {
        check_table(&m);
        if (read_bytes(materials_override, &m, data, size, &e))
            abort();
        check_table(&m);
    }
    model_free(&m);
    check_preset(data, size, refused);
    change_default(data, size);
    return 0;
}
