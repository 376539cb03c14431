#include "link/serve_us.h"

#include "base/mem.h"
#include "base/num.h"
#include "base/xml.h"
#include "cli/tool.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { NUMBERS = 6, PARAMETERS = 16 /* of one command */ };

typedef struct parameter {
    const char *name, *set; /* the line's key; NULL: it cannot be set */
    int most;               /* numbers */
    double low, high;
    double from, scale; /* the line's number: scale (x - from) */
    const char *unit;   /* after that */
    const char *usual;  /* us-slice's default */
    const char *why;    /* it cannot be set */
} parameter;

#define RECORDED "us-slice shows echoes as they were recorded"
static const parameter parameters[] = {
    {"DepthMm", "depth", 1, 1e-3, 1e4, 0, 1, "mm", "50", NULL},
    {"GainPercent", "gain", 1, 0, 100, 50, .6, "", "50", NULL},
    {"DynRangeDb", "dynamic-range", 1, 1, 200, 0, 1, "", "60", NULL},
    {"TimeGainCompensation", "tgc", NUMBERS, -200, 200, 0, 1, "", "0 0 0", NULL},
    {"ImageSize", NULL, 3, 0, 0, 0, 1, "", NULL, "the size in pixels is us-slice's --size"},
    {"FrequencyMhz", NULL, 1, 0, 0, 0, 1, "", NULL, RECORDED},
    {"SectorPercent", NULL, 1, 0, 0, 0, 1, "", NULL, "the sector is us-slice's --probe or --width"},
    {"FocusDepthPercent", NULL, 1, 0, 0, 0, 1, "", NULL, RECORDED},
    {"Intensity", NULL, 1, 0, 0, 0, 1, "", NULL, RECORDED},
    {"Contrast", NULL, 1, 0, 0, 0, 1, "", NULL, "us-slice has DynRangeDb"},
    {"PowerDb", NULL, 1, 0, 0, 0, 1, "", NULL, RECORDED},
    {"ZoomFactor", NULL, 1, 0, 0, 0, 1, "", NULL, "us-slice has DepthMm"},
    {"SoundVelocity", NULL, 1, 0, 0, 0, 1, "", NULL, RECORDED},
    {"Voltage", NULL, 1, 0, 0, 0, 1, "", NULL, RECORDED},
};

enum { KNOWN = sizeof parameters / sizeof *parameters, DEPTH = 0, SIZE = 4 };

struct serve_us {
    serve_control *control;
    pthread_mutex_t lock; /* of what follows */
    char value[KNOWN][XML_VALUE];
    bool is_set[KNOWN];
};

serve_us *serve_us_make(serve_control *control, err *e)
{
    serve_us *u = mem_array(1, sizeof *u, "parameters", e);
    if (!u)
        return NULL;
    u->control = control;
    pthread_mutex_init(&u->lock, NULL);
    for (int i = 0; i < KNOWN; i++)
        snprintf(u->value[i], XML_VALUE, "%s", parameters[i].usual ? parameters[i].usual : "");
    return u;
}

void serve_us_free(serve_us *u)
{
    if (u)
        pthread_mutex_destroy(&u->lock);
    free(u);
}

void serve_us_saw(serve_us *u, int columns, int rows, double depth)
{
    pthread_mutex_lock(&u->lock);
    snprintf(u->value[SIZE], XML_VALUE, "%d %d 1", columns, rows);
    if (!u->is_set[DEPTH])
        snprintf(u->value[DEPTH], XML_VALUE, "%.6g", 1e3 * depth);
    pthread_mutex_unlock(&u->lock);
}

/* ---- answers */

static void add_text(char text[SERVE_TEXT], const char *format, ...) SINEW_PRINTF(2, 3);
static void add_text(char text[SERVE_TEXT], const char *format, ...)
{
    const size_t n = strlen(text);
    va_list list;
    va_start(list, format);
    vsnprintf(text + n, SERVE_TEXT - n, format, list);
    va_end(list);
}

/* Printable ASCII that stands between quotes. */
static void clean(char *text)
{
    for (char *p = text; *p; p++)
        if (*p < ' ' || *p > '~' || *p == '"' || *p == '<' || *p == '>')
            *p = '?';
}

static void add_pair(serve_answer *a, const char *key, const char *value)
{
    if (a->pairs == SERVE_PAIRS)
        return;
    snprintf(a->key[a->pairs], SERVE_KEY, "%.*s", SERVE_KEY - 1, key);
    snprintf(a->value[a->pairs], SERVE_VALUE, "%.*s", SERVE_VALUE - 1, value);
    a->pair[a->pairs][0] = a->key[a->pairs];
    a->pair[a->pairs][1] = a->value[a->pairs];
    a->pairs++;
}

/* The answer that PLUS gives to most commands. */
static void answer_plainly(serve_answer *a, bool ok, const char *text)
{
    a->ok = ok;
    snprintf(a->message, sizeof a->message, "%s", text);
    add_text(a->text, "<CommandReply Name=\"%s\" Status=\"%s\"", a->name, ok ? "SUCCESS" : "FAIL");
    add_text(a->text, ok ? " Message=\"%s\"></CommandReply>" : " Error=\"%s\" Message=\"\"></CommandReply>", text);
    add_pair(a, "Status", ok ? "SUCCESS" : "FAIL");
    add_pair(a, ok ? "Message" : "Error", text);
}

/* ---- parameters */

static int find(const char *name)
{
    for (int i = 0; i < KNOWN; i++)
        if (!strcmp(parameters[i].name, name))
            return i;
    return -1;
}

/* The line that sets a parameter. -1 with e filled. */
static int line_of(const parameter *p, const char *value, char line[SERVE_VALUE], err *e)
{
    const char *at = value, *end = value + strlen(value);
    int count = 0;
    size_t n = (size_t)snprintf(line, SERVE_VALUE, "set %s ", p->set);
    for (at += strspn(at, " "); at < end; at += strspn(at, " ")) {
        double x;
        if (count == p->most || num_scan(at, end, &at, &x) || (at < end && *at != ' ') ||
            !(x >= p->low && x <= p->high))
            return err_set(e, NULL, 0, "%s %.60s; expected %s of %g to %g", p->name, value,
                           p->most > 1 ? "1 to 6 numbers" : "a number", p->low, p->high);
        n += (size_t)snprintf(line + n, SERVE_VALUE - n, "%s%.9g%s", count ? "," : "", p->scale * (x - p->from),
                              p->unit);
        count++;
    }
    return count ? 0 : err_set(e, NULL, 0, "%s without a value", p->name);
}

static int set(serve_us *u, const char *name, const char *value, err *e)
{
    char line[SERVE_VALUE];
    const int i = find(name);
    if (i < 0)
        return err_set(e, NULL, 0, "Invalid parameter %s", name);
    if (!parameters[i].set)
        return err_set(e, NULL, 0, "%s cannot be set: %s", name, parameters[i].why);
    if (!value)
        return err_set(e, NULL, 0, "%s without a value", name);
    if (line_of(&parameters[i], value, line, e) || serve_control_put(u->control, line, e))
        return -1;
    pthread_mutex_lock(&u->lock);
    snprintf(u->value[i], XML_VALUE, "%s", value);
    u->is_set[i] = true;
    pthread_mutex_unlock(&u->lock);
    return 0;
}

static int get(serve_us *u, const char *name, char value[XML_VALUE], err *e)
{
    const int i = find(name);
    if (i < 0)
        return err_set(e, NULL, 0, "Invalid parameter %s", name);
    pthread_mutex_lock(&u->lock);
    memcpy(value, u->value[i], XML_VALUE);
    pthread_mutex_unlock(&u->lock);
    return *value ? 0 : err_set(e, NULL, 0, "%s is not set: %s", name, parameters[i].why);
}

/* One parameter of a command, and what became of it. */
static void take_parameter(serve_us *u, const xml_tag *tag, bool sets, serve_answer *a, char errors[SERVE_TEXT])
{
    char name[XML_VALUE], value[XML_VALUE] = "";
    err e = {0};
    snprintf(name, sizeof name, "%s", xml_value(tag, "Name") ? xml_value(tag, "Name") : "");
    clean(name);
    const int failed = sets ? set(u, name, xml_value(tag, "Value"), &e) : get(u, name, value, &e);
    clean(value);
    add_text(a->text, "<Parameter Name=\"%s\" Success=\"%s\"", name, failed ? "false" : "true");
    if (!failed && !sets)
        add_text(a->text, " Value=\"%s\"", value);
    add_text(a->text, "/>");
    if (sets)
        add_pair(a, name, failed ? "FAIL" : "SUCCESS");
    else if (!failed)
        add_pair(a, name, value);
    if (!failed)
        return;
    clean(e.text);
    add_text(errors, "%s%s.", *errors ? " " : "", e.text);
    a->ok = false;
}

static void answer_parameters(serve_us *u, xml *x, bool sets, serve_answer *a)
{
    char errors[SERVE_TEXT] = "";
    xml_tag tag;
    err e = {0};
    int got, count = 0;
    a->ok = true;
    add_text(a->text, "<CommandReply>");
    while ((got = xml_next(x, &tag, &e)) > 0)
        if (!strcasecmp(tag.name, "Parameter") && count++ < PARAMETERS)
            take_parameter(u, &tag, sets, a, errors);
    if (got < 0 || !count || count > PARAMETERS) {
        a->ok = false;
        add_text(errors, "%sexpected 1 to %d elements Parameter.", *errors ? " " : "", PARAMETERS);
    }
    add_text(a->text, "</CommandReply>");
    snprintf(a->message, sizeof a->message, "%s", a->text);
    add_pair(a, "Status", a->ok ? "SUCCESS" : "FAIL");
    if (!a->ok)
        add_pair(a, "Error", errors);
}

/* ---- commands */

static bool is(const serve_answer *a, const char *name)
{
    return !strcasecmp(a->name, name);
}

static void answer(serve_us *u, xml *x, serve_answer *a)
{
    char text[SERVE_VALUE];
    if (is(a, "SetUsParameter") || is(a, "GetUsParameter"))
        answer_parameters(u, x, is(a, "SetUsParameter"), a);
    else if (is(a, "RequestChannelIDs"))
        answer_plainly(a, true, "VideoStream");
    else if (is(a, "RequestDeviceIDs"))
        answer_plainly(a, true, "VideoDevice");
    else if (is(a, "Version"))
        answer_plainly(a, true, "sinew " SINEW_VERSION);
    else {
        snprintf(text, sizeof text, "Unknown command name: %s.", a->name);
        answer_plainly(a, false, text);
    }
}

void serve_us_answer(serve_us *u, const char *name, const char *xml_text, size_t size, serve_answer *a)
{
    xml x = {"a command", "XML of PLUS", xml_text, xml_text, xml_text + size};
    xml_tag tag = {0};
    err e = {0};
    memset(a, 0, sizeof *a);
    const int got = xml_next(&x, &tag, &e);
    const char *said = got > 0 ? xml_value(&tag, "Name") : NULL;
    snprintf(a->name, sizeof a->name, "%s", said ? said : name);
    clean(a->name);
    if (got < 0)
        answer_plainly(a, false, "The command is no XML");
    else
        answer(u, &x, a);
}
