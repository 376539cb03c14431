#include "volume/nrrd_labels.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/num.h"
#include "volume/header.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { ENTRIES = 4096, DIGITS = 9 }; /* the most segments; of their numbers */

/* The entry of that number, made where it is new. */
static labels_entry *entry_of(labels_in *l, int64_t number, const in *s, err *e)
{
    for (int64_t i = 0; i < l->count; i++)
        if (l->entry[i].number == number)
            return &l->entry[i];
    if (l->count == ENTRIES) {
        err_set(e, in_name(s), in_lines(s), "more than %d segments", ENTRIES);
        return NULL;
    }
    if (MEM_ROOM(&l->entry, &l->room, l->count + 1, "labels", e))
        return NULL;
    l->entry[l->count] = (labels_entry){.number = number};
    return &l->entry[l->count++];
}

/* NRRD writes a line's end as \\n, which is a blank here, and a backslash as two. */
static void unescape(char *text)
{
    char *to = text;
    while (*text) {
        bool escaped = *text == '\\' && text[1];
        char c = escaped && text[1] == 'n' ? ' ' : text[escaped];
        text += 1 + escaped;
        *to++ = c;
    }
    *to = '\0';
}

static int take_name(labels_entry *of, char *value, const in *s, err *e)
{
    unescape(value);
    if (!chars_utf8(value))
        return err_set(e, in_name(s), in_lines(s), "the name of a segment is not UTF-8; expected text in UTF-8");
    free(of->name);
    of->name = mem_text(header_trim(value), e);
    return of->name ? 0 : -1;
}

int labels_in_take(labels_in *l, const in *s, const char *key, char *value, err *e)
{
    static const char begin[] = "Segment";
    int64_t number = 0;
    int digits = 0;
    if (strncmp(key, begin, strlen(begin)))
        return 0;
    const char *p = key + strlen(begin);
    for (; isdigit((unsigned char)*p) && digits < DIGITS; p++, digits++)
        number = number * 10 + (*p - '0');
    bool named = !strcmp(p, "_Name"), valued = !strcmp(p, "_LabelValue");
    if (!digits || (!named && !valued))
        return 0;
    labels_entry *of = entry_of(l, number, s, e);
    if (!of)
        return -1;
    if (named)
        return take_name(of, value, s, e);
    of->valued = true;
    return header_integers(s, key, value, INT64_MIN, INT64_MAX, &of->value, 1, e);
}

int labels_in_give(const labels_in *l, volume *v, err *e)
{
    for (int64_t i = 0; i < l->count; i++) {
        const labels_entry *of = &l->entry[i];
        if (of->name && *of->name && of->valued && volume_name(v, of->value, of->name, e))
            return -1;
    }
    return 0;
}

void labels_in_free(labels_in *l)
{
    for (int64_t i = 0; i < l->count; i++)
        free(l->entry[i].name);
    free(l->entry);
    *l = (labels_in){0};
}

static void put_escaped(const char *text, out *to)
{
    for (; *text; text++)
        if (*text == '\\')
            out_text(to, "\\\\");
        else if (*text == '\n')
            out_text(to, "\\n");
        else
            out_write(to, text, 1);
}

void labels_write(const volume *v, out *to)
{
    for (int i = 0; i < v->labels; i++) {
        out_format(to, "Segment%d_ID:=Segment_%d\nSegment%d_LabelValue:=%" PRId64 "\nSegment%d_Name:=", i, i + 1, i,
                   v->label[i].value, i);
        put_escaped(v->label[i].name, to);
        out_text(to, "\n");
    }
}
