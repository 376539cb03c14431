#include "tled/cuda/march_cells.h"

#include "base/mem.h"

#include <math.h>
#include <string.h>

/* What a cell has of a volume's muscle, if that may contract; share: of the cell. */
static void add_muscle(const march *m, const tled_volume *v, march_cell *to, const float *fibre, double share)
{
    const bool second = to->muscle[0].curve >= 0;
    march_muscle *muscle = &to->muscle[second];
    if (!fibre || v->contract < 0)
        return;
    if (second)
        to->muscle[0].curve |= MARCH_SECOND;
    muscle->curve = (int32_t)v->contract;
    *(second ? &to->second_peak : &to->peak) = share * v->peak;
    for (int a = 0; a < 3; a++)
        muscle->fibre[a] = fibre[m->axis[a]];
}

/* share: of the cell, that is tissue. */
static void put_law(const tled_problem *p, const tled_law *law, double share, march_cell *to)
{
    to->mu = share * law->mu;
    to->bulk = share * law->bulk;
    if (p->control.kind == HOURGLASS_ISOTROPIC) {
        to->second = share * law->hourglass[HOURGLASS_K];
    } else if (p->form == FORM_MOONEY_RIVLIN) {
        to->second = 2 * share * law->c[1];
    } else if (p->form == FORM_FIRST) {
        to->second = 4 * share * law->c[1];
        for (int k = 0; k < 3; k++)
            to->more[k] = (2 * k + 6) * share * law->c[2 + k];
    }
}

double march_stiffness(const march *m, const fibre_numbers *of)
{
    return m->families == 2 && fibre_numbers_families(of) == 1 ? of->k1 / 2 : of->k1;
}

static void put_family(const march *m, const fibre_numbers *of, double share, march_cell *to)
{
    to->family[0] = share * march_stiffness(m, of);
    to->family[1] = of->k2;
    to->family[2] = of->kappa;
    to->family[3] = of->angle;
}

/* Of the element's own volume; share: of the cell. What has no fibres has the plain ones, so that it is not special for
 * that. */
static void put_fibres(const march *m, const tled_problem *p, int32_t volume, double share, march_cell *to)
{
    if (fibres_any(&p->fibres, volume))
        put_family(m, &p->fibres.of[volume], share, to);
    else if (p->fibres.of)
        put_family(m, &p->fibres.of[m->plain], 1, to);
}

march_cell march_cell_of(const march *m, const tled_problem *p, int64_t element)
{
    const tled_law law = tled_law_of(p, element);
    const double share = tled_fraction(p, element), other = tled_mixture(p, element);
    const int32_t volume = p->element_volume[element];
    march_cell cell = {.muscle = {{.curve = -1}, {.curve = -1}}};
    put_law(p, &law, share, &cell);
    put_fibres(m, p, volume, share * (1 - other), &cell);
    add_muscle(m, &p->volume[volume], &cell, p->fibre ? p->fibre + 3 * element : NULL, share * (1 - other));
    if (tled_mix(p, element) >= 0)
        add_muscle(m, &p->volume[tled_mix(p, element)], &cell, p->mixfibre ? p->mixfibre + 3 * element : NULL,
                   share * other);
    return cell;
}

march_cut march_cut_of(const march *m, const float *moments)
{
    const float *products = moments + 3; /* of the axes but 2, but 0, but 1 */
    const int32_t but[3] = {1, 2, 0}, *axis = m->axis;
    return (march_cut){moments[axis[0]],       moments[axis[1]],       moments[axis[2]],
                       products[but[axis[2]]], products[but[axis[0]]], products[but[axis[1]]]};
}

bool march_cell_special(const march *m, const tled_problem *p, int64_t element, const march_cell *cell)
{
    march_cell plain = {.muscle = {{.curve = -1}, {.curve = -1}}};
    put_law(p, &p->volume[m->plain].law, 1, &plain);
    if (p->fibres.of)
        put_family(m, &p->fibres.of[m->plain], 1, &plain);
    return tled_cut(p, element) || cell->muscle[0].curve >= 0 || cell->mu != plain.mu || cell->bulk != plain.bulk ||
           cell->second != plain.second || memcmp(cell->more, plain.more, sizeof plain.more) != 0 ||
           memcmp(cell->family, plain.family, sizeof plain.family) != 0;
}

int march_families_of(const tled_problem *p)
{
    int most = 0;
    if (p->curved)
        return -1;
    for (int32_t v = 0; p->fibres.of && v < p->volumes; v++) {
        const fibre_numbers *of = &p->fibres.of[v];
        const int families = p->volume[v].elements ? fibre_numbers_families(of) : 0;
        if (p->volume[v].elements && of->c > 0)
            return -1;
        most = families > most ? families : most;
    }
    for (int64_t i = 0; p->fibres.mix && i < p->elements; i++)
        if (fibres_any(&p->fibres, p->fibres.mix[i]))
            return -1;
    return most;
}

int64_t march_along_tips(const march *m)
{
    return MARCH_THREADS * (m->layers + MARCH_AHEAD);
}

uint32_t *march_along_make(const march *m, err *e)
{
    const int64_t rows = march_along_tips(m) + 8 * m->tips;
    const float none = 2;
    uint32_t *along = mem_array(2 * rows, sizeof *along, "the march", e);
    for (int64_t i = 0; along && m->families == 1 && i < rows; i++)
        memcpy(&along[2 * i], &none, sizeof none);
    return along;
}

static void fold(const double a[3], double to[2])
{
    const double sum = fabs(a[0]) + fabs(a[1]) + fabs(a[2]), x = a[0] / sum, y = a[1] / sum;
    to[0] = a[2] < 0 ? copysign(1 - fabs(y), x) : x;
    to[1] = a[2] < 0 ? copysign(1 - fabs(x), y) : y;
}

void march_beside(const double a[3], double first[3], double second[3])
{
    const double sign = copysign(1, a[2]), c = -1 / (sign + a[2]), b = a[0] * a[1] * c;
    memcpy(first, (double[]){1 + sign * a[0] * a[0] * c, sign * b, -sign * a[0]}, 3 * sizeof *first);
    memcpy(second, (double[]){b, sign + a[1] * a[1] * c, -a[1]}, 3 * sizeof *second);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* A number from 0 to 1. */
static uint64_t bits_of(double x)
{
    return (uint64_t)(fmin(fmax(x, 0), 1) * 2097151 + .5);
}

/* One of `along`, and of `across`, which is not 0 where there are two families. */
static void put_two(const double along[3], const double across[3], uint32_t to[2])
{
    double first[3], second[3], place[2];
    fold(along, place);
    march_beside(along, first, second);
    const double turn = atan2(dot(across, second), dot(across, first)) / (2 * M_PI);
    const uint64_t all = bits_of((place[0] + 1) / 2) | bits_of((place[1] + 1) / 2) << 21 |
                         bits_of(turn < 0 ? turn + 1 : turn) << 42 | UINT64_C(1) << 63;
    to[0] = (uint32_t)all;
    to[1] = (uint32_t)(all >> 32);
}

/* A direction of the model along the march's axes, of length 1. Returns its length before. */
static double turned(const march *m, const double from[3], double to[3])
{
    const double length = sqrt(dot(from, from));
    for (int a = 0; a < 3; a++)
        to[a] = length > 0 ? from[m->axis[a]] / length : 0;
    return length;
}

void march_along_put(const march *m, const tled_problem *p, int64_t element, int64_t row)
{
    fibre_local at[2];
    double along[3], across[3], place[2], between[3];
    if (!fibres_at(&p->fibres, element, at))
        return;
    for (int a = 0; a < 3; a++)
        between[a] = at[0].family[0][a] - at[0].family[1][a];
    if (!(turned(m, at[0].family[0], along) > 0))
        return;
    if (m->families == 2) {
        turned(m, at[0].along, along);
        turned(m, between, across);
        put_two(along, across, m->along + 2 * row);
        return;
    }
    fold(along, place);
    const float both[2] = {(float)place[0], (float)place[1]};
    memcpy(m->along + 2 * row, both, sizeof both);
}

int32_t march_plain_of(const tled_problem *p)
{
    int32_t plain = 0;
    for (int32_t i = 1; i < p->volumes; i++)
        if (p->volume[i].elements > p->volume[plain].elements)
            plain = i;
    return plain;
}
