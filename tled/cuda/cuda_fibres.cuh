/* The fibres of a cell as the maths of an element takes them, in `real`, for kernels with fibres: of steps, and of
 * looks, where `real` is double whatever the state is in. Included by cuda_kernels.cuh and cuda_look.cu alone.
 */
#ifndef SINEW_CUDA_FIBRES_CUH
#define SINEW_CUDA_FIBRES_CUH

extern "C" {
#include "physics/element.h"
}
#include "tled/cuda/cuda_view.cuh"

/* Whether a volume has fibres that resist being stretched. */
static __device__ bool cuda_stretched(const cuda_fibres<real> &of)
{
    return of.families > 0 || of.is_fung;
}

/* What a muscle of a volume pulls with before its curve is looked at, Pa: tled_tension. now: the curves' values. */
static __device__ real cuda_tension(const cuda_fibres<real> &of, const double *now)
{
    return of.contract < 0 ? 0 : (real)(of.peak * now[3 * of.contract] / of.optimum);
}

/* Row `row` of a model's fibres. */
static __device__ element_vector cuda_direction(const float *fibre, int64_t row)
{
    const element_vector along = {fibre[3 * row], fibre[3 * row + 1], fibre[3 * row + 2]};
    return along;
}

/* Likewise of a family at an angle. */
template <class S> static __device__ element_vector cuda_family(const S *family, int64_t directions, int64_t row, int k)
{
    const S *at = family + 3 * k * directions + row;
    const element_vector along = {(real)at[0], (real)at[directions], (real)at[2 * directions]};
    return along;
}

/* A volume's muscle, a contractile element as at rest; share: of the element that is the volume's tissue. */
static __device__ element_fibre cuda_muscle(const cuda_fibres<real> &of, const float *fibre, int64_t row, real share,
                                            real tension)
{
    const element_fibre muscle = {cuda_direction(fibre, row),
                                  share * tension,
                                  {of.less, share * of.passive, of.stiffening, of.straight},
                                  {share * of.spring, 0}};
    return muscle;
}

/* What of a volume's fibres resists being stretched; share: likewise. */
template <class S>
static __device__ fibre_set cuda_fibre_set(const cuda_view<S> &v, const cuda_fibres<real> &of, const float *fibre,
                                           const S *family, int64_t row, real share)
{
    fibre_set s = {{share * of.k1, of.k2, of.kappa},
                   {share * of.c, of.all, of.along, of.both},
                   {0, 0, 0},
                   {{0, 0, 0}, {0, 0, 0}},
                   of.families,
                   of.is_fung};
    if (of.families < 2 || of.is_fung)
        s.along = s.family[0] = cuda_direction(fibre, row);
    for (int k = 0; k < FIBRE_FAMILIES; k++)
        if (of.families == 2)
            s.family[k] = cuda_family(family, v.directions, row, k);
    return s;
}

#endif
