#include "link/igtl_content.h"

#include "link/big_endian.h"

#include <math.h>
#include <string.h>

enum { MATRIX = 48, STATUS = 30, COMMAND = 138, SURFACE = 40 };

static int wrong_size(const igtl_message *m, size_t expected, const char *place, err *e)
{
    return err_set(e, place, 0, "%s '%s': a content of %zu bytes; expected %s%zu", m->header.type, m->header.device,
                   m->size, m->size < expected ? "at least " : "", expected);
}

static int at_least(const igtl_message *m, size_t size, const char *place, err *e)
{
    return m->size < size ? wrong_size(m, size, place, e) : 0;
}

/* 3 x 4, columns first. */
static void get_matrix(double matrix[16], const unsigned char *from)
{
    for (int c = 0; c < 4; c++)
        for (int r = 0; r < 3; r++)
            matrix[4 * r + c] = big_endian_get_float(from + 4 * (3 * c + r));
    for (int c = 0; c < 4; c++)
        matrix[12 + c] = c == 3;
}

static unsigned char *put_matrix(unsigned char *to, const double matrix[16])
{
    for (int c = 0; c < 4; c++)
        for (int r = 0; r < 3; r++)
            to = big_endian_put_float(to, matrix[4 * r + c]);
    return to;
}

int igtl_read_transform(const igtl_message *m, double matrix[16], const char *place, err *e)
{
    if (at_least(m, MATRIX, place, e))
        return -1;
    get_matrix(matrix, m->content);
    return 0;
}

int igtl_write_transform(igtl_buffer *b, const double matrix[16], err *e)
{
    unsigned char *to = igtl_add(b, MATRIX, e);
    if (!to)
        return -1;
    put_matrix(to, matrix);
    return 0;
}

int igtl_read_position(const igtl_message *m, double position[3], double quaternion[4], const char *place, err *e)
{
    const int numbers = m->size >= 28 ? 4 : (int)(m->size / 4) - 3;
    double sum = 0;
    if (m->size != 12 && m->size != 24 && m->size != 28)
        return err_set(e, place, 0, "%s '%s': a content of %zu bytes; expected 12, 24 or 28", m->header.type,
                       m->header.device, m->size);
    for (int i = 0; i < 3; i++)
        position[i] = big_endian_get_float(m->content + 4 * i);
    for (int i = 0; i < 4; i++)
        quaternion[i] = i < numbers ? big_endian_get_float(m->content + 12 + 4 * i) : 0;
    for (int i = 0; i < 3; i++)
        sum += quaternion[i] * quaternion[i];
    if (numbers < 4)
        quaternion[3] = sqrt(fmax(0, 1 - sum));
    return 0;
}

int igtl_write_position(igtl_buffer *b, const double position[3], const double quaternion[4], err *e)
{
    unsigned char *to = igtl_add(b, 28, e);
    if (!to)
        return -1;
    for (int i = 0; i < 3; i++)
        to = big_endian_put_float(to, position[i]);
    for (int i = 0; i < 4; i++)
        to = big_endian_put_float(to, quaternion[i]);
    return 0;
}

int igtl_count_tools(const igtl_message *m, int *count, const char *place, err *e)
{
    *count = (int)(m->size / IGTL_TOOL);
    if (m->size % IGTL_TOOL)
        return err_set(e, place, 0, "%s '%s': a content of %zu bytes; expected a multiple of %d", m->header.type,
                       m->header.device, m->size, IGTL_TOOL);
    return 0;
}

void igtl_read_tool(const igtl_message *m, int i, igtl_tool *to)
{
    const unsigned char *from = m->content + (size_t)i * IGTL_TOOL;
    big_endian_get_text(to->name, from, IGTL_DEVICE);
    to->type = from[20];
    get_matrix(to->matrix, from + 22);
}

int igtl_write_tool(igtl_buffer *b, const igtl_tool *tool, err *e)
{
    unsigned char *to = igtl_add(b, IGTL_TOOL, e);
    if (!to)
        return -1;
    to = big_endian_put_text(to, tool->name, IGTL_DEVICE);
    to = big_endian_put(to, (uint64_t)tool->type << 8, 2);
    put_matrix(to, tool->matrix);
    return 0;
}

int igtl_read_start_tools(const igtl_message *m, uint32_t *interval, char coordinates[IGTL_COORDINATES + 1],
                          const char *place, err *e)
{
    if (at_least(m, 4 + IGTL_COORDINATES, place, e))
        return -1;
    *interval = (uint32_t)big_endian_get(m->content, 4);
    big_endian_get_text(coordinates, m->content + 4, IGTL_COORDINATES);
    return 0;
}

int igtl_write_start_tools(igtl_buffer *b, uint32_t interval, const char *coordinates, err *e)
{
    unsigned char *to = igtl_add(b, 4 + IGTL_COORDINATES, e);
    if (!to)
        return -1;
    big_endian_put_text(big_endian_put(to, interval, 4), coordinates, IGTL_COORDINATES);
    return 0;
}

int igtl_read_answer(const igtl_message *m, int *status, const char *place, err *e)
{
    if (at_least(m, 1, place, e))
        return -1;
    *status = m->content[0];
    return 0;
}

int igtl_write_answer(igtl_buffer *b, int status, err *e)
{
    unsigned char *to = igtl_add(b, 1, e);
    if (!to)
        return -1;
    *to = (unsigned char)status;
    return 0;
}

int igtl_read_status(const igtl_message *m, igtl_status *to, const char *place, err *e)
{
    if (at_least(m, STATUS, place, e))
        return -1;
    to->code = (int)big_endian_get(m->content, 2);
    to->subcode = (int64_t)big_endian_get(m->content + 2, 8);
    big_endian_get_text(to->name, m->content + 10, IGTL_DEVICE);
    to->text = (const char *)m->content + STATUS;
    to->text_size = strnlen(to->text, m->size - STATUS);
    return 0;
}

int igtl_write_status(igtl_buffer *b, const igtl_status *s, err *e)
{
    unsigned char *to = igtl_add(b, STATUS + (int64_t)s->text_size + 1, e);
    if (!to)
        return -1;
    to = big_endian_put(to, (uint64_t)s->code, 2);
    to = big_endian_put(to, (uint64_t)s->subcode, 8);
    to = big_endian_put_text(to, s->name, IGTL_DEVICE);
    if (s->text_size)
        memcpy(to, s->text, s->text_size);
    to[s->text_size] = '\0';
    return 0;
}

const char *igtl_status_text(int code)
{
    static const char *const text[] = {"invalid packet",
                                       "ok",
                                       "unknown error",
                                       "panic mode",
                                       "not found",
                                       "access denied",
                                       "busy",
                                       "time out or connection lost",
                                       "overflow",
                                       "checksum error",
                                       "configuration error",
                                       "not enough resources",
                                       "unknown instruction",
                                       "device not ready",
                                       "manual mode",
                                       "device disabled",
                                       "device not present",
                                       "device version not known",
                                       "hardware failure",
                                       "shutting down"};
    const int count = (int)(sizeof text / sizeof *text);
    return code >= 0 && code < count ? text[code] : "unknown code";
}

int igtl_read_string(const igtl_message *m, const char **text, size_t *size, const char *place, err *e)
{
    if (at_least(m, 4, place, e))
        return -1;
    *size = (size_t)big_endian_get(m->content + 2, 2);
    *text = (const char *)m->content + 4;
    return at_least(m, 4 + *size, place, e);
}

int igtl_write_string(igtl_buffer *b, const char *text, size_t size, err *e)
{
    const size_t n = size < 65535 ? size : 65535;
    unsigned char *to = igtl_add(b, 4 + (int64_t)n, e);
    if (!to)
        return -1;
    to = big_endian_put(big_endian_put(to, IGTL_ASCII, 2), n, 2);
    memcpy(to, text, n);
    return 0;
}

int igtl_read_sensor(const igtl_message *m, igtl_sensor *to, const char *place, err *e)
{
    if (at_least(m, 10, place, e))
        return -1;
    to->count = m->content[0];
    to->unit = big_endian_get(m->content + 2, 8);
    if (at_least(m, 10 + 8 * (size_t)to->count, place, e))
        return -1;
    for (int i = 0; i < to->count; i++)
        to->value[i] = big_endian_get_double(m->content + 10 + 8 * i);
    return 0;
}

int igtl_write_sensor(igtl_buffer *b, const igtl_sensor *s, err *e)
{
    unsigned char *to = igtl_add(b, 10 + 8 * (int64_t)s->count, e);
    if (!to)
        return -1;
    to = big_endian_put(to, (uint64_t)s->count << 8, 2);
    to = big_endian_put(to, s->unit, 8);
    for (int i = 0; i < s->count; i++)
        to = big_endian_put_double(to, s->value[i]);
    return 0;
}

/* Bytes of a number of this type; 0: there is none. */
static size_t scalar_size(int scalar)
{
    static const unsigned char size[] = {0, 0, 1, 1, 2, 2, 4, 4, 0, 0, 4, 8};
    return scalar >= 0 && scalar < (int)sizeof size ? size[scalar] : 0;
}

/* From where the middle of an image is to where its first pixel is (sign -1), or back. */
static void move_to_middle(double matrix[16], const int size[3], double sign)
{
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 3; k++)
            matrix[4 * r + 3] += sign * matrix[4 * r + k] * (size[k] - 1) / 2;
}

int igtl_read_image(const igtl_message *m, igtl_image *to, const char *place, err *e)
{
    const unsigned char *from = m->content;
    if (at_least(m, IGTL_IMAGE, place, e))
        return -1;
    to->components = from[2];
    to->scalar = from[3];
    to->little = from[4] == 2;
    to->coordinates = from[5] == IGTL_LPS ? IGTL_LPS : IGTL_RAS;
    size_t pixels = (size_t)to->components * scalar_size(to->scalar);
    for (int k = 0; k < 3; k++)
        to->size[k] = (int)big_endian_get(from + 6 + 2 * k, 2);
    get_matrix(to->matrix, from + 12);
    for (int k = 0; k < 6; k++)
        to->part[k] = (int)big_endian_get(from + 60 + 2 * k, 2);
    for (int k = 0; k < 3; k++) {
        pixels *= (size_t)to->part[3 + k];
        if (to->part[k] + to->part[3 + k] > to->size[k])
            return err_set(e, place, 0, "%s '%s': a part that is not inside its image", m->header.type,
                           m->header.device);
    }
    if (!pixels)
        return err_set(e, place, 0, "%s '%s': an image without pixels, or of unknown ones", m->header.type,
                       m->header.device);
    if (m->size != IGTL_IMAGE + pixels)
        return wrong_size(m, IGTL_IMAGE + pixels, place, e);
    move_to_middle(to->matrix, to->size, -1);
    to->pixels = from + IGTL_IMAGE;
    to->pixels_size = pixels;
    return 0;
}

int igtl_write_image(igtl_buffer *b, const igtl_image *i, err *e)
{
    double matrix[16];
    memcpy(matrix, i->matrix, sizeof matrix);
    move_to_middle(matrix, i->size, 1);
    unsigned char *to = igtl_add(b, IGTL_IMAGE + (int64_t)i->pixels_size, e);
    if (!to)
        return -1;
    to = big_endian_put(to, 1, 2);
    *to++ = (unsigned char)i->components;
    *to++ = (unsigned char)i->scalar;
    *to++ = i->little ? 2 : 1;
    *to++ = (unsigned char)i->coordinates;
    for (int k = 0; k < 3; k++)
        to = big_endian_put(to, (uint64_t)i->size[k], 2);
    to = put_matrix(to, matrix);
    for (int k = 0; k < 6; k++)
        to = big_endian_put(to, (uint64_t)i->part[k], 2);
    memcpy(to, i->pixels, i->pixels_size);
    return 0;
}

/* Where polygons are triangles, all of them with points that there are. */
static int check_triangles(const igtl_message *m, const igtl_surface *s, const char *place, err *e)
{
    for (int64_t i = 0; i < s->triangles; i++)
        for (int k = 0; k < 4; k++) {
            const uint64_t v = big_endian_get(s->triangle + 16 * i + 4 * k, 4);
            if (k ? v >= (uint64_t)s->points : v != 3)
                return err_set(e, place, 0, "%s '%s': polygon %lld is no triangle of its %lld points", m->header.type,
                               m->header.device, (long long)i, (long long)s->points);
        }
    return 0;
}

int igtl_read_surface(const igtl_message *m, igtl_surface *to, const char *place, err *e)
{
    uint64_t n[10];
    if (at_least(m, SURFACE, place, e))
        return -1;
    for (int k = 0; k < 10; k++)
        n[k] = big_endian_get(m->content + 4 * k, 4);
    const uint64_t before = SURFACE + 12 * n[0] + n[2] + n[4];
    *to = (igtl_surface){.points = (int64_t)n[0], .triangles = (int64_t)n[5]};
    if (at_least(m, before + n[6] + n[8], place, e))
        return -1;
    if (n[6] != 16 * n[5])
        return err_set(e, place, 0, "%s '%s': %llu bytes of %llu polygons; expected triangles, of 16 bytes each",
                       m->header.type, m->header.device, (unsigned long long)n[6], (unsigned long long)n[5]);
    to->point = m->content + SURFACE;
    to->triangle = m->content + before;
    return check_triangles(m, to, place, e);
}

int igtl_write_surface(igtl_buffer *b, const double *position, int64_t points, const int32_t *triangle,
                       int64_t triangles, err *e)
{
    const uint64_t head[10] = {(uint64_t)points, 0, 0, 0, 0, (uint64_t)triangles, 16 * (uint64_t)triangles, 0, 0, 0};
    unsigned char *to = igtl_add(b, SURFACE + 12 * points + 16 * triangles, e);
    if (!to)
        return -1;
    for (int k = 0; k < 10; k++)
        to = big_endian_put(to, head[k], 4);
    for (int64_t i = 0; i < 3 * points; i++)
        to = big_endian_put_float(to, position[i]);
    for (int64_t i = 0; i < triangles; i++) {
        to = big_endian_put(to, 3, 4);
        for (int k = 0; k < 3; k++)
            to = big_endian_put(to, (uint64_t)triangle[3 * i + k], 4);
    }
    return 0;
}

int igtl_read_command(const igtl_message *m, igtl_command *to, const char *place, err *e)
{
    if (at_least(m, COMMAND, place, e))
        return -1;
    to->id = (uint32_t)big_endian_get(m->content, 4);
    big_endian_get_text(to->name, m->content + 4, IGTL_COMMAND_NAME);
    to->text_size = (size_t)big_endian_get(m->content + 134, 4);
    to->text = (const char *)m->content + COMMAND;
    return at_least(m, COMMAND + to->text_size, place, e);
}

int igtl_write_command(igtl_buffer *b, const igtl_command *c, err *e)
{
    unsigned char *to = igtl_add(b, COMMAND + (int64_t)c->text_size, e);
    if (!to)
        return -1;
    to = big_endian_put(to, c->id, 4);
    to = big_endian_put_text(to, c->name, IGTL_COMMAND_NAME);
    to = big_endian_put(to, IGTL_ASCII, 2);
    to = big_endian_put(to, c->text_size, 4);
    if (c->text_size)
        memcpy(to, c->text, c->text_size);
    return 0;
}

int igtl_write_capability(igtl_buffer *b, const char *const *type, int count, err *e)
{
    unsigned char *to = igtl_add(b, (int64_t)count * IGTL_TYPE, e);
    if (!to)
        return -1;
    for (int i = 0; i < count; i++)
        to = big_endian_put_text(to, type[i], IGTL_TYPE);
    return 0;
}
