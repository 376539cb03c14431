#include "picture/colourmap.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180;

/* Oklab and back, with the published matrices. */
static void from_oklab(const double lab[3], double rgb[3])
{
    double l = lab[0] + 0.3963377774 * lab[1] + 0.2158037573 * lab[2];
    double m = lab[0] - 0.1055613458 * lab[1] - 0.0638541728 * lab[2];
    double s = lab[0] - 0.0894841775 * lab[1] - 1.2914855480 * lab[2];
    l = l * l * l, m = m * m * m, s = s * s * s;
    rgb[0] = 4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s;
    rgb[1] = -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s;
    rgb[2] = -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s;
}

/* A colour by lightness, chroma and hue (degrees); chroma gives way until a screen can show it. */
static void by_hue(double lightness, double chroma, double hue, double lab[3])
{
    for (int less = 0; less < 64; less++) {
        double rgb[3], c = chroma * (64 - less) / 64;
        lab[0] = lightness, lab[1] = c * cos(hue * degree), lab[2] = c * sin(hue * degree);
        from_oklab(lab, rgb);
        if (fmin(fmin(rgb[0], rgb[1]), rgb[2]) >= 0 && fmax(fmax(rgb[0], rgb[1]), rgb[2]) <= 1)
            return;
    }
    lab[0] = lightness, lab[1] = lab[2] = 0;
}

static void put(const double lab[3], float colour[3])
{
    double rgb[3];
    from_oklab(lab, rgb);
    for (int i = 0; i < 3; i++)
        colour[i] = (float)fmin(fmax(rgb[i], 0), 1);
}

/* The path through the colours, s of 0 to 1: not yet of equal steps. Its chroma is smooth, and a screen can show all of
 * it: what had to give way would be seen as a band. */
static void path(double s, double lab[3])
{
    double middle = (2 * s - 1) * (2 * s - 1);
    by_hue(.31 + .61 * s, .102 + (s < .5 ? .040 : .075) * middle, 310 - 203 * s, lab);
}

enum { FINE = 4096 };

void colourmap_make(colourmap *c)
{
    double length[FINE + 1] = {0}, last[3], lab[3];
    path(0, last);
    for (int i = 1; i <= FINE; i++) {
        path((double)i / FINE, lab);
        length[i] =
            length[i - 1] + sqrt((lab[0] - last[0]) * (lab[0] - last[0]) + (lab[1] - last[1]) * (lab[1] - last[1]) +
                                 (lab[2] - last[2]) * (lab[2] - last[2]));
        memcpy(last, lab, sizeof last);
    }
    for (int k = 0, i = 0; k < COLOURMAP_STEPS; k++) {
        double want = length[FINE] * k / (COLOURMAP_STEPS - 1);
        while (i < FINE - 1 && length[i + 1] < want)
            i++;
        double step = length[i + 1] - length[i];
        path((i + (step > 0 ? (want - length[i]) / step : 0)) / FINE, lab);
        put(lab, c->colour[k]);
    }
}

void colourmap_at(const colourmap *c, double t, float colour[3])
{
    if (isnan(t)) {
        colour[0] = colour[1] = colour[2] = .35f;
        return;
    }
    double at = fmin(fmax(t, 0), 1) * (COLOURMAP_STEPS - 1);
    int k = (int)fmin(at, COLOURMAP_STEPS - 2);
    float f = (float)(at - k);
    for (int i = 0; i < 3; i++)
        colour[i] = (1 - f) * c->colour[k][i] + f * c->colour[k + 1][i];
}

void colourmap_name(int64_t i, float colour[3])
{
    static const double lightness[3] = {.74, .60, .86};
    double lab[3], turn = (double)i * .6180339887498949;
    by_hue(lightness[(i + i / 8) % 3], .125, 360 * (turn - floor(turn)) + 40, lab);
    put(lab, colour);
}
