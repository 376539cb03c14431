#include "console/message.h"

#include "base/keyfile.h"
#include "base/near.h"
#include "base/num.h"

#include <stdio.h>
#include <string.h>

typedef struct verb verb;

struct verb {
    const char *name;
    message_kind kind;
    int few, most; /* words after it */
    const char *wanted;
    int (*take)(const verb *v, const keyfile *k, message *to, err *e);
};

/* ---- how words are taken */

static int take_pose(const verb *v, const keyfile *k, message *to, err *e)
{
    double row[7];
    for (int i = 0; i < 7; i++)
        if (num_double(k->word[i + 1], &row[i]))
            return keyfile_error(k, e, "pose: '%.60s' is no number; expected %s", k->word[i + 1], v->wanted);
    to->at = pose_of_row(row);
    const double length = pose_unit(to->at.quaternion);
    if (!pose_is_unit(length))
        return keyfile_error(k, e, "pose: a quaternion of length %.6g; expected 1", length);
    return 0;
}

static int take_switch(const verb *v, const keyfile *k, message *to, err *e)
{
    to->on = !strcmp(k->word[1], "on");
    if (to->on || !strcmp(k->word[1], "off"))
        return 0;
    return keyfile_error(k, e, "%s '%.60s'; expected %s", v->name, k->word[1], v->wanted);
}

/* The words from the i-th on, with a blank between them: no longer than the message was. */
static void join(const keyfile *k, int i, char *to)
{
    char *at = to;
    for (; i < k->count; i++)
        at += sprintf(at, "%s%s", at == to ? "" : " ", k->word[i]);
}

static int take_line(const verb *v, const keyfile *k, message *to, err *e)
{
    (void)v;
    (void)e;
    join(k, 0, to->line);
    return 0;
}

static int take_word(const verb *v, const keyfile *k, message *to, err *e)
{
    (void)v;
    (void)e;
    join(k, 1, to->line);
    return 0;
}

/* `image KEY VALUE` is us-slice's `set KEY VALUE`: a word that is shorter. */
static int take_image(const verb *v, const keyfile *k, message *to, err *e)
{
    char rest[MESSAGE_MOST + 1];
    (void)v;
    (void)e;
    join(k, 1, rest);
    snprintf(to->line, sizeof to->line, "set %.*s", MESSAGE_MOST - 4, rest);
    return 0;
}

static int take_save(const verb *v, const keyfile *k, message *to, err *e)
{
    join(k, 1, to->line);
    if (!strcmp(to->line, "image") || !strcmp(to->line, "model"))
        return 0;
    return keyfile_error(k, e, "save '%.60s'; expected %s", k->word[1], v->wanted);
}

static int take_none(const verb *v, const keyfile *k, message *to, err *e)
{
    (void)v;
    (void)k;
    (void)to;
    (void)e;
    return 0;
}

/* ---- the table */

enum { MANY = KEYFILE_WORDS };

static const verb verbs[] = {
    {"pose", MESSAGE_POSE, 7, 7, "pose TX TY TZ QX QY QZ QW", take_pose},
    {"method", MESSAGE_TOOL, 1, 1, "method NAME", take_line},
    {"set", MESSAGE_TOOL, 2, 2, "set KEY VALUE", take_line},
    {"image", MESSAGE_IMAGE, 2, 2, "image KEY VALUE", take_image},
    {"now", MESSAGE_TOOL, 1, MANY, "now VERB ...", take_line},
    {"pull", MESSAGE_TOOL, 5, 5, "pull ID X,Y,Z RADIUS TX,TY,TZ K", take_line},
    {"colour", MESSAGE_COLOUR, 1, 1, "colour NAME", take_word},
    {"release", MESSAGE_TOOL, 1, 1, "release ID", take_line},
    {"pause", MESSAGE_PAUSE, 1, 1, "pause on, or pause off", take_switch},
    {"step", MESSAGE_STEP, 0, 0, "step", take_none},
    {"reset", MESSAGE_RESET, 0, 0, "reset", take_none},
    {"record", MESSAGE_RECORD, 1, 1, "record on, or record off", take_switch},
    {"save", MESSAGE_SAVE, 1, 1, "save image, or save model", take_save},
    {"replay", MESSAGE_REPLAY, 0, 0, "replay", take_none},
    /* Its operand may have blanks: take_open is asked first. */
    {"open", MESSAGE_OPEN, 1, MANY, "open CASE", take_line},
};

enum { VERBS = sizeof verbs / sizeof *verbs };

static const verb *find(const char *name, err *e)
{
    const char *names[VERBS];
    for (int i = 0; i < VERBS; i++) {
        names[i] = verbs[i].name;
        if (!strcmp(name, names[i]))
            return &verbs[i];
    }
    near_unknown(e, NULL, 0, "message", name, names, VERBS);
    return NULL;
}

static int take_words(const keyfile *k, message *to, err *e)
{
    const verb *v = find(k->word[0], e);
    if (!v)
        return -1;
    to->kind = v->kind;
    const int words = k->count - 1;
    if (words < v->few || words > v->most)
        return keyfile_error(k, e, "%s with %d words; expected %s", v->name, words, v->wanted);
    return v->take(v, k, to, e);
}

/* A case's name is what stands behind the verb. */
static bool take_open(const char *text, message *to)
{
    if (strncmp(text, "open ", 5) != 0 || !text[5 + strspn(text + 5, " \t")])
        return false;
    to->kind = MESSAGE_OPEN;
    snprintf(to->line, sizeof to->line, "%s", text + 5 + strspn(text + 5, " \t"));
    return true;
}

int message_read(const char *text, size_t size, message *to, err *e)
{
    char line[MESSAGE_MOST + 1], words[MESSAGE_MOST + 1];
    keyfile k = {0};
    *to = (message){0};
    if (size && text[size - 1] == '\n')
        size--;
    if (size > MESSAGE_MOST)
        return err_set(e, NULL, 0, "a message of %zu bytes; expected at most %d", size, MESSAGE_MOST);
    if (memchr(text, 0, size))
        return err_set(e, NULL, 0, "a message with a NUL; expected a line of text");
    memcpy(line, text, size);
    line[size] = '\0';
    strcpy(words, line);
    const int got = keyfile_take(&k, words, (int64_t)size, 0, e);
    if (got < 0)
        return -1;
    if (!got)
        return err_set(e, NULL, 0, "an empty message; expected a line such as 'method fem'");
    return take_open(line, to) ? 0 : take_words(&k, to, e);
}
