#include "link/serve_request.h"

#include "base/mem.h"
#include "link/big_endian.h"
#include "link/igtl_content.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PREFIX = 4 /* bytes, as GET_ */ };

/* What is served. */
static const char *const served[SERVE_TYPES] = {"IMAGE", "TRANSFORM", "POLYDATA", "SENSOR", "STRING", "STATUS"};

static bool begins(const char *text, const char *with)
{
    return !strncmp(text, with, strlen(with));
}

bool serve_request_is(const igtl_header *h)
{
    return begins(h->type, "GET_") || begins(h->type, "STT_") || begins(h->type, "STP_") ||
           !strcmp(h->type, "COMMAND") || (!strcmp(h->type, "STRING") && begins(h->device, "CMD"));
}

/* Whether a request's type, after its prefix, means a message's: as much of it as fits into the field, or less, as
 * TRANS and CAPABIL. */
static bool means(const char *asked, const char *type)
{
    enum { LEAST = 5 };
    const size_t n = strlen(asked);
    return n >= LEAST && !strncmp(asked, type, n);
}

/* The number of what a request means, of what is served; -1: it is not. */
static int find_type(const igtl_message *m)
{
    for (int i = 0; i < SERVE_TYPES; i++)
        if (means(m->header.type + PREFIX, served[i]))
            return i;
    return -1;
}

const serve_wish *serve_request_wish(const serve_wishes *w, const serve_board *board, int device)
{
    for (int i = 0; i < SERVE_TYPES && !w->device[device].is_said; i++)
        if (!strcmp(serve_board_type(board, device), served[i]))
            return &w->type[i];
    return &w->device[device];
}

/* An answer with its header. */
static int add_answer(const igtl_about *about, const igtl_buffer *content, serve_wishes *w, err *e)
{
    igtl_about own = *about;
    own.version = w->version;
    own.stamp = igtl_now();
    return igtl_write(&w->answers, &own, content->at, content->size, e);
}

/* RTS_ of what was asked for: 0, or 1 where there is no such thing. */
static int tell(const igtl_message *m, bool failed, serve_wishes *w, err *e)
{
    char type[IGTL_TYPE + 1];
    const igtl_about about = {.type = type, .device = m->header.device, .id = m->id};
    igtl_buffer content = {0};
    snprintf(type, sizeof type, "RTS_%s", m->header.type + PREFIX);
    const int bad = igtl_write_answer(&content, failed, e) || add_answer(&about, &content, w, e);
    igtl_buffer_free(&content);
    return bad ? -1 : 0;
}

static int tell_capability(const igtl_message *m, serve_wishes *w, err *e)
{
    static const char *const types[] = {
        "IMAGE",      "TRANSFORM",    "POLYDATA",     "SENSOR",       "STRING",     "STATUS",     "CAPABILITY",
        "COMMAND",    "RTS_COMMAND",  "GET_IMAGE",    "STT_IMAGE",    "STP_IMAGE",  "GET_TRANS",  "STT_TRANS",
        "STP_TRANS",  "GET_POLYDATA", "STT_POLYDATA", "STP_POLYDATA", "GET_SENSOR", "STT_SENSOR", "STP_SENSOR",
        "GET_STRING", "STT_STRING",   "STP_STRING",   "GET_STATUS",   "GET_CAPABIL"};
    const igtl_about about = {.type = "CAPABILITY", .device = m->header.device, .id = m->id};
    igtl_buffer content = {0};
    const int bad =
        igtl_write_capability(&content, types, sizeof types / sizeof *types, e) || add_answer(&about, &content, w, e);
    igtl_buffer_free(&content);
    return bad ? -1 : 0;
}

/* Whether a device is asked for: by its type, and by its name, if the request has one. Of STATUS there is one. */
static bool is_asked(const igtl_message *m, const serve_board *board, int i)
{
    const char *type = serve_board_type(board, i), *name = m->header.device;
    return means(m->header.type + PREFIX, type) &&
           (!*name || !strcmp(name, serve_board_name(board, i)) || !strcmp(type, "STATUS"));
}

/* The newest message of each; where there is none yet, or no such device, one without a body (Documents/Protocol,
 * query). */
static int take_get(const igtl_message *m, serve_board *board, serve_wishes *w, err *e)
{
    const int type = find_type(m);
    const igtl_about about = {.type = type < 0 ? "" : served[type], .device = m->header.device, .id = m->id};
    const igtl_buffer nothing = {0};
    int found = 0;
    if (means(m->header.type + PREFIX, "CAPABILITY"))
        return tell_capability(m, w, e);
    for (int i = serve_board_count(board) - 1; i >= 0; i--)
        if (is_asked(m, board, i) && serve_board_serial(board, i)) {
            w->device[i].is_asked = true;
            found++;
        }
    if (type < 0)
        return tell(m, true, w, e);
    return found ? 0 : add_answer(&about, &nothing, w, e);
}

/* s: of STT_TDATA's kind 4 bytes, ms; of STT_POLYDATA's 8, a time stamp; else none. */
static double interval_of(const igtl_message *m)
{
    if (m->size == 8)
        return igtl_seconds(big_endian_get(m->content, 8));
    return m->size >= 4 ? (double)big_endian_get(m->content, 4) / 1e3 : 0;
}

/* Without a name, for all devices of the type, those that come later too. */
static int take_flow(const igtl_message *m, serve_board *board, serve_wishes *w, err *e)
{
    const bool off = begins(m->header.type, "STP_"), all = !*m->header.device;
    const serve_wish wish = {.is_said = !all, .is_off = off, .interval = off ? 0 : interval_of(m)};
    const int type = find_type(m);
    int found = all && type >= 0;
    if (found)
        w->type[type] = wish;
    for (int i = serve_board_count(board) - 1; i >= 0; i--)
        if (is_asked(m, board, i)) {
            const bool asked = w->device[i].is_asked;
            w->device[i] = wish;
            w->device[i].is_asked = asked;
            found++;
        }
    return tell(m, !found, w, e);
}

static int take_command(const igtl_message *m, serve_us *us, serve_wishes *w, err *e)
{
    igtl_command c;
    igtl_buffer content = {0};
    serve_answer *a = igtl_read_command(m, &c, "a client", e) ? NULL : mem_array(1, sizeof *a, "an answer", e);
    if (!a)
        return -1;
    serve_us_answer(us, c.name, c.text, c.text_size, a);
    const igtl_about about = {.type = "RTS_COMMAND",
                              .device = m->header.device,
                              .id = m->id,
                              .pair = (const char *const(*)[2])a->pair,
                              .pairs = a->pairs};
    c.text = a->text;
    c.text_size = strlen(a->text);
    const int bad = igtl_write_command(&content, &c, e) || add_answer(&about, &content, w, e);
    igtl_buffer_free(&content);
    free(a);
    return bad ? -1 : 0;
}

/* Text between the quotes of an attribute. */
static void add_quoted(const char *text, char *to, size_t size)
{
    static const char special[] = "&<>\"", *const name[] = {"&amp;", "&lt;", "&gt;", "&quot;"};
    size_t n = strlen(to);
    for (const char *p = text; *p && n + 8 < size; p++) {
        const char *at = strchr(special, *p);
        const char one[2] = {*p, '\0'};
        n += (size_t)snprintf(to + n, size - n, "%s", at ? name[at - special] : one);
    }
}

/* A command of protocol 1 or 2: a STRING for CMD_x, answered by one from ACK_x. */
static int take_string(const igtl_message *m, serve_us *us, serve_wishes *w, err *e)
{
    char device[IGTL_DEVICE + 1], text[2 * SERVE_TEXT];
    const char *asked;
    size_t size;
    igtl_buffer content = {0};
    serve_answer *a =
        igtl_read_string(m, &asked, &size, "a client", e) ? NULL : mem_array(1, sizeof *a, "an answer", e);
    if (!a)
        return -1;
    serve_us_answer(us, "", asked, size, a);
    snprintf(device, sizeof device, "ACK%s", m->header.device + 3);
    snprintf(text, sizeof text, "<CommandReply Status=\"%s\" Message=\"", a->ok ? "SUCCESS" : "FAIL");
    add_quoted(a->message, text, sizeof text);
    strcat(text, "\" />");
    free(a);
    const igtl_about about = {.type = "STRING", .device = device, .id = m->id};
    const int bad = igtl_write_string(&content, text, strlen(text), e) || add_answer(&about, &content, w, e);
    igtl_buffer_free(&content);
    return bad ? -1 : 0;
}

int serve_request_take(const igtl_message *m, serve_board *board, serve_us *us, serve_wishes *w, err *e)
{
    if (begins(m->header.type, "GET_"))
        return take_get(m, board, w, e);
    if (!strcmp(m->header.type, "COMMAND"))
        return take_command(m, us, w, e);
    if (!strcmp(m->header.type, "STRING"))
        return take_string(m, us, w, e);
    return take_flow(m, board, w, e);
}
