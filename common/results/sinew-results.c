/* sinew-results: adds stress, strain, stretches and energies to the frames of a model. */
#include "cli/tool.h"
#include "model/stage.h"
#include "results/results.h"

struct options {
    opt_common common;
};

static const opt option_list[] = {{0}};

static const opt_tool table = {
    .name = "sinew-results",
    .command = "sinew results",
    .usage = "[options] NAME... < result > result",
    .purpose = "Adds stress, strain, stretches and energies to the frames of a model.",
    .note = "NAMES: stress, stress.mises, strain, stretch, stretch.fibre, energy,\nmaterial.energy, or all.",
    .example = "sinew results stress.mises,energy < smile.sinew > stressed.sinew",
    .operands = "NAME...",
    .operands_min = 1,
    .operands_max = 64,
    .writes_model = true,
    .threaded = true,
    .options = option_list,
};

/* What a run alone knows is refused by name; of `all` it is what a frame has. */
static int read_names(int count, char *const *name, unsigned *which, err *e)
{
    for (int i = 0; i < count; i++) {
        unsigned one = 0;
        if (results_read(name[i], NULL, &one, e))
            return -1;
        if (one == 1U << RESULTS_ACTIVATION)
            return err_usage(e, "activation comes from tled-run --results; expected another name");
        *which |= one;
    }
    return *which ? 0 : err_usage(e, "no name of a result; expected one, or all");
}

/* What muscles do is part of the stress of a frame that tells their activation. */
static void note_activation(const model *m, const frame *f, notes *warnings)
{
    const model_array *muscle = model_find(m, "volume.muscle");
    bool any = false;
    for (int64_t i = 0; muscle && i < muscle->rows; i++)
        any |= muscle->u8[i] != 0;
    if (!any || !model_find(m, "element.fibre") || frame_find(f, results_array(RESULTS_ACTIVATION)))
        return;
    notes_add(warnings, "the frames do not have volume.activation (tled-run --results activation): stress is without "
                        "the active stress of muscles");
}

static int work(stage *s, const model *m, results *r, bool stresses, notes *warnings, err *e)
{
    frame f = {0};
    int64_t count = 0;
    int got;
    while ((got = model_read_frame(s->reader, m, &f, e)) > 0) {
        if (!count++ && stresses)
            note_activation(m, &f, warnings);
        if (results_add(r, &f, NULL, e) || model_write_frame(s->writer, &f, e)) {
            got = -1;
            break;
        }
    }
    frame_free(&f);
    if (!got && !count)
        return err_set(e, NULL, 0, "the model has no frames; expected results, from tled-run");
    return got;
}

static int run_tool(int argc, char **argv)
{
    struct options o = {{0}};
    err e = {0};
    tool t = {0};
    stage s = {0};
    model m = {0};
    pool *threads = NULL;
    results *r = NULL;
    notes warnings = {0};
    unsigned which = 0;
    int count;

    if (tool_begin(&t, &table, argc, argv, &o, &e) || t.done)
        goto out;
    if (read_names(t.operands, argv + 1, &which, &e) || stage_open_output(&s, &t, &e) || stage_read(&s, &m, &e))
        goto out;
    count = tool_threads(&t, &e);
    threads = count > 0 ? pool_create(count, &e) : NULL;
    if (!threads || results_create(&r, &m, which, threads, &e) || stage_write(&s, &m, &e))
        goto out;
    work(&s, &m, r, which & (1U << RESULTS_STRESS | 1U << RESULTS_MISES), &warnings, &e);
out:
    if (!e.status)
        tool_warn(&t, &warnings);
    notes_free(&warnings);
    if (!t.done)
        stage_close(&s, &t, &e);
    results_destroy(r);
    pool_destroy(threads);
    model_free(&m);
    return tool_end(&t, &e);
}

int main(int argc, char **argv)
{
    return tool_run(run_tool, argc, argv);
}
