#include "mesh/cut_moments.h"

static int check_order(const cut_moments *of, err *e)
{
    for (int64_t i = 1; i < of->count; i++)
        if (of->element[i] <= of->element[i - 1])
            return err_set(e, NULL, 0, "cut.element, row %lld is %d after %d; expected ascending numbers", (long long)i,
                           (int)of->element[i], (int)of->element[i - 1]);
    return 0;
}

int cut_moments_of(cut_moments *to, const model *m, err *e)
{
    const model_array *element = model_find(m, "cut.element"), *moments = model_find(m, "cut.moments");
    *to = (cut_moments){.count = 0};
    if (!element && !moments)
        return 0;
    if (!model_need(m, "cut.element", e) || !model_need(m, "cut.moments", e) || !model_need(m, "element.fraction", e))
        return -1;
    *to = (cut_moments){element->i32, moments->f32, element->rows};
    return check_order(to, e);
}

int64_t cut_moments_row(const cut_moments *of, int64_t element)
{
    int64_t low = 0, high = of->count;
    while (low < high) {
        const int64_t middle = low + (high - low) / 2;
        if (of->element[middle] < element)
            low = middle + 1;
        else
            high = middle;
    }
    return low < of->count && of->element[low] == element ? low : -1;
}

const float *cut_moments_at(const cut_moments *of, int64_t element)
{
    const int64_t row = cut_moments_row(of, element);
    return row < 0 ? NULL : of->of + CUT_MOMENTS * row;
}
