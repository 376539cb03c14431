#include "console/dials.h"

#include "console/json.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PROBE_USUAL "linear:4cm,1cm"

static const dial msds[] = {
    {"probe", "", PROBE_USUAL, "shape of the probe: sphere:R, linear:W,T or curved:R,ANGLE,T", 0, 0, NULL},
    {"iterations", "", "20", "steps of springs, or iterations of finite elements, a frame", 1, 1000, NULL},
    {"rate", "Hz", "60", "frames a second that --iterations are for", 0, 1000, NULL},
    {"dt", "s", "0.01", "time step of springs", 1e-5, 1, NULL},
    {"mass", "", "stable", "inertia of springs: made stable, or as it is", 0, 0, "stable|lumped"},
    {"damping", "s", "0.1", "damping of a spring over its stiffness", 0, 10, NULL},
    {"spring-scale", "m", "auto", "stiffness of a spring over Young's modulus, or auto", 0, 0, NULL},
    {"repulsion", "", "1", "contact stiffness over that of a node's springs", 0, 100, NULL},
    {"contact", "", "prescribed", "contact in finite elements", 0, 0, "prescribed|penalty"},
    {"friction", "", "0", "friction with the probe: fem, warp, tissue", 0, 10, NULL},
    {"gravity", "m/s2", "0,0,0", "gravity", 0, 0, NULL},
    {"skin-stiffness", "N/m", "100", "stiffness of the edges of a skin of its own", 1e-9, 1e9, NULL},
    {"skin-anchors", "", "0.01", "stiffness of a vertex's anchor over that of its springs", 1e-6, 1e6, NULL},
    {"skin-tension", "", "0.5", "stiffness of an edge across itself over that along it", 0, 1e3, NULL},
    {0},
};

static const dial slice[] = {
    {"gain", "dB", "0", "gain of the whole image", -200, 200, NULL},
    {"tgc", "dB", "0", "gains at equal steps from the face to the depth", 0, 0, NULL},
    {"dynamic-range", "dB", "60,60", "echoes so far below the strongest are shown", 0, 0, NULL},
    {"depth", "m", "0.05", "depth of the image along a beam", 1e-3, 1, NULL},
    {"width", "m", "0", "width of the image; 0: the array's", 0, 1, NULL},
    {"thickness", "m", "0", "thickness of the beam; 0: one slice", 0, .1, NULL},
    {"coupling", "m", "0", "gel: lines are dark where the face is farther from tissue; 0: none", 0, .1, NULL},
    {"freeze", "", "off", "the image stays as it is", 0, 0, "on|off"},
    {"labels", "", "on", "labels are tinted", 0, 0, "on|off"},
    {0},
};

/* The rest are muscles and pulls, which are verbs of their own. */
static const dial tled[] = {{"gravity", "m/s2", "0,0,0", "gravity", 0, 0, NULL}, {0}};

static dials begin(const dial *table)
{
    dials d = {.table = table};
    for (int i = 0; table[i].key; i++)
        snprintf(d.value[i], DIALS_VALUE, "%s", table[i].usual);
    return d;
}

/* A parameter without a value is not offered. */
static void drop(dials *d, const char *beginning)
{
    for (int i = 0; i < DIALS_MOST && d->table[i].key; i++)
        if (!strncmp(d->table[i].key, beginning, strlen(beginning)))
            d->value[i][0] = '\0';
}

dials dials_of_msds(bool skin)
{
    dials d = begin(msds);
    if (!skin)
        drop(&d, "skin-");
    return d;
}

dials dials_of_slice(bool labels)
{
    dials d = begin(slice);
    if (!labels)
        drop(&d, "labels");
    return d;
}

dials dials_of_tled(void)
{
    return begin(tled);
}

static int find(const dials *d, const char *key, size_t n)
{
    for (int i = 0; d->table && d->table[i].key; i++)
        if (strlen(d->table[i].key) == n && !strncmp(d->table[i].key, key, n))
            return i;
    return -1;
}

void dials_note(dials *d, const char *line)
{
    if (strncmp(line, "set ", 4) != 0 && strncmp(line, "now ", 4) != 0)
        return;
    const char *key = line + 4;
    const size_t n = strcspn(key, " ");
    const int i = find(d, key, n);
    if (i >= 0 && key[n])
        snprintf(d->value[i], DIALS_VALUE, "%s", key + n + 1);
}

const char *dials_value(const dials *d, const char *key)
{
    const int i = find(d, key, strlen(key));
    return i >= 0 ? d->value[i] : NULL;
}

static void put_choices(const char *choices, out *to)
{
    char word[40];
    out_text(to, ",\"choices\":[");
    for (const char *p = choices; *p; p += strcspn(p, "|"), p += *p == '|') {
        snprintf(word, sizeof word, "%.*s", (int)strcspn(p, "|"), p);
        out_text(to, p == choices ? "" : ",");
        json_text(word, to);
    }
    out_text(to, "]");
}

static void put_text(const char *key, const char *text, out *to)
{
    out_format(to, ",\"%s\":", key);
    json_text(text, to);
}

static void put_dial(const dial *d, const char *value, out *to)
{
    const bool any = d->low >= d->high;
    json_text(d->key, to);
    out_text(to, ":{\"value\":");
    json_text(value, to);
    put_text("unit", d->unit, to);
    put_text("default", d->usual, to);
    put_text("help", d->help, to);
    out_text(to, ",\"min\":");
    json_number(any ? (double)NAN : d->low, to);
    out_text(to, ",\"max\":");
    json_number(any ? (double)NAN : d->high, to);
    if (d->choices)
        put_choices(d->choices, to);
    out_text(to, "}");
}

void dials_put(const dials *d, out *to)
{
    const char *comma = "";
    out_text(to, "{");
    for (int i = 0; d->table && d->table[i].key; i++) {
        if (!*d->value[i])
            continue;
        out_text(to, comma);
        put_dial(&d->table[i], d->value[i], to);
        comma = ",";
    }
    out_text(to, "}");
}
