#include "place/links.h"

#include "base/space.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

int links_split(const char *name, size_t length, char *from, char *to)
{
    for (size_t i = 1; i + 2 < length; i++) {
        if (name[i] != 'T' || name[i + 1] != 'o' || !isupper((unsigned char)name[i + 2]))
            continue;
        if (i >= LINKS_NAME || length - i - 2 >= LINKS_NAME)
            return -1;
        snprintf(from, LINKS_NAME, "%.*s", (int)i, name);
        snprintf(to, LINKS_NAME, "%.*s", (int)(length - i - 2), name + i + 2);
        return 0;
    }
    return -1;
}

/* Frames of reference that are reached, each with what takes `from` to it. */
typedef struct reached {
    int count;
    const char *name[2 * LINKS_MOST + 1];
    double m[2 * LINKS_MOST + 1][16];
} reached;

static int find_reached(const reached *r, const char *name)
{
    for (int i = 0; i < r->count; i++)
        if (!strcmp(r->name[i], name))
            return i;
    return -1;
}

/* Goes over one transform, either way. True: a new one is reached. */
static bool reach(reached *r, const links_transform *t)
{
    int from = find_reached(r, t->from), to = find_reached(r, t->to);
    double back[16];
    if ((from < 0) == (to < 0) || (from < 0 && space_inverse(t->m, back)))
        return false;
    if (to < 0)
        space_product(t->m, r->m[from], r->m[r->count]);
    else
        space_product(back, r->m[to], r->m[r->count]);
    r->name[r->count++] = to < 0 ? t->to : t->from;
    return true;
}

bool links_compose(const links_transform *list, int count, const char *from, const char *to, bool bad, double m[16])
{
    reached r = {.count = 1, .name = {from}};
    bool more = true;
    for (int i = 0; i < 16; i += 5)
        r.m[0][i] = 1;
    while (more && find_reached(&r, to) < 0) {
        more = false;
        for (int i = 0; i < count; i++) {
            const links_transform *t = &list[i];
            more |= t->set && (bad || !t->bad) && reach(&r, t);
        }
    }
    int at = find_reached(&r, to);
    if (at >= 0)
        memcpy(m, r.m[at], sizeof r.m[at]);
    return at >= 0;
}

void links_list(const links_transform *list, int count, char text[LINKS_LIST])
{
    size_t used = 0;
    snprintf(text, LINKS_LIST, "(none)");
    for (int i = 0; i < count && used < LINKS_LIST; i++)
        used += (size_t)snprintf(text + used, LINKS_LIST - used, "%s%sTo%s", i ? ", " : "", list[i].from, list[i].to);
}
