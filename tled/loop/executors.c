/* The tables of executors that this build has, the preferred first, and what a problem needs of one. */
#include "physics/law.h"
#include "tled/cpu/cpu.h"
#include "tled/problem/tled_executor.h"

#ifdef SINEW_CUDA
#include "tled/cuda/cuda.h"
#endif

const executor *const tled_executors_double[] = {
#ifdef SINEW_CUDA
    &tled_cuda_double.is,
#endif
    &tled_cpu_double.is,
    &tled_cpu_meshes_double.is,
    NULL,
};

const executor *const tled_executors_single[] = {
#ifdef SINEW_CUDA
    &tled_cuda_single.is,
#endif
    &tled_cpu_single.is,
    &tled_cpu_meshes_single.is,
    NULL,
};

/* The features that elements of a form need. */
static uint32_t features_of(form f)
{
#define FORM_HISTORY(NAME, name, coefficients, exponents, history) (history),
    static const int numbers[FORM_COUNT] = {FORMS(FORM_HISTORY) 0};
#undef FORM_HISTORY
    return numbers[f] > 0 ? EXECUTOR_HISTORY : 0;
}

/* The first volume whose own law has the problem's form; NULL: it only expresses them all. */
static const tled_volume *volume_that_wants(const tled_problem *p)
{
    for (int32_t i = 0; i < p->volumes; i++)
        if (p->volume[i].row->form == p->form)
            return &p->volume[i];
    return NULL;
}

executor_need tled_need(const tled_problem *p)
{
    const uint32_t meshes = p->conforming ? EXECUTOR_MESHES : 0;
    const uint32_t contact = p->collider ? EXECUTOR_CONTACT : 0;
    const uint32_t followers = p->followers ? EXECUTOR_FOLLOWERS : 0;
    const uint32_t mixtures = p->mix ? EXECUTOR_MIXTURES : 0;
    const uint32_t curves = p->curved ? EXECUTOR_CURVES : 0;
    const uint32_t fibres = p->fibres.of ? EXECUTOR_FIBRES : 0;
    const uint32_t series = p->serial ? EXECUTOR_SERIES : 0;
    const uint32_t cuts = p->cut.count ? EXECUTOR_CUTS : 0;
    const uint32_t laminates = p->borders.count ? EXECUTOR_BORDERS : 0;
    const uint32_t films = p->films ? EXECUTOR_FILMS : 0;
    const uint32_t sliding = p->sliding ? EXECUTOR_SLIDING : 0;
    const uint32_t skin = p->self_contact ? EXECUTOR_SELF_CONTACT : 0;
    const tled_volume *wants = volume_that_wants(p);
    executor_need need = {.features = meshes | contact | followers | mixtures | curves | fibres | series | cuts |
                                      laminates | films | sliding | skin | features_of(p->form),
                          .form = UINT32_C(1) << p->form,
                          .volume = wants ? wants->name : NULL};
    for (int f = 0; f < FORM_COUNT; f++) {
        const law_row *row = law_of_form((form)f);
        need.law[f] = row ? row->name : NULL;
    }
    if (wants)
        need.law[p->form] = wants->row->name;
    return need;
}
