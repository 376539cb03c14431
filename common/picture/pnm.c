#include "picture/pnm.h"

#include "base/mem.h"
#include "base/num.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static int wrong(in *s, err *e, const char *what)
{
    return err_set(e, in_name(s), 0, "%s; expected images as us-slice writes them", what);
}

/* Up to `count` numbers between blanks. False: there are fewer. */
static bool take_numbers(const char **at, const char *end, double *to, int count)
{
    for (int i = 0; i < count; i++) {
        *at += strspn(*at, " ");
        if (num_scan(*at, end, at, &to[i]))
            return false;
    }
    return true;
}

/* "# us-slice: X Y Z ...": nine numbers, and those after "fan". Other comments are let be. */
static void take_comment(const char *line, pnm *p)
{
    static const char mark[] = "# us-slice:", fan[] = " fan";
    double plane[9];
    if (strncmp(line, mark, strlen(mark)) != 0)
        return;
    const char *at = line + strlen(mark), *end = line + strlen(line);
    if (!take_numbers(&at, end, plane, 9))
        return;
    memcpy(p->plane, plane, sizeof plane);
    p->has_plane = true;
    if (strncmp(at, fan, strlen(fan)) != 0)
        return;
    at += strlen(fan);
    p->has_fan = take_numbers(&at, end, p->fan, 4);
}

/* The next line that is no comment. Its length; -1: the end, -2: e filled. */
static int64_t next_line(in *s, pnm *p, char **line, err *e)
{
    int64_t n;
    while ((n = in_line(s, line, NULL, e)) >= 0 && **line == '#')
        take_comment(*line, p);
    return n;
}

static int take_size(in *s, const char *line, pnm *p, err *e)
{
    char *end;
    const long columns = strtol(line, &end, 10), rows = strtol(end, &end, 10);
    if (*end || columns < 1 || rows < 1 || columns > PNM_SIDE_MOST || rows > PNM_SIDE_MOST)
        return wrong(s, e, "an image without a size");
    p->columns = (int)columns;
    p->rows = (int)rows;
    return 0;
}

static int take_header(in *s, pnm *p, err *e)
{
    char *line;
    int64_t n = next_line(s, p, &line, e);
    if (n < 0)
        return n == -1 ? 0 : -1;
    if (strcmp(line, "P5") != 0 && strcmp(line, "P6") != 0)
        return wrong(s, e, "neither PGM nor PPM");
    p->channels = line[1] == '5' ? 1 : 3;
    n = next_line(s, p, &line, e);
    if (n < 0 || take_size(s, line, p, e))
        return n < -1 ? -1 : wrong(s, e, "an image without a size");
    n = next_line(s, p, &line, e);
    if (n < 0 || strcmp(line, "255") != 0)
        return n < -1 ? -1 : wrong(s, e, "an image of other levels than 255");
    return 1;
}

int pnm_next(in *s, pnm *p, err *e)
{
    p->has_plane = p->has_fan = false;
    const int got = take_header(s, p, e);
    if (got <= 0)
        return got;
    const int64_t size = (int64_t)p->columns * p->rows * p->channels;
    if (MEM_ROOM(&p->pixel, &p->capacity, size, "an image", e))
        return -1;
    const int64_t n = in_read(s, p->pixel, (size_t)size, e);
    if (n < 0)
        return -1;
    return n == size ? 1 : wrong(s, e, "an image that is cut short");
}

void pnm_free(pnm *p)
{
    free(p->pixel);
    *p = (pnm){0};
}
