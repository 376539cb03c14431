#include "volume/nrrd.h"

#include "base/mem.h"
#include "base/num.h"
#include "volume/header.h"
#include "volume/nrrd_labels.h"
#include "volume/voxels_in.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { AXES = 16 }; /* NRRD's own most */

typedef struct axis {
    int64_t size;
    char kind[24]; /* "": not given */
    double spacing;
    double direction[3];
    bool directed; /* its direction is one, not `none` */
} axis;

/* What a header has said so far. */
typedef struct header {
    in *s;
    volume *v;
    voxels_in x;
    labels_in labels;
    int64_t axes;
    axis axis[AXES];
    bool typed, sized, encoded, ordered, directed, spaced;
    double sign[3]; /* from the file's space to LPS */
    double unit[3]; /* of its numbers, in mm */
    double origin[3];
} header;

bool nrrd_is(const char *line)
{
    return !strncmp(line, "NRRD000", 7) && line[7] >= '1' && line[7] <= '9' && !line[8];
}

/* ---- one field each; value: its text, to be cut */

typedef int take(header *h, const char *field, char *value, err *e);

static int need_axes(const header *h, const char *field, err *e)
{
    return h->axes ? 0 : header_wrong(h->s, e, field, "comes first", "dimension before it");
}

static int take_dimension(header *h, const char *field, char *value, err *e)
{
    return header_integers(h->s, field, value, 1, AXES, &h->axes, 1, e);
}

static int take_sizes(header *h, const char *field, char *value, err *e)
{
    int64_t size[AXES];
    if (need_axes(h, field, e) || header_integers(h->s, field, value, 1, INT64_MAX, size, (int)h->axes, e))
        return -1;
    for (int a = 0; a < h->axes; a++)
        h->axis[a].size = size[a];
    h->sized = true;
    return 0;
}

static const struct {
    const char *name;
    volume_type type;
} type_names[] = {
    {"signed char", VOLUME_I8},
    {"int8", VOLUME_I8},
    {"int8_t", VOLUME_I8},
    {"uchar", VOLUME_U8},
    {"unsigned char", VOLUME_U8},
    {"uint8", VOLUME_U8},
    {"uint8_t", VOLUME_U8},
    {"short", VOLUME_I16},
    {"short int", VOLUME_I16},
    {"signed short", VOLUME_I16},
    {"signed short int", VOLUME_I16},
    {"int16", VOLUME_I16},
    {"int16_t", VOLUME_I16},
    {"ushort", VOLUME_U16},
    {"unsigned short", VOLUME_U16},
    {"unsigned short int", VOLUME_U16},
    {"uint16", VOLUME_U16},
    {"uint16_t", VOLUME_U16},
    {"int", VOLUME_I32},
    {"signed int", VOLUME_I32},
    {"int32", VOLUME_I32},
    {"int32_t", VOLUME_I32},
    {"uint", VOLUME_U32},
    {"unsigned int", VOLUME_U32},
    {"uint32", VOLUME_U32},
    {"uint32_t", VOLUME_U32},
    {"longlong", VOLUME_I64},
    {"long long", VOLUME_I64},
    {"long long int", VOLUME_I64},
    {"signed long long", VOLUME_I64},
    {"signed long long int", VOLUME_I64},
    {"int64", VOLUME_I64},
    {"int64_t", VOLUME_I64},
    {"ulonglong", VOLUME_U64},
    {"unsigned long long", VOLUME_U64},
    {"unsigned long long int", VOLUME_U64},
    {"uint64", VOLUME_U64},
    {"uint64_t", VOLUME_U64},
    {"float", VOLUME_F32},
    {"double", VOLUME_F64},
};

static int take_type(header *h, const char *field, char *value, err *e)
{
    h->typed = true;
    for (size_t i = 0; i < sizeof type_names / sizeof *type_names; i++)
        if (!strcmp(type_names[i].name, value)) {
            h->v->type = type_names[i].type;
            return 0;
        }
    return header_bad(h->s, e, field, value, "unsigned char, short, float or another type of one number");
}

static int take_encoding(header *h, const char *field, char *value, err *e)
{
    static const struct {
        const char *name;
        voxels_encoding encoding;
    } names[] = {{"raw", VOXELS_RAW},   {"gzip", VOXELS_DEFLATED}, {"gz", VOXELS_DEFLATED},
                 {"text", VOXELS_TEXT}, {"txt", VOXELS_TEXT},      {"ascii", VOXELS_TEXT}};
    h->encoded = true;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!strcasecmp(names[i].name, value)) {
            h->x.encoding = names[i].encoding;
            return 0;
        }
    return header_bad(h->s, e, field, value, "raw, gzip or ascii");
}

static int take_endian(header *h, const char *field, char *value, err *e)
{
    h->ordered = true;
    h->x.big = !strcmp(value, "big");
    return h->x.big || !strcmp(value, "little") ? 0 : header_bad(h->s, e, field, value, "little or big");
}

/* Names of the body's directions, and those without, which are taken as LPS. */
static int take_space(header *h, const char *field, char *value, err *e)
{
    static const struct {
        const char *name;
        double x, y;
    } spaces[] = {
        {"left-posterior-superior", 1, 1},
        {"LPS", 1, 1},
        {"right-anterior-superior", -1, -1},
        {"RAS", -1, -1},
        {"left-anterior-superior", 1, -1},
        {"LAS", 1, -1},
        {"scanner-xyz", 1, 1},
        {"3D-right-handed", 1, 1},
    };
    for (size_t i = 0; i < sizeof spaces / sizeof *spaces; i++)
        if (!strcasecmp(spaces[i].name, value)) {
            h->sign[0] = spaces[i].x;
            h->sign[1] = spaces[i].y;
            return 0;
        }
    return header_bad(h->s, e, field, value,
                      "left-posterior-superior, right-anterior-superior or left-anterior-superior");
}

static int take_space_dimension(header *h, const char *field, char *value, err *e)
{
    int64_t three;
    return header_integers(h->s, field, value, 3, 3, &three, 1, e);
}

/* The next "(x,y,z)" or "none". 1, 0 for none, -1. */
static int next_vector(const header *h, const char *field, char **p, double to[3], err *e)
{
    const char *expected = "(x,y,z), finite, or none";
    char *at = *p + strspn(*p, " \t"), *end = strchr(at, ')');
    if (!strncmp(at, "none", 4)) {
        *p = at + 4;
        return 0;
    }
    if (*at != '(' || !end)
        return header_bad(h->s, e, field, at, expected);
    *end = '\0';
    *p = end + 1;
    char *number = at + 1;
    for (int i = 0; i < 3; i++) {
        char *comma = strchr(number, ',');
        if (!comma != (i == 2))
            return header_bad(h->s, e, field, at, expected);
        if (comma)
            *comma = '\0';
        if (num_double(header_trim(number), &to[i]))
            return header_bad(h->s, e, field, number, expected);
        number = comma ? comma + 1 : number;
    }
    return 1;
}

static int take_directions(header *h, const char *field, char *value, err *e)
{
    if (need_axes(h, field, e))
        return -1;
    for (int a = 0; a < h->axes; a++) {
        int got = next_vector(h, field, &value, h->axis[a].direction, e);
        if (got < 0)
            return -1;
        h->axis[a].directed = got;
    }
    h->directed = true;
    return *header_trim(value) ? header_bad(h->s, e, field, value, "one vector an axis") : 0;
}

static int take_origin(header *h, const char *field, char *value, err *e)
{
    int got = next_vector(h, field, &value, h->origin, e);
    if (!got)
        return header_bad(h->s, e, field, "none", "(x,y,z)");
    return got < 0 ? -1 : 0;
}

/* word: NULL: the line has ended. */
static int bad_word(const header *h, const char *field, const char *word, const char *expected, err *e)
{
    return word ? header_bad(h->s, e, field, word, expected) : header_wrong(h->s, e, field, "too few", expected);
}

static int take_spacings(header *h, const char *field, char *value, err *e)
{
    if (need_axes(h, field, e))
        return -1;
    for (int a = 0; a < h->axes; a++) {
        char *word = header_word(&value);
        double *to = &h->axis[a].spacing;
        if (word && !strcasecmp(word, "nan"))
            *to = 1;
        else if (!word || num_double(word, to) || !(*to > 0))
            return bad_word(h, field, word, "a distance above 0, or nan, for each axis", e);
    }
    h->spaced = true;
    return 0;
}

static int take_kinds(header *h, const char *field, char *value, err *e)
{
    if (need_axes(h, field, e))
        return -1;
    for (int a = 0; a < h->axes; a++) {
        char *word = header_word(&value);
        if (!word || strlen(word) >= sizeof h->axis[a].kind)
            return bad_word(h, field, word, "a kind for each axis", e);
        snprintf(h->axis[a].kind, sizeof h->axis[a].kind, "%s", word);
    }
    return 0;
}

/* "mm" "mm" "mm" */
static int take_units(header *h, const char *field, char *value, err *e)
{
    for (int i = 0; i < 3; i++) {
        char *from = strchr(value, '"'), *to = from ? strchr(from + 1, '"') : NULL;
        if (!to)
            return header_bad(h->s, e, field, value, "three units between double quotes");
        *to = '\0';
        num_unit unit = from[1] ? num_unit_of(from + 1) : num_unit_of("mm");
        if (!unit)
            return header_bad(h->s, e, field, from + 1, NUM_UNITS);
        h->unit[i] = num_length_in((num_length){1, unit}, unit, num_unit_of("mm"));
        value = to + 1;
    }
    return 0;
}

static int take_lines(header *h, const char *field, char *value, err *e)
{
    return header_integers(h->s, field, value, 0, INT64_MAX, &h->x.lines, 1, e);
}

static int take_bytes(header *h, const char *field, char *value, err *e)
{
    return header_integers(h->s, field, value, -1, INT64_MAX, &h->x.bytes, 1, e);
}

static int take_file(header *h, const char *field, char *value, err *e)
{
    if (!*value || !strncmp(value, "LIST", 4) || strchr(value, '%'))
        return header_bad(h->s, e, field, value, "one file");
    free(h->x.file);
    h->x.file = mem_text(value, e);
    return h->x.file ? 0 : -1;
}

/* What places an image in another way than by space directions or spacings. */
static int take_other(header *h, const char *field, char *value, err *e)
{
    return header_bad(h->s, e, field, header_trim(value), "space directions and space origin in its place");
}

/* Names without their blanks: some writers leave them out. NULL: what it says is not needed here. */
static const struct {
    const char *field;
    take *take;
} fields[] = {
    {"dimension", take_dimension},
    {"type", take_type},
    {"sizes", take_sizes},
    {"encoding", take_encoding},
    {"endian", take_endian},
    {"space", take_space},
    {"spacedimension", take_space_dimension},
    {"spacedirections", take_directions},
    {"spaceorigin", take_origin},
    {"spaceunits", take_units},
    {"spacings", take_spacings},
    {"kinds", take_kinds},
    {"lineskip", take_lines},
    {"byteskip", take_bytes},
    {"datafile", take_file},
    {"axismins", take_other},
    {"axismaxs", take_other},
    {"content", NULL},
    {"number", NULL},
    {"min", NULL},
    {"max", NULL},
    {"oldmin", NULL},
    {"oldmax", NULL},
    {"sampleunits", NULL},
    {"thicknesses", NULL},
    {"labels", NULL},
    {"units", NULL},
    {"centers", NULL},
    {"centerings", NULL},
    {"measurementframe", NULL},
};

/* ---- lines */

static int take_field(header *h, char *field, char *value, err *e)
{
    char name[40];
    size_t n = 0;
    for (const char *p = field; *p && n + 1 < sizeof name; p++)
        if (*p != ' ')
            name[n++] = (char)tolower((unsigned char)*p);
    name[n] = '\0';
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        if (!strcmp(fields[i].field, name))
            return fields[i].take ? fields[i].take(h, field, header_trim(value), e) : 0;
    return header_bad(h->s, e, "field", field, "a field of NRRD, or KEY:=VALUE");
}

static int take_line(header *h, char *line, err *e)
{
    char *key = strstr(line, ":="), *field = strstr(line, ": ");
    if (*line == '#')
        return 0;
    if (key && (!field || key < field)) {
        *key = '\0';
        return labels_in_take(&h->labels, h->s, line, key + 2, e);
    }
    if (!field && *line && line[strlen(line) - 1] == ':')
        field = line + strlen(line) - 1;
    if (!field)
        return header_bad(h->s, e, "the header", line, "FIELD: VALUE, KEY:=VALUE, or an empty line at its end");
    char *value = *field && field[1] ? field + 2 : field + 1;
    *field = '\0';
    return take_field(h, line, value, e);
}

/* Up to the empty line, or the end where the data are in a file of their own. */
static int take_header(header *h, err *e)
{
    char *line;
    for (;;) {
        int64_t length = in_line(h->s, &line, NULL, e);
        if (length == -2)
            return -1;
        if (length == -1 && !h->x.file)
            return err_set(e, in_name(h->s), in_lines(h->s), "the header ends here; expected an empty line, then data");
        if (length <= 0)
            break;
        if (take_line(h, line, e))
            return -1;
    }
    if (h->axes && h->typed && h->sized && h->encoded)
        return 0;
    const char *lacking = h->sized ? "encoding" : "sizes";
    if (!h->axes)
        lacking = "dimension";
    else if (!h->typed)
        lacking = "type";
    return err_set(e, in_name(h->s), in_lines(h->s),
                   "a header without %s; expected type, dimension, sizes and encoding", lacking);
}

/* ---- what it means */

static bool is_domain(const header *h, const axis *a)
{
    static const char *const none[] = {"domain", "space", "???", "none", ""};
    if (h->directed)
        return a->directed;
    for (size_t i = 0; i < sizeof none / sizeof *none; i++)
        if (!strcasecmp(none[i], a->kind))
            return true;
    return false;
}

/* The axes of space, in order; returns how many, or -1. An axis of one that is none is passed over; a
 * list of images in a plane is the third. */
static int find_axes(const header *h, const axis *of[3], err *e)
{
    int count = 0;
    for (int a = 0; a < h->axes; a++) {
        const axis *at = &h->axis[a];
        bool frames = !strcasecmp(at->kind, "list") && count == 2 && a + 1 == h->axes;
        if (!is_domain(h, at) && !frames) {
            if (at->size > 1)
                return err_set(e, in_name(h->s), in_lines(h->s),
                               "axis %d holds %lld values of each voxel; expected one", a, (long long)at->size);
            continue;
        }
        if (count == 3)
            return err_set(e, in_name(h->s), in_lines(h->s), "more than three axes of space; expected three");
        of[count++] = at;
    }
    if (count < 2)
        return err_set(e, in_name(h->s), in_lines(h->s), "fewer than two axes of space; expected three");
    return count;
}

/* The direction of an axis that has none: along x, y or z, or normal to the two before it. */
static void take_normal(volume *v)
{
    const double *x = v->axis[0], *y = v->axis[1];
    double length = 0, n[3];
    for (int i = 0; i < 3; i++) {
        n[i] = x[(i + 1) % 3] * y[(i + 2) % 3] - x[(i + 2) % 3] * y[(i + 1) % 3];
        length += n[i] * n[i];
    }
    for (int i = 0; i < 3; i++)
        v->axis[2][i] = length > 0 ? n[i] / sqrt(length) : i == 2;
}

static int take_geometry(header *h, err *e)
{
    const axis *of[3] = {&h->axis[0], &h->axis[0], &h->axis[0]};
    int count = find_axes(h, of, e);
    volume *v = h->v;
    if (count < 0)
        return -1;
    v->size[2] = 1;
    for (int a = 0; a < count; a++) {
        v->size[a] = of[a]->size;
        for (int i = 0; i < 3; i++)
            if (h->directed)
                v->axis[a][i] = of[a]->direction[i] * h->unit[i] * h->sign[i];
            else
                v->axis[a][i] = a == i ? of[a]->spacing * h->sign[i] : 0;
    }
    if (count == 2 || (h->directed && !of[2]->directed))
        take_normal(v);
    for (int i = 0; i < 3; i++)
        v->origin[i] = h->origin[i] * h->unit[i] * h->sign[i];
    return volume_check(v, in_name(h->s), in_lines(h->s), e);
}

static int check_data(const header *h, err *e)
{
    bool plain = h->x.encoding == VOXELS_RAW;
    if (h->x.encoding != VOXELS_TEXT && volume_type_size(h->v->type) > 1 && !h->ordered)
        return err_set(e, in_name(h->s), in_lines(h->s), "a header without endian; expected little or big");
    if (h->x.bytes < 0 && !plain)
        return err_set(e, in_name(h->s), in_lines(h->s), "byte skip: -1 of data that are not raw; expected 0 or more");
    return 0;
}

int nrrd_read(volume *v, in *s, const char *path, const volume_budget *b, err *e)
{
    header h = {.s = s, .v = v, .sign = {1, 1, 1}, .unit = {1, 1, 1}};
    for (int a = 0; a < AXES; a++)
        h.axis[a].spacing = 1;
    int status = take_header(&h, e) || take_geometry(&h, e) || check_data(&h, e) ||
                         voxels_in_read(v, &h.x, s, path, b, e) || labels_in_give(&h.labels, v, e)
                     ? -1
                     : 0;
    labels_in_free(&h.labels);
    free(h.x.file);
    return status;
}
