#include "place/plus_config.h"

#include "base/num.h"
#include "base/space.h"
#include "base/xml.h"
#include "place/links.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Of an image's columns and rows, which a calibration finds apart from each other. */
#define IMAGE_COSINE 0.01

typedef struct config {
    xml x;
    int count;
    links_transform list[LINKS_MOST];
} config;

static int bad(const config *c, const xml_tag *tag, err *e, const char *what, const char *expected)
{
    return err_set(e, c->x.name, xml_line(&c->x, tag->begin), "%.200s; expected %s", what, expected);
}

/* ---- reading */

static int take_frame(const config *c, const xml_tag *tag, const char *key, char to[LINKS_NAME], err *e)
{
    const char *value = xml_value(tag, key);
    char what[40];
    snprintf(what, sizeof what, "a Transform's %s", key);
    if (!value || !*value || strlen(value) >= LINKS_NAME)
        return bad(c, tag, e, what, "From=\"FRAME\" To=\"FRAME\", of shorter names");
    strcpy(to, value);
    return 0;
}

static int take_matrix(const config *c, const xml_tag *tag, double m[16], err *e)
{
    const int at = xml_find(tag, "Matrix");
    if (at < 0 || num_words(tag->whole[at], tag->whole_end[at], m, 16) != 16)
        return bad(c, tag, e, "a Transform's Matrix", "16 finite numbers, row by row");
    for (int i = 0; i < 4; i++)
        if (fabs(m[12 + i] - (i == 3)) > 0)
            return bad(c, tag, e, "a Transform's Matrix", "0 0 0 1 as the last of its four rows");
    return 0;
}

static int take_transform(config *c, const xml_tag *tag, err *e)
{
    links_transform t = {.set = true};
    if (take_frame(c, tag, "From", t.from, e) || take_frame(c, tag, "To", t.to, e) || take_matrix(c, tag, t.m, e))
        return -1;
    for (int i = 0; i < c->count; i++)
        if (!strcmp(c->list[i].from, t.from) && !strcmp(c->list[i].to, t.to))
            return bad(c, tag, e, "a Transform whose From and To another has", "each once");
    if (c->count == LINKS_MOST)
        return bad(c, tag, e, "more than 64 transforms", "fewer");
    c->list[c->count++] = t;
    return 0;
}

static int read_tags(config *c, err *e)
{
    static const char section[] = "CoordinateDefinitions";
    xml_tag tag;
    bool inside = false, seen = false;
    int got;
    while ((got = xml_next(&c->x, &tag, e)) > 0) {
        if (!strcmp(tag.name, section)) {
            inside = !tag.closed;
            seen = true;
        } else if (tag.name[0] == '/' && !strcmp(tag.name + 1, section)) {
            inside = false;
        } else if (inside && !strcmp(tag.name, "Transform") && take_transform(c, &tag, e)) {
            return -1;
        }
    }
    if (!got && !seen)
        return err_set(e, c->x.name, 0, "has no <CoordinateDefinitions>; expected a configuration of PLUS");
    return got;
}

/* ---- choosing */

static bool leads(const config *c, const char *from, const char *to)
{
    double m[16];
    return links_compose(c->list, c->count, from, to, true, m);
}

static int ask(const config *c, const char *why, transform_use use, err *e)
{
    char list[LINKS_LIST];
    links_list(c->list, c->count, list);
    return err_set(e, c->x.name, 0, "%s; expected FILE:FROMToTO, %s, by what it has: %s", why,
                   use == TRANSFORM_MARKER ? "from the probe's face to its marker, as :TransducerOriginToProbe"
                                           : "from the model to the frame of the poses, as :ModelToReference",
                   list);
}

static int choose(const config *c, const transform_file *f, char *from, char *to, err *e)
{
    static const char *const usual[][2] = {
        {"TransducerOrigin", "Probe"}, {"TransducerOriginPixel", "Probe"}, {"Probe", "ProbeMarker"}};
    if (f->frames)
        return links_split(f->frames, strlen(f->frames), from, to);
    if (f->use == TRANSFORM_BODY)
        return ask(c, "which transform is meant is not said", f->use, e);
    int found = -1;
    for (int i = 0; i < 3; i++) {
        if (!leads(c, usual[i][0], usual[i][1]))
            continue;
        if (found >= 0 && i == 2)
            return ask(c, "leads both from TransducerOrigin to Probe and from Probe to ProbeMarker", f->use, e);
        found = found < 0 ? i : found;
    }
    if (found < 0)
        return ask(c, "leads neither from TransducerOrigin to Probe nor from Probe to ProbeMarker", f->use, e);
    strcpy(from, usual[found][0]);
    strcpy(to, usual[found][1]);
    return 0;
}

/* ---- what it is */

/* The middle of the array on an image, as the probe's own frame: +x along the columns, +z down, without the size of
 * pixels. An image has no third axis: what stands there is not looked at. */
static int pose_of_image(const config *c, const double m[16], const char *what, pose *to, err *e)
{
    double axis[3][3], length[2] = {0, 0}, along = 0, rest = 0;
    for (int i = 0; i < 3; i++) {
        length[0] += m[4 * i] * m[4 * i];
        length[1] += m[4 * i + 1] * m[4 * i + 1];
        to->position[i] = m[4 * i + 3] / 1e3;
    }
    for (int i = 0; i < 3; i++) {
        axis[0][i] = m[4 * i] / sqrt(length[0]);
        axis[2][i] = m[4 * i + 1] / sqrt(length[1]);
        along += axis[0][i] * axis[2][i];
    }
    if (!isfinite(length[0] + length[1]) || !(length[0] > 0) || !(length[1] > 0))
        return err_set(e, c->x.name, 0, "%s: the image has no columns or no rows; expected pixels with sides", what);
    if (!(fabs(along) <= IMAGE_COSINE))
        return err_set(e, c->x.name, 0,
                       "%s: the cosine between the image's columns and rows is %.6g; expected 0, to within %g", what,
                       along, IMAGE_COSINE);
    for (int i = 0; i < 3; i++) {
        axis[2][i] -= along * axis[0][i];
        rest += axis[2][i] * axis[2][i];
    }
    for (int i = 0; i < 3; i++)
        axis[2][i] /= sqrt(rest);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        axis[1][i] = axis[2][j] * axis[0][k] - axis[2][k] * axis[0][j];
    }
    pose_axes(axis, to->quaternion);
    return 0;
}

static bool is_finite(const double m[16])
{
    for (int i = 0; i < 16; i++)
        if (!isfinite(m[i]))
            return false;
    return true;
}

static int take(const config *c, const transform_file *f, pose *to, err *e)
{
    char from[LINKS_NAME], into[LINKS_NAME], what[2 * LINKS_NAME + 4], why[2 * LINKS_NAME + 60];
    double m[16];
    err no = {0};
    if (choose(c, f, from, into, e))
        return -1;
    snprintf(what, sizeof what, "%sTo%s", from, into);
    snprintf(why, sizeof why, "does not say where %s is in %s", from, into);
    if (!links_compose(c->list, c->count, from, into, true, m))
        return ask(c, why, f->use, e);
    if (!strcmp(from, "Image"))
        return err_set(e, c->x.name, 0,
                       "%s: which of the image's pixels is the middle of the array, no width says; expected "
                       "TransducerOriginTo%s, with a Transform from Image to TransducerOriginPixel",
                       what, into);
    if (!is_finite(m))
        return err_set(e, c->x.name, 0, "%s lies too far away; expected mm", what);
    if (!strncmp(from, "TransducerOrigin", strlen("TransducerOrigin")))
        return pose_of_image(c, m, what, to, e);
    return space_pose_of_matrix(m, SPACE_LPS, to, &no) ? err_set(e, c->x.name, 0, "%s: %s", what, no.text) : 0;
}

int plus_config_read(const transform_file *f, pose *to, err *e)
{
    config c = {.x = {.name = f->name,
                      .what = "the XML of a PLUS configuration",
                      .text = f->bytes,
                      .at = f->bytes,
                      .end = f->bytes + f->size}};
    return read_tags(&c, e) || take(&c, f, to, e) ? -1 : 0;
}
