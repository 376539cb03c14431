#include "base/xml.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

int64_t xml_line(const xml *x, const char *at)
{
    int64_t line = 1;
    for (const char *p = x->text; p < at; p++)
        line += *p == '\n';
    return line;
}

int xml_find(const xml_tag *tag, const char *key)
{
    for (int i = 0; i < tag->count; i++)
        if (!strcmp(tag->key[i], key))
            return i;
    return -1;
}

const char *xml_value(const xml_tag *tag, const char *key)
{
    const int i = xml_find(tag, key);
    return i < 0 ? NULL : tag->value[i];
}

static int bad(const xml *x, const char *at, const char *what, err *e)
{
    return err_set(e, x->name, xml_line(x, at), "%s; expected %s", what, x->what);
}

/* Past the first `what` from p on; NULL: there is none. */
static const char *past(const char *p, const char *end, const char *what)
{
    const size_t n = strlen(what);
    for (; p && (size_t)(end - p) >= n; p++) {
        p = memchr(p, what[0], (size_t)(end - p));
        if (!p || (size_t)(end - p) < n)
            return NULL;
        if (!memcmp(p, what, n))
            return p + n;
    }
    return NULL;
}

/* A word of a name's characters. Returns past it; NULL: it is too long. */
static const char *take_name(const char *p, const char *end, char *to)
{
    int n = 0;
    for (; p < end && !isspace((unsigned char)*p) && *p != '=' && *p != '>' && !(*p == '/' && n); p++) {
        if (n == XML_VALUE - 1)
            return NULL;
        to[n++] = *p;
    }
    to[n] = '\0';
    return p;
}

static const char *past_blanks(const char *p, const char *end)
{
    while (p < end && isspace((unsigned char)*p))
        p++;
    return p;
}

/* KEY="VALUE"; values too long for what is looked at are cut. */
static const char *take_attribute(const char *p, const char *end, xml_tag *tag)
{
    char key[XML_VALUE], value[XML_VALUE];
    int n = 0;
    p = take_name(p, end, key);
    p = p && *key ? past_blanks(p, end) : NULL;
    if (!p || p >= end || *p++ != '=')
        return NULL;
    p = past_blanks(p, end);
    if (p >= end || (*p != '"' && *p != '\''))
        return NULL;
    const char quote = *p++, *begin = p;
    for (; p < end && *p != quote; p++)
        if (n < XML_VALUE - 1)
            value[n++] = *p;
    value[n] = '\0';
    if (p >= end)
        return NULL;
    if (tag->count < XML_ATTRIBUTES) {
        tag->whole[tag->count] = begin;
        tag->whole_end[tag->count] = p;
        memcpy(tag->key[tag->count], key, sizeof key);
        memcpy(tag->value[tag->count++], value, sizeof value);
    }
    return p + 1;
}

static const char *take_tag(const char *p, const char *end, xml_tag *tag)
{
    tag->count = 0;
    tag->closed = false;
    p = take_name(p, end, tag->name);
    if (!p || !*tag->name)
        return NULL;
    for (;;) {
        p = past_blanks(p, end);
        if (p >= end)
            return NULL;
        if (*p == '>')
            return p + 1;
        if (*p == '/' && p + 1 < end && p[1] == '>') {
            tag->closed = true;
            return p + 2;
        }
        p = take_attribute(p, end, tag);
        if (!p)
            return NULL;
    }
}

int xml_next(xml *x, xml_tag *tag, err *e)
{
    for (;;) {
        const char *open = memchr(x->at, '<', (size_t)(x->end - x->at));
        if (!open)
            return 0;
        const size_t left = (size_t)(x->end - open);
        const char *after = NULL;
        if (left > 1 && open[1] == '?')
            after = past(open, x->end, "?>");
        else if (left > 3 && !memcmp(open, "<!--", 4))
            after = past(open, x->end, "-->");
        else if (left > 1 && open[1] == '!')
            return bad(x, open, "a declaration", e);
        else {
            after = take_tag(open + 1, x->end, tag);
            tag->begin = open;
            if (!after)
                return bad(x, open, "a malformed tag", e);
            x->at = after;
            return 1;
        }
        if (!after)
            return bad(x, open, "a comment without an end", e);
        x->at = after;
    }
}
