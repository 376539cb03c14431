#include "console/json.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/num.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void json_text(const char *text, out *to)
{
    err none = {0};
    char *copy = mem_text(text, &none);
    out_text(to, "\"");
    if (copy) {
        chars_mend(copy);
        for (const char *p = copy; *p; p++) {
            if (*p == '"' || *p == '\\')
                out_format(to, "\\%c", *p);
            else if ((unsigned char)*p < 0x20 || *p == 0x7f)
                out_format(to, "\\u%04x", (unsigned)*p);
            else
                out_write(to, p, 1);
        }
    }
    out_text(to, "\"");
    free(copy);
}

void json_text_or_null(const char *text, out *to)
{
    if (text)
        json_text(text, to);
    else
        out_text(to, "null");
}

void json_number(double value, out *to)
{
    char text[NUM_TEXT];
    if (!isfinite(value)) {
        out_text(to, "null");
        return;
    }
    num_text(value, false, text);
    out_text(to, text);
}

void json_numbers(const double *list, int count, out *to)
{
    for (int i = 0; i < count; i++) {
        out_text(to, i ? "," : "[");
        json_number(list[i], to);
    }
    out_text(to, count ? "]" : "[]");
}

mail *json_mail(out *from, err *e)
{
    size_t size;
    if (!from)
        return NULL;
    const unsigned char *bytes = out_bytes(from, &size);
    mail *m = out_failed(from, e) ? NULL : mail_make(true, size, e);
    if (m)
        memcpy(m->bytes, bytes, size);
    out_discard(from);
    return m;
}

mail *json_said(const char *level, const char *tool, const char *text)
{
    err none = {0};
    out *o = out_memory(&none);
    if (!o)
        return NULL;
    out_text(o, "{\"type\":\"said\",\"level\":");
    json_text(level, o);
    out_text(o, ",\"tool\":");
    json_text_or_null(tool, o);
    out_text(o, ",\"text\":");
    json_text(text, o);
    out_text(o, "}");
    return json_mail(o, &none);
}

mail *json_saved(const char *name)
{
    err none = {0};
    char url[300];
    out *o = out_memory(&none);
    if (!o)
        return NULL;
    snprintf(url, sizeof url, "/save/%.250s", name);
    out_text(o, "{\"type\":\"saved\",\"name\":");
    json_text(name, o);
    out_text(o, ",\"url\":");
    json_text(url, o);
    out_text(o, "}");
    return json_mail(o, &none);
}
