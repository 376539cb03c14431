/* Forms in float keep small strains: their stress is that of doubles to a few digits of float, whatever the strain. */
// needs: tests/unit/form_double.c
#define ELEMENT_SINGLE
#include "physics/form_maths.h"

#include "form_double.h"
#include "form_tried.h"
#include "tap.h"

/* Numbers from -1 to 1, the same in every run. */
static double number(void)
{
    static uint32_t seed = 3;
    seed = seed * 1664525 + 1013904223;
    return (double)seed / 2147483648. - 1;
}

/* The larger; nan where one is, which fmax would drop. */
static double larger(double a, double b)
{
    return isnan(a) || a > b ? a : b;
}

/* How far stress is from that of doubles, as a share of its largest component, at H of entries up to `strain`. */
static double off(form f, const double *wide_c, double strain)
{
    double h[9], wide[9], worst = 0, most = 0;
    float small[9], narrow[9], c[FORM_NUMBERS];
    element_tensor at, p;
    for (int i = 0; i < 9; i++) {
        small[i] = (float)(strain * number());
        h[i] = small[i];
    }
    for (int i = 0; i < FORM_NUMBERS; i++)
        c[i] = (float)wide_c[i];
    memcpy(&at, small, sizeof at);
    if (!(element_dilation(at) > -.5F))
        return 0;
    p = form_stress(f, at, c);
    memcpy(narrow, &p, sizeof narrow);
    form_double(f, h, wide_c, wide);
    for (int i = 0; i < 9; i++) {
        worst = fmax(worst, fabs((double)narrow[i] - wide[i]));
        most = fmax(most, fabs(wide[i]));
    }
    return worst / most;
}

int main(void)
{
    for (int f = 0; f < FORM_STEPPED; f++) {
        double c[FORM_NUMBERS];
        if (!ok(form_tried((form)f, 1000, 9700, c), "form %d: form_tried.h has coefficients", f))
            continue;
        for (int power = -6; power <= 0; power++) {
            const double strain = pow(10, power);
            double worst = 0;
            for (int i = 0; i < 200; i++)
                worst = larger(worst, off((form)f, c, strain));
            ok(worst < 1e-5, "form %d in float at strains of %g: %.1e off", f, strain, worst);
        }
    }
    return done_testing();
}
