#include "link/track/track_pose.h"

#include "base/chars.h"
#include "base/pose.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

track_kind track_kind_of(const igtl_header *h)
{
    static const char *const type[TRACK_KINDS] = {"TRANSFORM", "POSITION", "TDATA"};
    int i = 0;
    while (i < TRACK_KINDS && strcmp(h->type, type[i]) != 0)
        i++;
    return (track_kind)i;
}

int track_pose_count(const igtl_message *m, int *count, const char *place, err *e)
{
    *count = 1;
    return track_kind_of(&m->header) == TRACK_TOOLS ? igtl_count_tools(m, count, place, e) : 0;
}

/* ---- metadata */

/* Whether a key is `begin` and `end`; a beginning that fills its field may have been cut. */
static bool is_key(const igtl_meta *at, const char *begin, const char *end)
{
    const size_t n = strlen(begin), n_end = strlen(end);
    const bool whole = at->key_size == n + n_end, cut = n == IGTL_DEVICE && at->key_size > n + n_end;
    return (whole || cut) && !memcmp(at->key, begin, n) && !memcmp(at->key + at->key_size - n_end, end, n_end);
}

/* The value, cut to `size` - 1 bytes and printable, of the first such key. */
static bool find_meta(const igtl_message *m, const char *begin, const char *end, char *to, size_t size)
{
    igtl_meta at;
    for (int i = 0; i < m->metas; i++) {
        igtl_meta_step(m, i, &at);
        if (!is_key(&at, begin, end))
            continue;
        const size_t n = at.value_size < size - 1 ? at.value_size : size - 1;
        memcpy(to, at.value, n);
        to[n] = '\0';
        chars_tame(to);
        return true;
    }
    return false;
}

void track_pose_status(const igtl_message *m, track_pose *to)
{
    char status[24];
    const bool has = to->kind == TRACK_TOOLS ? find_meta(m, to->name, "Status", status, sizeof status)
                                             : find_meta(m, "TransformStatus", "", status, sizeof status);
    if (has && strcmp(status, "OK") != 0)
        snprintf(to->lost, sizeof to->lost, "it is %s", status);
}

/* ---- contents */

static void put_quaternion(double matrix[16], const double position[3], double quaternion[4], char lost[40])
{
    double r[9];
    if (!pose_is_unit(pose_unit(quaternion)))
        snprintf(lost, 40, "its quaternion is not of length 1");
    pose_matrix(quaternion, r);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            matrix[4 * i + k] = r[3 * i + k];
        matrix[4 * i + 3] = position[i];
        matrix[12 + i] = 0;
    }
    matrix[15] = 1;
}

static int read_content(const igtl_message *m, int i, track_pose *to, const char *place, err *e)
{
    double position[3], quaternion[4];
    igtl_tool tool;
    if (to->kind == TRACK_TRANSFORM)
        return igtl_read_transform(m, to->matrix, place, e);
    if (to->kind == TRACK_TOOLS) {
        igtl_read_tool(m, i, &tool);
        memcpy(to->matrix, tool.matrix, sizeof to->matrix);
        snprintf(to->name, sizeof to->name, "%s", tool.name);
        return 0;
    }
    if (igtl_read_position(m, position, quaternion, place, e))
        return -1;
    put_quaternion(to->matrix, position, quaternion, to->lost);
    return 0;
}

/* Where there is nothing to turn by. */
static void check_matrix(track_pose *to)
{
    double most = 0;
    bool finite = true;
    for (int i = 0; i < 12; i++) {
        finite = finite && isfinite(to->matrix[i]);
        if (i % 4 < 3)
            most = fmax(most, fabs(to->matrix[i]));
    }
    if (!finite)
        snprintf(to->lost, sizeof to->lost, "its numbers are not finite");
    else if (!(most > 0))
        snprintf(to->lost, sizeof to->lost, "its matrix is 0");
}

int track_pose_read(const igtl_message *m, int i, track_pose *to, const char *place, err *e)
{
    *to = (track_pose){.kind = track_kind_of(&m->header), .stamp = m->header.stamp};
    snprintf(to->name, sizeof to->name, "%s", m->header.device);
    if (read_content(m, i, to, place, e))
        return -1;
    if (to->kind != TRACK_TOOLS)
        find_meta(m, "IGTL_DEVICE_NAME", "", to->name, sizeof to->name);
    chars_tame(to->name);
    check_matrix(to);
    return 0;
}

bool track_pose_is(const track_pose *p, const char *name)
{
    const size_t n = strlen(p->name);
    return !strcmp(p->name, name) || (n == IGTL_DEVICE && strlen(name) > n && !strncmp(p->name, name, n));
}
