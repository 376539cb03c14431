#include "msds/run/cavities.h"

#include "base/checksum.h"
#include "base/near.h"
#include "base/num.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { NAMES = 256, ITEM = 300 };

/* What a value of a list is of. */
typedef enum what { PRESSURE, OUTFLOW, WALL } what;

static const struct {
    const char *option, *unit, *example;
    double low, high;
} of[] = {
    {"--cavity", "a pressure from -1e7 to 1e7 Pa", "vein=10mmHg", -1e7, 1e7},
    {"--outflow", "from 0 to 1e15 Pa s/m3", "vein=2e8", 0, 1e15},
    {"--wall", "from 0 to 1e9 N/m, Young's modulus times thickness", "artery=400", 0, 1e9},
};

static const char *name_of(const model *m, int32_t volume)
{
    return model_find(m, "volume.name")->str[volume];
}

/* The volume of this name, or -1 with e filled. */
static int find_volume(const model *m, what w, const char *name, err *e)
{
    const model_array *names = model_find(m, "volume.name");
    const char *list[NAMES];
    const int64_t all = names ? names->rows : 0;
    const int count = all < NAMES ? (int)all : NAMES;
    for (int64_t i = 0; i < all; i++)
        if (!strcmp(names->str[i], name))
            return (int)i;
    for (int i = 0; i < count; i++)
        list[i] = names->str[i];
    return near_option(e, of[w].option, "volume", name, list, count);
}

static bool has_elements(const model *m, int32_t volume)
{
    const model_array *a = model_find(m, "element.volume");
    for (int64_t i = 0; a && i < a->rows; i++)
        if (a->i32[i] == volume)
            return true;
    return false;
}

static int read_value(what w, const char *text, double *to)
{
    if (w == PRESSURE ? num_pressure_of(text, to) : num_double(text, to))
        return -1;
    return *to >= of[w].low && *to <= of[w].high ? 0 : -1;
}

/* An item NAME=VALUE: its volume, and its value. */
static int read_item(const model *m, what w, const char *item, int *volume, double *value, err *e)
{
    char name[ITEM];
    const char *equals = strrchr(item, '=');
    if (!equals || equals == item)
        return err_option(e, of[w].option, "'%.100s'; expected NAME=%s, such as %s", item,
                          w == PRESSURE ? "PRESSURE" : "VALUE", of[w].example);
    snprintf(name, sizeof name, "%.*s", (int)(equals - item), item);
    if ((*volume = find_volume(m, w, name, e)) < 0)
        return -1;
    return read_value(w, equals + 1, value)
               ? err_option(e, of[w].option, "'%.100s'; expected %s, such as %s", item, of[w].unit, of[w].example)
               : 0;
}

/* A new cavity where pressures are first said, or the one that there is. */
static msds_cavity *cavity_for(cavities *c, const model *m, what w, int volume, bool add, err *e)
{
    const int at = cavity_of(c->list, c->count, volume);
    if (!add && at < 0)
        err_option(e, of[w].option, "volume '%s' is no cavity; expected --cavity %s=PRESSURE", name_of(m, volume),
                   name_of(m, volume));
    else if (add && at >= 0)
        err_option(e, of[w].option, "volume '%s' is named twice; expected each once", name_of(m, volume));
    else if (add && c->count == CAVITIES_MOST)
        err_option(e, of[w].option, "more than %d cavities; expected at most so many", CAVITIES_MOST);
    else if (add && !has_elements(m, volume))
        err_option(e, of[w].option, "volume '%s' has no element; expected a finer mesh, or another volume",
                   name_of(m, volume));
    else if (add)
        return c->list[c->count] = (msds_cavity){.volume = volume}, &c->list[c->count++];
    else
        return &c->list[at];
    return NULL;
}

static void put(msds_cavity *to, what w, double value, bool add)
{
    if (w == PRESSURE)
        to->pressure = value;
    if (w == PRESSURE && add)
        to->at_rest = value;
    if (w == OUTFLOW)
        to->outflow = value;
    if (w == WALL)
        to->wall = value;
}

static int read_list(cavities *c, what w, const char *text, bool add, const model *m, err *e)
{
    for (const char *p = text, *next; p; p = next) {
        char item[ITEM];
        int volume = -1;
        double value = 0;
        const size_t length = strcspn(p, ",");
        next = p[length] ? p + length + 1 : NULL;
        if (length >= sizeof item)
            return err_option(e, of[w].option, "a name of %zu bytes; expected fewer than %d", length, ITEM);
        snprintf(item, sizeof item, "%.*s", (int)length, p);
        if (read_item(m, w, item, &volume, &value, e))
            return -1;
        msds_cavity *to = cavity_for(c, m, w, volume, add, e);
        if (!to)
            return -1;
        put(to, w, value, add);
    }
    return 0;
}

static int check_tissue(const cavities *c, const model *m, err *e)
{
    const model_array *a = model_find(m, "element.volume");
    for (int64_t i = 0; a && i < a->rows; i++)
        if (cavity_of(c->list, c->count, a->i32[i]) < 0)
            return 0;
    return err_option(e, "--cavity", "all tetrahedra are of cavities; expected others, which are pressed");
}

int cavities_read(cavities *c, const cavities_said *said, const model *m, err *e)
{
    *c = (cavities){.count = 0};
    return read_list(c, PRESSURE, said->pressure, true, m, e) || read_list(c, OUTFLOW, said->outflow, false, m, e) ||
                   read_list(c, WALL, said->wall, false, m, e) || (c->count && check_tissue(c, m, e))
               ? -1
               : 0;
}

int cavities_change(cavities *c, const char *pressures, const model *m, err *e)
{
    cavities made = *c;
    if (read_list(&made, PRESSURE, pressures, false, m, e))
        return -1;
    *c = made;
    return 0;
}

void cavities_put(const cavities *c, msds_problem *p)
{
    p->cavity = c->list;
    p->cavities = c->count;
}

void cavities_text(const cavities *c, const model *m, char *to, size_t size)
{
    uint32_t crc = 0;
    char text[ITEM + 100];
    for (int i = 0; i < c->count; i++) {
        snprintf(text, sizeof text, "%.*s %.17g %.17g %.17g", ITEM, name_of(m, c->list[i].volume), c->list[i].at_rest,
                 c->list[i].outflow, c->list[i].wall);
        crc = checksum_add(crc, text, strlen(text));
    }
    snprintf(to, size, "%d_of_0x%08" PRIx32, c->count, crc);
}
