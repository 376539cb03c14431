#include "probe/plus.h"

#include "base/chars.h"
#include "base/num.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

int plus_open(plus *p, in *source, const char *transform, err *e)
{
    *p = (plus){.source = source, .frame = {.number = -1}};
    int first = in_peek(source, e);
    if (first == -2)
        return -1;
    if (transform && links_split(transform, strlen(transform), p->from, p->to))
        return err_usage(e, "'%.100s' is not a transform; expected FROMToTO, such as ProbeToReference", transform);
    p->nrrd = false;
    return 0;
}

/* ---- one key */

static int bad_line(const plus *p, err *e, const char *what, const char *expected)
{
    return err_set(e, in_name(p->source), in_lines(p->source), "%.110s; expected %s", what, expected);
}

/* The same of a key, as the file has it. */
static int bad_key(const plus *p, err *e, const char *key, const char *expected)
{
    char quoted[110];
    snprintf(quoted, sizeof quoted, "'%.100s'", key);
    return bad_line(p, e, quoted, expected);
}

static char *trim(char *text)
{
    while (chars_blank(*text))
        text++;
    for (char *end = text + strlen(text); end > text && chars_blank(end[-1]);)
        *--end = '\0';
    return text;
}

/* Cuts "key = value" (MetaImage) or "key:=value", "key: value" (NRRD). NULL: the line is neither. */
static char *cut(char *line)
{
    char *at = strpbrk(line, ":=");
    if (!at)
        return NULL;
    size_t wide = at[0] == ':' && at[1] == '=' ? 2 : 1;
    *at = '\0';
    return trim(at + wide);
}

/* Numbers between blanks. Returns how many, or -1 where it is not all numbers or more than most. */
static int take_numbers(const char *text, double *to, int most)
{
    const char *end = text + strlen(text);
    int count = 0;
    while (*text) {
        const char *stop;
        if (count == most || num_scan(text, end, &stop, &to[count]) || (*stop && !chars_blank(*stop)))
            return -1;
        count++;
        for (text = stop; chars_blank(*text);)
            text++;
    }
    return count;
}

/* The transform of that name in the frame, made where it is new. */
static links_transform *transform_of(plus *p, const char *name, size_t length, err *e)
{
    links_transform t = {0};
    if (links_split(name, length, t.from, t.to)) {
        bad_key(p, e, name, "Seq_FrameNNNN_FROMToTOTransform, of shorter names");
        return NULL;
    }
    for (int i = 0; i < p->frame.count; i++)
        if (!strcmp(p->frame.transform[i].from, t.from) && !strcmp(p->frame.transform[i].to, t.to))
            return &p->frame.transform[i];
    if (p->frame.count == PLUS_TRANSFORMS) {
        bad_key(p, e, name, "fewer transforms in a frame");
        return NULL;
    }
    p->frame.transform[p->frame.count] = t;
    return &p->frame.transform[p->frame.count++];
}

static bool ends_with(const char *text, size_t length, const char *ending)
{
    size_t n = strlen(ending);
    return length > n && !memcmp(text + length - n, ending, n);
}

static int take_matrix(plus *p, const char *name, size_t length, const char *value, err *e)
{
    links_transform *t = transform_of(p, name, length, e);
    if (!t)
        return -1;
    if (t->set)
        return bad_key(p, e, name, "each transform of a frame once");
    if (take_numbers(value, t->m, 16) != 16)
        return bad_key(p, e, name, "16 finite numbers");
    for (int i = 0; i < 4; i++)
        if (fabs(t->m[12 + i] - (i == 3)) > 0)
            return bad_key(p, e, name, "0 0 0 1 as the last of its four rows");
    t->set = true;
    return 0;
}

/* A key of the present frame, after its number. What is not of a pose passes. */
static int take_key(plus *p, const char *key, const char *value, err *e)
{
    static const char matrix[] = "Transform", status[] = "TransformStatus";
    size_t n = strlen(key);
    p->frame.line = in_lines(p->source);
    if (ends_with(key, n, matrix))
        return take_matrix(p, key, n - strlen(matrix), value, e);
    if (ends_with(key, n, status)) {
        links_transform *t = transform_of(p, key, n - strlen(status), e);
        if (t)
            t->bad = strcmp(value, "OK") != 0;
        return t ? 0 : -1;
    }
    if (!strcmp(key, "Timestamp") && num_double(value, &p->frame.time))
        return bad_line(p, e, "Timestamp", "a finite number, s");
    return 0;
}

/* The number of the frame that a key is of, and where its own name begins; -1: it is of none. */
static int64_t frame_of(const char *line, const char **key)
{
    static const char begin[] = "Seq_Frame";
    int64_t number = 0;
    int digits = 0;
    if (strncmp(line, begin, strlen(begin)))
        return -1;
    const char *p = line + strlen(begin);
    for (; isdigit((unsigned char)*p) && digits < 12; p++, digits++)
        number = number * 10 + (*p - '0');
    if (!digits || *p != '_')
        return -1;
    *key = p + 1;
    return number;
}

/* What all images have: the first size (of MetaImage's DimSize, NRRD's sizes), and where their axes point. */
static void take_images(plus *p, const char *key, const char *value)
{
    if (!strcmp(key, "UltrasoundImageOrientation"))
        snprintf(p->orientation, sizeof p->orientation, "%s", value);
    double size[4];
    if ((!strcmp(key, "DimSize") || !strcmp(key, "sizes")) && take_numbers(value, size, 4) > 0 && size[0] >= 1 &&
        size[0] <= 1e6)
        p->width = (int64_t)size[0];
}

static void begin_frame(plus *p, int64_t number)
{
    p->frame = (plus_frame){.number = number, .time = (double)NAN};
}

/* One line of the header. 1: it begins the next frame, and is held; 0; -1. */
static int take_line(plus *p, char *line, err *e)
{
    const char *key = NULL;
    int64_t number = frame_of(line, &key);
    if (number >= 0 && p->frame.number >= 0 && number != p->frame.number) {
        if (number < p->frame.number)
            return bad_line(p, e, "a frame that comes after a later one", "frames in ascending order");
        p->held = line;
        return 1;
    }
    char *value = cut(line);
    if (!value)
        return 0;
    trim(line);
    if (number < 0) {
        take_images(p, line, value);
        p->ended |= !p->nrrd && !strcmp(line, "ElementDataFile");
        return 0;
    }
    if (p->frame.number < 0)
        begin_frame(p, number);
    return take_key(p, key, value, e);
}

/* Reads the keys of one frame. 1: all of them are there; 0: there is no more frame. */
static int read_frame(plus *p, err *e)
{
    char *line = p->held;
    begin_frame(p, -1);
    p->held = NULL;
    int status = line ? take_line(p, line, e) : 0;
    while (!status && !p->ended) {
        int64_t length = in_line(p->source, &line, NULL, e);
        if (length == -2)
            return -1;
        if (in_lines(p->source) == 1)
            p->nrrd = !strncmp(line, "NRRD", 4);
        p->ended = length == -1 || (p->nrrd && length == 0);
        if (!p->ended)
            status = take_line(p, line, e);
    }
    return status < 0 ? -1 : p->frame.number >= 0;
}

/* ---- composing */

static bool compose(const plus *p, const char *from, const char *to, bool bad, double m[16])
{
    return links_compose(p->frame.transform, p->frame.count, from, to, bad, m);
}

static int refuse(const plus *p, err *e)
{
    const char *from = p->from[0] ? p->from : "Image or Probe";
    const char *to = p->to[0] ? p->to : "Reference or Tracker";
    char list[LINKS_LIST];
    links_list(p->frame.transform, p->frame.count, list);
    return err_set(e, in_name(p->source), p->frame.line,
                   "frame %" PRId64 " does not say where %s is in %s; expected transforms that do, among: '%s'",
                   p->frame.number, from, to, list);
}

/* What the first frame can give, for all. */
static int choose(plus *p, err *e)
{
    static const char *const from[] = {"Image", "Probe"}, *const to[] = {"Reference", "Tracker"};
    double m[16];
    for (int i = 0; i < 4; i++)
        if (compose(p, from[i % 2], to[i / 2], true, m)) {
            snprintf(p->from, sizeof p->from, "%s", from[i % 2]);
            snprintf(p->to, sizeof p->to, "%s", to[i / 2]);
            return 0;
        }
    return refuse(p, e);
}

int plus_next(plus *p, double *time, int64_t *line, double m[16], err *e)
{
    for (;;) {
        int more = read_frame(p, e);
        if (more <= 0)
            return more;
        if (!p->from[0] && choose(p, e))
            return -1;
        if (isnan(p->frame.time))
            return err_set(e, in_name(p->source), p->frame.line, "frame %" PRId64 " has no Timestamp; expected one, s",
                           p->frame.number);
        *time = p->frame.time;
        *line = p->frame.line;
        if (compose(p, p->from, p->to, false, m))
            return 1;
        if (!compose(p, p->from, p->to, true, m))
            return refuse(p, e);
        p->skipped++;
    }
}
