// needs: attach/rigid.c msds/mesh/mesh_fix.c msds/mesh/mesh_sides.c msds/mesh/mesh_around.c msds/mesh/mesh_graded.c
// needs: msds/mesh/mesh_keys.c msds/mesh/mesh_cells.c msds/mesh/mesh_tets.c msds/mesh/mesh_labels.c
// needs: msds/mesh/mesh_chosen.c
// needs: tled/problem/script.c tled/problem/script_surface.c
// needs: tled/problem/script_nodes.c
// needs: tled/problem/script_read.c common/inspect/info_key.c common/inspect/info_quality.c common/inspect/info_stats.c
// needs: tled/problem/script_move.c
// needs: tled/problem/script_levels.c tled/problem/script_muscles.c tled/problem/script_track.c tled/muscle/muscles.c
// needs: tled/muscle/expressions.c tled/muscle/activation.c
/* Any text as the lists of names that options take, over a small model: attach --rigid, msds-mesh --fix and --names,
 * tled-run -c, tled-run --results; and as a key of sinew info --get. Each is taken or is one error with a text.
 */
#include "attach/rigid.h"
#include "inspect/info_key.h"
#include "model/materials.h"
#include "msds/mesh/mesh_fix.h"
#include "msds/mesh/mesh_labels.h"
#include "msds/mesh/mesh_tets.h"
#include "results/results.h"
#include "tled/muscle/muscles.h"
#include "tled/problem/script.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void must(bool good)
{
    if (!good)
        abort();
}

static const char body[] =
    "%sinew 1 text\nmeta source.unit \"mm\"\naxis node 4\naxis element 1\naxis volume 1\naxis muscle 1\naxis s/vertex "
    "3\n"
    "axis s/face 1\naxis s/corner 3\naxis s/group 1\n"
    "array node.position f64 m node 3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\narray element.node i32 @node element 4\n0 1 2 3\n"
    "array element.volume i32 @volume element 1\n0\narray volume.name str 1 volume 1\n\"muscle_zyg\"\n"
    "array volume.muscle u8 1 volume 1\n1\narray muscle.volume i32 @volume muscle 1\n0\n"
    "array s/vertex.position f64 m s/vertex 3\n0 0 0\n1 0 0\n0 1 0\narray s/face.start i64 @s/corner s/face 1\n0\n"
    "array s/face.vertex i32 @s/vertex s/corner 1\n0\n1\n2\narray s/face.group i32 @s/group s/face 1\n0\n"
    "array s/group.name str 1 s/group 1\n\"skull_a Skin\"\nframe 0 0\narray node.displacement f64 m node 3\n"
    "0 0 0\n0 0 0\n0 0 0\n0 0 -0.01\nend\n";

/* The whole stream; the last frame stays in it. */
static void read_model(source *s)
{
    err e = {0};
    s->stream = in_memory(body, sizeof body - 1, "model", &e);
    s->reader = s->stream ? model_reader_open(s->stream, &e) : NULL;
    must(s->reader && !model_read(s->reader, &s->body, &e));
    while (source_next(s, &e) > 0)
        ;
    must(!e.status && s->frames == 1);
}

static void rigid_names(const model *m, const char *text)
{
    rigid r = {0};
    err e = {0};
    const opt_list list = {1, {text}};
    int status = rigid_collect(&r, m, &list, &e);
    must((status != 0) == (*e.text != '\0') && (status || r.surfaces >= 1));
    rigid_free(&r);
}

static void fix(const char *text)
{
    model m = {0};
    err e = {0};
    material of = materials_fallback();
    const mesh_box box = {{2, 2, 3}, {0, 0, 0}, {{.004, 0, 0}, {0, .004, 0}, {0, 0, .004}}};
    must(!mesh_box_add(&m, &box, &e) && !materials_make(&m, &of, &e) &&
         !mesh_label(&m, NULL, "fuzz", NULL, NULL, NULL, &e));
    int status = mesh_fix(&m, text, box.nodes, &e);
    must((status != 0) == (*e.text != '\0'));
    must(status || (mesh_fixed(&m) >= 0 && mesh_fixed(&m) <= model_count(&m, "node")));
    model_free(&m);
}

static void contract(const model *m, const char *text)
{
    script s = {0};
    err e = {0};
    int status = script_add_contract(&s, m, text, .1, &e);
    must((status != 0) == (*e.text != '\0'));
    for (int64_t i = 0; !status && i < s.keys; i++)
        must(s.value[3 * i] >= 0 && s.value[3 * i] <= 1);
    script_free(&s);
    double level;
    if (!muscles_level(text, &level))
        must(level >= 0 && level <= 1);
}

static void label_names(const char *text)
{
    volume v = {0};
    err e = {0};
    int status = mesh_label_names(&v, text, &e);
    must((status != 0) == (*e.text != '\0'));
    volume_free(&v);
}

static void result_names(const char *text)
{
    unsigned which = 0;
    err e = {0};
    int status = results_read(text, "--results", &which, &e);
    must((status != 0) == (*e.text != '\0') && which < 1U << RESULTS);
}

static void key(const source *s, const char *text)
{
    err e = {0};
    out *to = out_memory(&e);
    info_quality_seen seen = {0};
    int status = to ? info_key(s, &seen, text, to, &e) : -1;
    must((status != 0) == (*e.text != '\0'));
    out_discard(to);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    source s = {0};
    char *text = malloc(size + 1);
    if (!text)
        return 0;
    if (size)
        memcpy(text, data, size);
    text[size] = '\0';
    read_model(&s);
    rigid_names(&s.body, text);
    contract(&s.body, text);
    key(&s, text);
    fix(text);
    label_names(text);
    result_names(text);
    source_close(&s);
    free(text);
    return 0;
}
