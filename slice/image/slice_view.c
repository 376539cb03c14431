#include "slice/image/slice_view.h"

#include "base/mem.h"
#include "base/num.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

static int phased_of(slice_probe *p, const char *text, err *e)
{
    const double least = 1e-6, most = 180;
    double degrees;
    if (num_double(text + 7, &degrees) || !(degrees >= least && degrees <= most))
        return err_usage(e, "--probe %.100s; expected phased:ANGLE, %g to %g degrees", text, least, most);
    *p = (slice_probe){.array = SLICE_PHASED, .angle = degrees * PI / 180};
    return 0;
}

int slice_probe_of(slice_probe *p, const char *text, err *e)
{
    probe body = {0};
    if (!strncmp(text, "phased:", 7))
        return phased_of(p, text, e);
    if (probe_of(&body, text, e))
        return -1;
    const probe_kind kind = body.kind;
    if (kind == PROBE_LINEAR)
        *p = (slice_probe){.array = SLICE_LINEAR, .width = body.width};
    if (kind == PROBE_CURVED)
        *p = (slice_probe){.array = SLICE_CURVED, .radius = body.radius, .angle = body.angle};
    probe_free(&body);
    return kind == PROBE_LINEAR || kind == PROBE_CURVED ? 0 : 1;
}

/* As two people write down one probe: far less than a pixel. */
static bool near(double a, double b)
{
    return fabs(a - b) <= 1e-3 * fmax(fabs(a), fabs(b));
}

bool slice_probe_same(const slice_probe *a, const slice_probe *b)
{
    return a->array == b->array && near(a->width, b->width) && near(a->radius, b->radius) && near(a->angle, b->angle);
}

int slice_size_of(slice_size *s, const char *text, err *e)
{
    char copy[64] = "";
    int64_t side[2] = {SLICE_COLUMNS, 0};
    const size_t length = text ? strlen(text) : 0;
    char *by = length < sizeof copy && text ? strchr(strcpy(copy, text), 'x') : NULL;
    if (by)
        *by++ = '\0';
    if (text && (length >= sizeof copy || ((*copy || !by) && num_int(copy, 1, SLICE_SIDE_MOST, &side[0])) ||
                 (by && num_int(by, 1, SLICE_SIDE_MOST, &side[1]))))
        return err_usage(e,
                         "--size %.60s; expected COLUMNS, xROWS or COLUMNSxROWS, such as 512 or 512x640, each 1 to %d",
                         text, SLICE_SIDE_MOST);
    *s = (slice_size){*copy || !by ? (int32_t)side[0] : 0, (int32_t)side[1]};
    return 0;
}

/* The even number of pixels, as large as the other side's `across` pixels over `wide`, that goes over `tall`. */
static int follow(int32_t *side, int32_t across, double wide, double tall, err *e)
{
    const double rows = fmax(2, 2 * floor(.5 * across * tall / wide + .5));
    if (rows > SLICE_SIDE_MOST)
        return err_usage(
            e,
            "an image of %.4g x %.4g mm, in pixels that are square, has a side of %.0f; expected at most %d: "
            "another --size, --depth or --width",
            1e3 * wide, 1e3 * tall, rows, SLICE_SIDE_MOST);
    *side = (int32_t)rows;
    return 0;
}

static bool in_fan(const slice_view *v, int32_t column, int32_t row)
{
    const double x = v->corner[0] + v->pixel[0] * column, z = v->corner[1] + v->pixel[1] * row + v->probe.radius;
    const double away = sqrt(x * x + z * z);
    return away >= v->probe.radius && away <= v->probe.radius + v->depth && fabs(atan2(x, z)) <= v->probe.angle / 2;
}

/* A row meets a fan in one run of columns, or in two where it passes behind the middle of the face. */
static void show_row(slice_view *v, int32_t row)
{
    slice_shown *s = &v->shown[row];
    int runs = 0;
    *s = (slice_shown){.to = {v->size.columns, 0}};
    if (v->probe.array == SLICE_LINEAR)
        return;
    s->to[0] = 0;
    for (int32_t c = 0; c < v->size.columns; c++) {
        if (!in_fan(v, c, row))
            continue;
        if (!runs || s->to[runs - 1] < c)
            s->from[runs < 2 ? runs++ : 1] = c;
        s->to[runs - 1] = c + 1;
    }
}

int slice_view_make(slice_view *v, const slice_probe *p, slice_size size, double depth, double width, err *e)
{
    double top = 0;
    *v = (slice_view){.probe = *p, .depth = depth};
    if (p->array == SLICE_LINEAR) {
        width = width > 0 ? width : p->width;
    } else {
        const double half = p->angle / 2, reach = p->radius + depth;
        width = width > 0 ? width : 2 * reach * sin(half);
        top = p->radius * (cos(half) - 1);
    }
    if ((!size.rows && follow(&size.rows, size.columns, width, depth - top, e)) ||
        (!size.columns && follow(&size.columns, size.rows, depth - top, width, e)))
        return -1;
    v->size = size;
    v->pixel[0] = width / size.columns;
    v->pixel[1] = (depth - top) / size.rows;
    v->corner[0] = (.5 - .5 * size.columns) * v->pixel[0];
    v->corner[1] = top + .5 * v->pixel[1];
    v->shown = mem_array(size.rows, sizeof *v->shown, "rows of an image", e);
    for (int32_t r = 0; v->shown && r < size.rows; r++)
        show_row(v, r);
    return v->shown ? 0 : -1;
}

void slice_view_free(slice_view *v)
{
    free(v->shown);
    *v = (slice_view){0};
}

slice_plane slice_view_plane(const slice_view *v, const pose *at, double off)
{
    const double corner[3] = {v->corner[0], off, v->corner[1]};
    const double column[3] = {v->pixel[0], 0, 0}, row[3] = {0, 0, v->pixel[1]};
    slice_plane p = {0};
    pose_turn(at->quaternion, corner, p.origin);
    pose_turn(at->quaternion, column, p.column);
    pose_turn(at->quaternion, row, p.row);
    for (int a = 0; a < 3; a++)
        p.origin[a] += at->position[a];
    return p;
}

double slice_view_range(const slice_view *v, int32_t column, int32_t row)
{
    const double x = v->corner[0] + v->pixel[0] * column, z = v->corner[1] + v->pixel[1] * row;
    if (v->probe.array == SLICE_LINEAR)
        return z;
    return sqrt(x * x + (z + v->probe.radius) * (z + v->probe.radius)) - v->probe.radius;
}
