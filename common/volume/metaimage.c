#include "volume/metaimage.h"

#include "base/mem.h"
#include "volume/header.h"
#include "volume/voxels_in.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a header has said so far. */
typedef struct header {
    in *s;
    volume *v;
    voxels_in x;
    int64_t axes; /* NDims; 0: not yet known */
    bool sized, typed, spaced, binary, ended;
    double spacing[3], direction[9], origin[3];
} header;

bool metaimage_is(const char *line)
{
    static const char *const first[] = {"ObjectType", "NDims", "Comment", "BinaryData", "ObjectSubType"};
    for (size_t i = 0; i < sizeof first / sizeof *first; i++) {
        size_t n = strlen(first[i]);
        if (!strncmp(line, first[i], n) && line[n + strspn(line + n, " \t")] == '=')
            return true;
    }
    return false;
}

/* ---- one key each; value: its text, to be cut */

typedef int take(header *h, const char *key, char *value, err *e);

static int take_truth(const header *h, const char *key, const char *value, bool *to, err *e)
{
    *to = value[0] == 'T' || value[0] == 't' || value[0] == '1' || value[0] == 'Y' || value[0] == 'y';
    if (*to || strchr("Ff0Nn", value[0]))
        return 0;
    return header_bad(h->s, e, key, value, "True or False");
}

/* Lists come after NDims, which says how long they are. */
static int need_axes(const header *h, const char *key, err *e)
{
    return h->axes ? 0 : header_wrong(h->s, e, key, "comes first", "NDims before it");
}

static int take_object(header *h, const char *key, char *value, err *e)
{
    return strcmp(value, "Image") ? header_bad(h->s, e, key, value, "Image") : 0;
}

static int take_axes(header *h, const char *key, char *value, err *e)
{
    return header_integers(h->s, key, value, 2, 3, &h->axes, 1, e);
}

static int take_sizes(header *h, const char *key, char *value, err *e)
{
    h->sized = true;
    return need_axes(h, key, e) || header_integers(h->s, key, value, 1, INT64_MAX, h->v->size, (int)h->axes, e) ? -1
                                                                                                                : 0;
}

static int take_type(header *h, const char *key, char *value, err *e)
{
#define META_NAME(name, of, nrrd, meta, low, high) meta,
    static const char *const name[] = {VOLUME_TYPES(META_NAME)};
    h->typed = true;
    if (!strcmp(value, "MET_LONG") || !strcmp(value, "MET_ULONG"))
        return header_bad(h->s, e, key, value, "a type of one length everywhere, such as MET_INT or MET_LONG_LONG");
    for (int i = 0; i < VOLUME_TYPE_COUNT; i++)
        if (!strcmp(name[i], value)) {
            h->v->type = (volume_type)i;
            return 0;
        }
    return header_bad(h->s, e, key, value, "MET_UCHAR, MET_SHORT, MET_FLOAT or another of one number");
}

static int take_channels(header *h, const char *key, char *value, err *e)
{
    int64_t channels;
    return header_integers(h->s, key, value, 1, 1, &channels, 1, e);
}

static int take_positive(header *h, const char *key, char *value, double *to, err *e)
{
    if (need_axes(h, key, e) || header_numbers(h->s, key, value, to, (int)h->axes, e))
        return -1;
    for (int a = 0; a < h->axes; a++)
        if (!(to[a] > 0))
            return header_wrong(h->s, e, key, "a distance that is not above 0", "distances between voxels, mm");
    return 0;
}

static int take_spacing(header *h, const char *key, char *value, err *e)
{
    h->spaced = true;
    return take_positive(h, key, value, h->spacing, e);
}

/* The size of a voxel, which is their distance where nothing else says it. */
static int take_size(header *h, const char *key, char *value, err *e)
{
    double size[3] = {1, 1, 1};
    if (take_positive(h, key, value, size, e))
        return -1;
    if (!h->spaced)
        memcpy(h->spacing, size, sizeof size);
    return 0;
}

static int take_direction(header *h, const char *key, char *value, err *e)
{
    int n = (int)h->axes;
    double d[9];
    if (need_axes(h, key, e) || header_numbers(h->s, key, value, d, n * n, e))
        return -1;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            h->direction[3 * i + j] = d[n * i + j];
    for (int i = 0; i < n; i++) {
        const double *row = &h->direction[3 * i];
        double length = sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
        if (!(fabs(length - 1) <= .01))
            return header_wrong(h->s, e, key, "a direction whose length is not 1", "unit vectors");
    }
    return 0;
}

static int take_origin(header *h, const char *key, char *value, err *e)
{
    return need_axes(h, key, e) || header_numbers(h->s, key, value, h->origin, (int)h->axes, e) ? -1 : 0;
}

static int take_binary(header *h, const char *key, char *value, err *e)
{
    return take_truth(h, key, value, &h->binary, e);
}

static int take_order(header *h, const char *key, char *value, err *e)
{
    return take_truth(h, key, value, &h->x.big, e);
}

static int take_compressed(header *h, const char *key, char *value, err *e)
{
    bool compressed;
    if (take_truth(h, key, value, &compressed, e))
        return -1;
    h->x.encoding = compressed ? VOXELS_DEFLATED : VOXELS_RAW;
    return 0;
}

static int take_skip(header *h, const char *key, char *value, err *e)
{
    return header_integers(h->s, key, value, -1, INT64_MAX, &h->x.bytes, 1, e);
}

static int take_file(header *h, const char *key, char *value, err *e)
{
    h->ended = true;
    if (!strcmp(value, "LOCAL") || !strcmp(value, "Local") || !strcmp(value, "local"))
        return 0;
    if (!*value || !strncmp(value, "LIST", 4) || strchr(value, '%'))
        return header_bad(h->s, e, key, value, "LOCAL, or one file");
    h->x.file = mem_text(value, e);
    return h->x.file ? 0 : -1;
}

static const struct {
    const char *key;
    take *take;
} keys[] = {
    {"ObjectType", take_object},
    {"NDims", take_axes},
    {"DimSize", take_sizes},
    {"ElementType", take_type},
    {"ElementNumberOfChannels", take_channels},
    {"ElementSpacing", take_spacing},
    {"ElementSize", take_size},
    {"TransformMatrix", take_direction},
    {"Rotation", take_direction},
    {"Orientation", take_direction},
    {"Offset", take_origin},
    {"Position", take_origin},
    {"Origin", take_origin},
    {"BinaryData", take_binary},
    {"BinaryDataByteOrderMSB", take_order},
    {"ElementByteOrderMSB", take_order},
    {"CompressedData", take_compressed},
    {"HeaderSize", take_skip},
    {"ElementDataFile", take_file},
};

static int take_line(header *h, char *line, err *e)
{
    char *equals = strchr(line, '=');
    if (!equals)
        return *header_trim(line) ? header_bad(h->s, e, "the header", line, "KEY = VALUE") : 0;
    *equals = '\0';
    char *key = header_trim(line), *value = header_trim(equals + 1);
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (!strcmp(keys[i].key, key))
            return keys[i].take(h, key, value, e);
    return 0;
}

static int take_header(header *h, char *line, err *e)
{
    while (!h->ended) {
        if (take_line(h, line, e))
            return -1;
        int64_t length = h->ended ? 0 : in_line(h->s, &line, NULL, e);
        if (length == -1)
            return err_set(e, in_name(h->s), in_lines(h->s), "the header ends here; expected ElementDataFile");
        if (length < 0)
            return -1;
    }
    if (h->axes && h->sized && h->typed)
        return 0;
    const char *lacking = h->sized ? "ElementType" : "DimSize";
    return err_set(e, in_name(h->s), in_lines(h->s), "a header without %s; expected it before ElementDataFile",
                   h->axes ? lacking : "NDims");
}

/* The third direction of an image in a plane is that plane's normal. */
static void take_geometry(header *h)
{
    double *d = h->direction;
    if (h->axes == 2) {
        h->v->size[2] = 1;
        d[6] = d[7] = 0;
        d[8] = d[0] * d[4] - d[1] * d[3];
    }
    for (int a = 0; a < 3; a++) {
        h->v->origin[a] = h->origin[a];
        for (int b = 0; b < 3; b++)
            h->v->axis[a][b] = h->spacing[a] * d[3 * a + b];
    }
}

int metaimage_read(volume *v, in *s, char *line, const char *path, const volume_budget *b, err *e)
{
    header h = {.s = s, .v = v, .binary = true, .spacing = {1, 1, 1}, .direction = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    int status = take_header(&h, line, e);
    if (!status) {
        take_geometry(&h);
        status = volume_check(v, in_name(s), in_lines(s), e);
    }
    if (!status && !h.binary && h.x.encoding == VOXELS_DEFLATED)
        status =
            err_set(e, in_name(s), in_lines(s), "BinaryData = False and CompressedData = True; expected one of them");
    if (!h.binary)
        h.x.encoding = VOXELS_TEXT;
    if (!status && h.x.bytes < 0 && h.x.encoding != VOXELS_RAW)
        status =
            err_set(e, in_name(s), in_lines(s), "HeaderSize = -1 with data that are not raw bytes; expected 0 or more");
    if (!status)
        status = voxels_in_read(v, &h.x, s, path, b, e);
    free(h.x.file);
    return status;
}
