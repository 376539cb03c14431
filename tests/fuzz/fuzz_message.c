/* Any bytes as a message of a page: what is passed on to a tool is one line, short enough and without a comment or a
 * control character; a pose is finite and of length 1; else one error with a text.
 */
// needs: common/console/message.c
#include "console/message.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check_line(const char *line)
{
    if (!*line || strlen(line) > MESSAGE_MOST || strstr(line, " #") || *line == '#')
        abort();
    for (const char *p = line; *p; p++)
        if ((unsigned char)*p < 0x20 || *p == 0x7f)
            abort();
}

static void check_pose(const pose *at)
{
    double row[7], square = 0;
    pose_to_row(at, row);
    for (int i = 0; i < 7; i++)
        if (!isfinite(row[i]))
            abort();
    for (int i = 3; i < 7; i++)
        square += row[i] * row[i];
    if (fabs(square - 1) > 1e-12)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    message m;
    err e = {0};
    const int failed = message_read((const char *)data, size, &m, &e);
    if (failed != (e.text[0] ? -1 : 0) || (unsigned)m.kind >= MESSAGE_KINDS)
        abort();
    if (!failed && (m.kind == MESSAGE_TOOL || m.kind == MESSAGE_IMAGE))
        check_line(m.line);
    if (!failed && m.kind == MESSAGE_OPEN && (!*m.line || strchr(m.line, '\n')))
        abort();
    if (!failed && m.kind == MESSAGE_POSE)
        check_pose(&m.at);
    return 0;
}
