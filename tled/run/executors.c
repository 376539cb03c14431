/* The tables of executors that this build has, the preferred first, and the choice among them. */
#include "physics/law.h"
#include "tled/cpu/cpu.h"
#include "tled/problem/tled_executor.h"

#ifdef SINEW_CUDA
#include "tled/cuda/cuda.h"
#endif

const tled_executor *const tled_executors_double[] = {
#ifdef SINEW_CUDA
    &tled_cuda_double,
#endif
    &tled_cpu_double,
    &tled_cpu_meshes_double,
    NULL,
};

const tled_executor *const tled_executors_single[] = {
#ifdef SINEW_CUDA
    &tled_cuda_single,
#endif
    &tled_cpu_single,
    &tled_cpu_meshes_single,
    NULL,
};

/* The features that elements of a form need. */
static uint32_t features_of(form f)
{
#define FORM_HISTORY(NAME, name, coefficients, history) (history),
    static const int numbers[FORM_COUNT] = {FORMS(FORM_HISTORY) 0};
#undef FORM_HISTORY
    return numbers[f] > 0 ? EXECUTOR_HISTORY : 0;
}

/* The first volume whose own law has the problem's form; NULL: it only expresses them all. */
static const char *volume_that_wants(const tled_problem *p)
{
    for (int32_t i = 0; i < p->volumes; i++)
        if (p->volume[i].row->form == p->form)
            return p->volume[i].name;
    return NULL;
}

executor_need tled_need(const tled_problem *p)
{
    const uint32_t meshes = p->conforming ? EXECUTOR_MESHES : 0, contact = p->collider ? EXECUTOR_CONTACT : 0,
                   mixtures = p->mix ? EXECUTOR_MIXTURES : 0;
    executor_need need = {.features = meshes | contact | mixtures | features_of(p->form),
                          .form = p->form,
                          .volume = volume_that_wants(p)};
    for (int f = 0; f < FORM_COUNT; f++) {
        const law_row *row = law_of_form((form)f);
        need.law[f] = row ? row->name : "of that form";
    }
    return need;
}

enum { EXECUTORS_MOST = 15 };

const tled_executor *tled_executor_choose(const tled_executor *const *table, const char *device,
                                          const executor_need *need, char *says, size_t size, err *e)
{
    const executor *rows[EXECUTORS_MOST + 1] = {NULL};
    for (int i = 0; i < EXECUTORS_MOST && table[i]; i++)
        rows[i] = &table[i]->is;
    const int chosen = executor_choose(rows, device, need, says, size, e);
    return chosen < 0 ? NULL : table[chosen];
}
