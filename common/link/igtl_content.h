/* Contents of OpenIGTLink's messages, read and written (openigtlink.org, Documents/Protocol; names as there).
 * Matrices are row by row, 4 x 4, mm, in the space of who sends: base/space.h converts. What is read borrows the
 * message's bytes; what is written is added to a buffer as a content, which igtl_write makes a message of.
 *
 * Reading returns 0, or -1 with e filled where a content is too short, or its sizes do not agree; place names the
 * sender. Writing returns 0, or -1 with e filled where memory is short.
 */
#ifndef SINEW_IGTL_CONTENT_H
#define SINEW_IGTL_CONTENT_H

#include "link/igtl.h"

enum { IGTL_TOOL = 70, IGTL_IMAGE = 72, IGTL_COMMAND_NAME = 128, IGTL_COORDINATES = 32, IGTL_SENSOR_MOST = 255 };

/* TRANSFORM: 3 x 4 float32, columns first. */
int igtl_read_transform(const igtl_message *m, double matrix[16], const char *place, err *e);
int igtl_write_transform(igtl_buffer *b, const double matrix[16], err *e);

/* POSITION: a place, and a quaternion x y z w of four numbers, of three (w is what makes its length 1), or none. Its
 * length is not looked at. */
int igtl_read_position(const igtl_message *m, double position[3], double quaternion[4], const char *place, err *e);
int igtl_write_position(igtl_buffer *b, const double position[3], const double quaternion[4], err *e);

/* TDATA: tools of a tracker, IGTL_TOOL bytes each. */
typedef struct igtl_tool {
    char name[IGTL_DEVICE + 1];
    int type; /* 1 tracker, 2 with 6 degrees of freedom, 3 with 3, 4 with 5 */
    double matrix[16];
} igtl_tool;
int igtl_count_tools(const igtl_message *m, int *count, const char *place, err *e);
void igtl_read_tool(const igtl_message *m, int i, igtl_tool *to);
int igtl_write_tool(igtl_buffer *b, const igtl_tool *tool, err *e);

/* STT_TDATA: asks for them, at most one in so many ms, in coordinates of this name ("": the sender's own). */
int igtl_read_start_tools(const igtl_message *m, uint32_t *interval, char coordinates[IGTL_COORDINATES + 1],
                          const char *place, err *e);
int igtl_write_start_tools(igtl_buffer *b, uint32_t interval, const char *coordinates, err *e);

/* RTS_*: 0 success, 1 error. */
int igtl_read_answer(const igtl_message *m, int *status, const char *place, err *e);
int igtl_write_answer(igtl_buffer *b, int status, err *e);

/* STATUS. */
enum {
    IGTL_OK = 1,
    IGTL_NOT_FOUND = 4,
    IGTL_TIME_OUT = 7,
    IGTL_ILLEGAL = 12,
    IGTL_NOT_READY = 13,
    IGTL_NOT_PRESENT = 16
};
typedef struct igtl_status {
    int code;
    int64_t subcode;
    char name[IGTL_DEVICE + 1];
    const char *text; /* of text_size bytes, not terminated; written: text_size bytes and a 0 */
    size_t text_size;
} igtl_status;
int igtl_read_status(const igtl_message *m, igtl_status *to, const char *place, err *e);
int igtl_write_status(igtl_buffer *b, const igtl_status *s, err *e);

/* What a code means, as "time out". */
const char *igtl_status_text(int code);

/* STRING: at most 65535 bytes; what is longer is cut. */
int igtl_read_string(const igtl_message *m, const char **text, size_t *size, const char *place, err *e);
int igtl_write_string(igtl_buffer *b, const char *text, size_t size, err *e);

/* SENSOR: at most IGTL_SENSOR_MOST numbers, and their unit: 4 bits of prefix, then up to six times 6 bits of a
 * unit and 4 of its exponent (Documents/Protocol/unit.md, whose table is followed, not its example, which leaves
 * exponents 0). */
#define IGTL_NEWTON       ((uint64_t)0x0b << 54 | (uint64_t)1 << 50)
#define IGTL_NEWTON_METRE (IGTL_NEWTON | (uint64_t)0x01 << 44 | (uint64_t)1 << 40)
typedef struct igtl_sensor {
    int count;
    uint64_t unit;
    double value[IGTL_SENSOR_MOST];
} igtl_sensor;
int igtl_read_sensor(const igtl_message *m, igtl_sensor *to, const char *place, err *e);
int igtl_write_sensor(igtl_buffer *b, const igtl_sensor *s, err *e);

/* IMAGE: its header, of IGTL_IMAGE bytes, and pixels. The matrix takes pixels (columns, rows, slices; those of the
 * first are at 0) to mm in its space; in the message its last column is the middle of the image, at (size - 1) /
 * 2. */
enum { IGTL_UINT8 = 3, IGTL_RAS = 1, IGTL_LPS = 2 };
typedef struct igtl_image {
    int components;  /* 1: grey, 3: red, green, blue */
    int scalar;      /* IGTL_UINT8 and its like */
    bool little;     /* the order of bytes of its pixels */
    int coordinates; /* IGTL_RAS or IGTL_LPS */
    int size[3];     /* 1 to 65535 */
    double matrix[16];
    const unsigned char *pixels; /* all of them: of a part of an image, that part's */
    size_t pixels_size;
    int part[6]; /* where a part begins, and its size; the whole: 0 0 0 and size */
} igtl_image;
int igtl_read_image(const igtl_message *m, igtl_image *to, const char *place, err *e);
int igtl_write_image(igtl_buffer *b, const igtl_image *i, err *e);

/* POLYDATA: points and triangles of a surface. Other things that a message may have (lines, strips, attributes) are
 * read over. */
typedef struct igtl_surface {
    int64_t points, triangles;
    const unsigned char *point;    /* 3 float32 each, big-endian */
    const unsigned char *triangle; /* 4 uint32 each: 3 and three points */
} igtl_surface;
int igtl_read_surface(const igtl_message *m, igtl_surface *to, const char *place, err *e);

/* position: points x 3, mm; triangle: triangles x 3, indices of points. */
int igtl_write_surface(igtl_buffer *b, const double *position, int64_t points, const int32_t *triangle,
                       int64_t triangles, err *e);

/* COMMAND and RTS_COMMAND, of header version 2. */
typedef struct igtl_command {
    uint32_t id;
    char name[IGTL_COMMAND_NAME + 1];
    const char *text; /* of text_size bytes, not terminated */
    size_t text_size;
} igtl_command;
int igtl_read_command(const igtl_message *m, igtl_command *to, const char *place, err *e);
int igtl_write_command(igtl_buffer *b, const igtl_command *c, err *e);

/* CAPABILITY: names of types, IGTL_TYPE bytes each. */
int igtl_write_capability(igtl_buffer *b, const char *const *type, int count, err *e);

#endif
