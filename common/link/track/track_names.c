#include "link/track/track_names.h"

#include "cli/listing.h"

#include <stdio.h>
#include <string.h>

/* As base/probe has them of a sequence; images' frames are not a probe's. */
static const char *const order[] = {"ProbeToReference", "ProbeToTracker"};

static const track_row *find_pose(const track_names *n, const char *name, int below)
{
    for (int i = 0; i < below; i++)
        if (n->row[i].is_pose && !strcmp(n->row[i].name, name))
            return &n->row[i];
    return NULL;
}

bool track_names_add(track_names *n, const char *type, const char *name, bool is_pose, double now)
{
    for (int i = 0; i < n->count; i++) {
        track_row *row = &n->row[i];
        if (strcmp(row->type, type) != 0 || strcmp(row->name, name) != 0)
            continue;
        row->count++;
        row->last = now;
        return false;
    }
    if (n->count == TRACK_ROWS)
        return false;
    n->poses += is_pose && !find_pose(n, name, n->count);
    track_row *row = &n->row[n->count++];
    *row = (track_row){.is_pose = is_pose, .count = 1, .first = now, .last = now};
    snprintf(row->type, sizeof row->type, "%s", type);
    snprintf(row->name, sizeof row->name, "%s", name);
    return true;
}

void track_names_list(const track_names *n, char to[TRACK_LIST])
{
    listing l = {0};
    for (int i = 0; i < n->count; i++)
        if (n->row[i].is_pose && !find_pose(n, n->row[i].name, i))
            listing_add(&l, "%s", n->row[i].name);
    snprintf(to, TRACK_LIST, "%s", n->poses ? listing_text(&l) : "");
}

double track_names_rate(const track_row *row)
{
    const double time = row->last - row->first;
    return time > 0 ? (double)(row->count - 1) / time : 0;
}

const char *track_names_choose(const track_names *n)
{
    const char *only = NULL;
    for (size_t k = 0; k < sizeof order / sizeof *order; k++) {
        const track_row *row = find_pose(n, order[k], n->count);
        if (row)
            return row->name;
    }
    for (int i = 0; i < n->count && n->poses == 1; i++)
        if (n->row[i].is_pose)
            only = n->row[i].name;
    return only;
}

bool track_names_is_first(const char *name)
{
    return !strcmp(name, order[0]);
}
