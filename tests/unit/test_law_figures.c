/* Laws against figures of a script that shares no code with Sinew (derivatives of W by complex steps): a bar with free
 * sides, a sheet that is pulled along two axes, simple shear; in double and in float. */
// needs: tests/unit/form_double.c tests/unit/fibre_single.c
#define ELEMENT_SINGLE
#include "physics/form_maths.h"
#include "physics/law.h"

#include "fibre_single.h"
#include "form_double.h"
#include "tap.h"

/* Of a law, and figures in Pa: along a bar at 1.2 of its length and its side then, at .8; along a sheet at 1.15; at a
 * shear of .4 the shear stress and the difference of the two normal stresses in its plane. 0: there is none. */
typedef struct figures {
    const char *law;
    struct {
        law_key key;
        double value;
    } of[8];
    double pulled, side, pressed, sheet, shear, normal;
} figures;

#define NONE                                                                                                           \
    {                                                                                                                  \
        LAW_ALL_KEYS, 0                                                                                                \
    }
static const figures all[] = {
    {"neo-hookean", {{LAW_E, 3e3}, {LAW_nu, .45}, NONE}, 502.259, .921820, -765.767, 610.166, 413.793, 165.517},
    {"mooney-rivlin",
     {{LAW_c10, 2500}, {LAW_c01, 500}, {LAW_K, 1e5}, NONE},
     2882.59,
     .918060,
     -4677.80,
     3855.32,
     2400,
     960},
    {"yeoh",
     {{LAW_c10, 2500}, {LAW_c20, 1175}, {LAW_c30, 0}, {LAW_K, 1e5}, NONE},
     2710.89,
     .917755,
     -4229.39,
     3623.78,
     2300.80,
     920.32},
    {"yeoh",
     {{LAW_c10, 400}, {LAW_c20, 1400}, {LAW_K, 5e4}, NONE},
     692.337,
     .915382,
     -1186.18,
     1201.14,
     678.40,
     271.36},
    {"yeoh", {{LAW_c10, 400}, {LAW_c20, 1400}, {LAW_nu, .46}, NONE}, 643.062, .924556, -1103.26, 0, 0, 0},
    {"yeoh", {{LAW_c10, 3180}, {LAW_c20, 14500}, {LAW_nu, .46}, NONE}, 5675.73, .925800, -9890.77, 0, 0, 0},
    {"arruda-boyce",
     {{LAW_mu, 3e3}, {LAW_lock, 1.4}, {LAW_K, 1e5}, NONE},
     2392.97,
     .917189,
     -3655.78,
     3054.74,
     1954.66,
     781.863},
    {"veronda-westmann",
     {{LAW_c1, 1e3}, {LAW_c2, 3}, {LAW_K, 1e5}, NONE},
     2790.32,
     .917896,
     -3964.01,
     4059.87,
     2678.58,
     1071.43},
    {"ogden",
     {{LAW_mu1, 1e3}, {LAW_a1, 2}, {LAW_mu2, 200}, {LAW_a2, -4}, {LAW_K, 1e5}, NONE},
     582.663,
     .913932,
     -983.689,
     0,
     0,
     0},
    {"fung",
     {{LAW_c, 2e3}, {LAW_bf, 8}, {LAW_bt, 2}, {LAW_bfs, 4}, {LAW_K, 1e5}, NONE},
     6733.678267,
     .914747360,
     -4182.077308,
     4803.899676,
     2410.332417,
     1410.490822},
    {"fung",
     {{LAW_c, 500}, {LAW_bf, 1}, {LAW_bt, 20}, {LAW_bfs, 3}, {LAW_K, 1e5}, NONE},
     932.7034296,
     .916955974,
     -2958.800268,
     3989.937310,
     895.8020642,
     -624.1717609},
};

/* P of H, by c: in float, or in double. */
typedef struct tried {
    form form;
    double c[FORM_NUMBERS];
    fibre_local fibres; /* along x; of none: there are none */
    bool narrow;
} tried;

static void stress(const tried *t, const double h[9], double p[9])
{
    float small[9], fibres[9], c[FORM_NUMBERS];
    double other[9];
    element_tensor at;
    if (!t->narrow) {
        form_double(t->form, h, t->c, p);
        fibre_double(&t->fibres, h, other);
        for (int i = 0; i < 9; i++)
            p[i] += other[i];
        return;
    }
    for (int i = 0; i < 9; i++)
        small[i] = (float)h[i];
    for (int i = 0; i < FORM_NUMBERS; i++)
        c[i] = (float)t->c[i];
    memcpy(&at, small, sizeof at);
    const element_tensor stressed = form_stress(t->form, at, c);
    memcpy(small, &stressed, sizeof small);
    fibre_single(&t->fibres, h, fibres);
    for (int i = 0; i < 9; i++)
        p[i] = (double)(small[i] + fibres[i]);
}

/* P_xx at a stretch of x along one axis or two, the others free; *side: theirs. */
static double pulled(const tried *t, double x, bool two, double *side)
{
    double low = .5, high = 1.5, p[9] = {0};
    for (int i = 0; i < 60; i++) {
        *side = (low + high) / 2;
        const double h[9] = {x - 1, 0, 0, 0, (two ? x : *side) - 1, 0, 0, 0, *side - 1};
        stress(t, h, p);
        if (p[8] > 0)
            high = *side;
        else
            low = *side;
    }
    return p[0];
}

static void compare(const figures *f, double got, double wanted, double tolerance, const char *what)
{
    if (wanted != 0)
        near_(got / wanted, 1, tolerance, "%s: %s, %g", f->law, what, wanted);
}

/* Of a shear g the Cauchy stress P F^T (J is 1): xy, and xx - yy. */
static void try(const figures *f, const tried *t)
{
    const double tolerance = t->narrow ? 1e-4 : 1e-5, shear[9] = {0, .4};
    double side, p[9];
    compare(f, pulled(t, 1.2, false, &side), f->pulled, tolerance, "pulled to 1.2");
    compare(f, side, f->side, tolerance, "its side");
    compare(f, pulled(t, .8, false, &side), f->pressed, tolerance, "pressed to .8");
    compare(f, pulled(t, 1.15, true, &side), f->sheet, tolerance, "along two axes to 1.15");
    stress(t, shear, p);
    compare(f, p[1], f->shear, tolerance, "sheared by .4");
    compare(f, p[0] + .4 * p[1] - p[4], f->normal, tolerance, "and its normal stresses");
}

int main(void)
{
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        const law_row *law = law_find(all[i].law);
        tried t = {.form = law->form, .fibres.along = {1, 0, 0}};
        double value[LAW_OWN_KEYS];
        for (int k = 0; k < LAW_OWN_KEYS; k++)
            value[k] = NAN;
        for (int k = 0; all[i].of[k].key != LAW_ALL_KEYS; k++)
            value[all[i].of[k].key] = all[i].of[k].value;
        law->fill(value, t.c);
        if (law->fibres)
            law->fibres(value, &t.fibres.of);
        for (int narrow = 0; narrow < 2; narrow++) {
            t.narrow = narrow;
            try(&all[i], &t);
        }
    }
    return done_testing();
}
