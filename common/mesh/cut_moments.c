#include "mesh/cut_moments.h"

#include "mesh/lattice.h"

#include <math.h>

/* name: of the list. */
static int check_order(const int32_t *list, int64_t count, const char *name, err *e)
{
    for (int64_t i = 1; i < count; i++)
        if (list[i] <= list[i - 1])
            return err_set(e, NULL, 0, "%s, row %lld is %d after %d; expected ascending numbers", name, (long long)i,
                           (int)list[i], (int)list[i - 1]);
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
    return check_order(to->element, to->count, "cut.element", e);
}

/* Where an element is in an ascending list; -1: nowhere. */
static int64_t find(const int32_t *list, int64_t count, int64_t element)
{
    int64_t low = 0, high = count;
    while (low < high) {
        const int64_t middle = low + (high - low) / 2;
        if (list[middle] < element)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && list[low] == element ? low : -1;
}

int64_t cut_moments_row(const cut_moments *of, int64_t element)
{
    return find(of->element, of->count, element);
}

const float *cut_moments_at(const cut_moments *of, int64_t element)
{
    const int64_t row = cut_moments_row(of, element);
    return row < 0 ? NULL : of->of + CUT_MOMENTS * row;
}

/* ---- borders */

static int check_rows(const borders *of, const cut_moments *cut, const model *m, err *e)
{
    const int32_t *mix = model_find(m, "element.mix")->i32;
    const float *mixture = model_find(m, "element.mixture")->f32;
    const model_array *fraction = model_find(m, "element.fraction");
    for (int64_t i = 0; i < of->count; i++) {
        const int32_t element = of->element[i];
        const float *n = of->normal + 3 * i;
        if (mix[element] < 0 || !(mixture[element] > 0 && mixture[element] < 1))
            return err_set(e, NULL, 0,
                           "border.element, row %lld: element %d is not mixed of two volumes; expected a mixed element",
                           (long long)i, (int)element);
        if (fraction && fraction->f32[element] != 1 && !cut_moments_at(cut, element))
            return err_set(e, NULL, 0,
                           "border.element, row %lld: element %d has element.fraction %g and no row of cut.element; "
                           "expected it enclosed wholly, or in cut.element",
                           (long long)i, (int)element, (double)fraction->f32[element]);
        if (n[0] == 0 && n[1] == 0 && n[2] == 0)
            return err_set(e, NULL, 0, "border.normal, row %lld is 0 0 0; expected a direction", (long long)i);
    }
    return 0;
}

int borders_of(borders *to, const cut_moments *cut, const model *m, err *e)
{
    static const char *const name[] = {"border.element", "border.normal",   "border.moments",
                                       "element.mix",    "element.mixture", "element.lattice"};
    *to = (borders){.count = 0};
    if (!model_find(m, name[0]) && !model_find(m, name[1]) && !model_find(m, name[2]))
        return 0;
    for (int i = 0; i < (int)(sizeof name / sizeof *name); i++)
        if (!model_need(m, name[i], e))
            return -1;
    *to = (borders){model_find(m, name[0])->i32, model_find(m, name[1])->f32, model_find(m, name[2])->f32,
                    model_find(m, name[0])->rows};
    return check_order(to->element, to->count, name[0], e) ? -1 : check_rows(to, cut, m, e);
}

int64_t borders_at(const borders *of, int64_t element)
{
    return find(of->element, of->count, element);
}

/* A plane m.x = d, x from -1 to 1 across a box, in terms of t = d + (a[0] + a[1] + a[2])/2, a of x from 0 to 1. */
typedef struct plane {
    double a[3], all;
} plane;

static plane plane_across(const double m[3])
{
    const double most = fmax(fabs(m[0]), fmax(fabs(m[1]), fabs(m[2])));
    plane p = {.all = 0};
    for (int i = 0; i < 3; i++) {
        p.a[i] = 2 * fmax(fabs(m[i]), 1e-3 * most);
        p.all += p.a[i];
    }
    return p;
}

/* The share of the box below t, or what that adds up to from 0 to t (power 3, 4). */
static double summed_below(const plane *p, double t, int power)
{
    double sum = 0;
    for (int s = 0; s < 8; s++) {
        const double left = t - (s & 1 ? p->a[0] : 0) - (s & 2 ? p->a[1] : 0) - (s & 4 ? p->a[2] : 0);
        const int sign = (s & 1) ^ (s >> 1 & 1) ^ (s >> 2 & 1) ? -1 : 1;
        sum += left > 0 ? sign * left * left * left * (power == 3 ? 1 : left) : 0;
    }
    return sum / ((power == 3 ? 6 : 24) * p->a[0] * p->a[1] * p->a[2]);
}

/* t below which the box has this share. */
static double place_of(const plane *p, double share)
{
    double low = 0, high = p->all;
    for (int i = 0; i < 50; i++) {
        const double middle = (low + high) / 2;
        if (summed_below(p, middle, 3) < share)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Where the middle of the box's part below t is, or beyond it, along m. */
static double middle_below(const plane *p, double t)
{
    return t - summed_below(p, t, 4) / fmax(summed_below(p, t, 3), 1e-12) - p->all / 2;
}

static double middle_beyond(const plane *p, double t)
{
    const double share = summed_below(p, t, 3);
    return -share * middle_below(p, t) / fmax(1 - share, 1e-12);
}

/* d of the plane m.x = d beyond which lies this share of a box. */
static double beyond_at(const double m[3], double share)
{
    const plane p = plane_across(m);
    return place_of(&p, 1 - share) - p.all / 2;
}

/* d of the border in a box that is cut: first, second: middles of the parts along m, of such shares of the box. What
 * lies between the border and the surface is not beyond a plane: the other part is. */
static double border_at(const double m[3], double first, double second, double share_first, double share_second)
{
    const plane p = plane_across(m);
    const double below = place_of(&p, share_first), beyond = place_of(&p, 1 - share_second);
    const double off = fabs(middle_below(&p, below) - first), other_off = fabs(middle_beyond(&p, beyond) - second);
    return (off < other_off ? below : beyond) - p.all / 2;
}

void borders_numbers(const borders *of, int64_t row, const float *moments, const double side[3], double fraction,
                     double share, double *to)
{
    const float *n = of->normal + 3 * row;
    double *second = to + LAMINATE_SECOND, *whole = to + LAMINATE_WHOLE, m[3], length = 0, middle[2] = {0};
    for (int a = 0; a < 3; a++)
        length += (double)n[a] * (double)n[a];
    for (int k = 0; k < BORDER_MOMENTS; k++) {
        second[k] = (double)of->moments[BORDER_MOMENTS * row + k];
        whole[k] = moments ? (double)moments[k] : 0;
    }
    for (int a = 0; a < 3; a++) {
        to[LAMINATE_NORMAL + a] = (double)n[a] / sqrt(length);
        m[a] = to[LAMINATE_NORMAL + a] * side[a] / 2;
        middle[0] += m[a] * (whole[a] - share * second[a]) / (1 - share);
        middle[1] += m[a] * second[a];
    }
    const double d =
        moments ? border_at(m, middle[0], middle[1], fraction * (1 - share), fraction * share) : beyond_at(m, share);
    for (int k = 0; k < 4; k++)
        to[LAMINATE_KINK + k] = 0;
    for (int c = 0; c < 8; c++) {
        const int x = 2 * lattice_vtk[c][0] - 1, y = 2 * lattice_vtk[c][1] - 1, z = 2 * lattice_vtk[c][2] - 1;
        const int mode[4] = {x * y, y * z, z * x, x * y * z};
        const double kink = fmax(0, m[0] * x + m[1] * y + m[2] * z - d);
        for (int k = 0; k < 4; k++)
            to[LAMINATE_KINK + k] += mode[k] * kink;
    }
}
