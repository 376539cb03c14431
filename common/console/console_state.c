/* The state as a page has it: see page/protocol.js. */
#include "console/console.h"

#include "base/num.h"
#include "console/json.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

static void put_key(const char *key, out *to)
{
    out_format(to, ",\"%s\":", key);
}

static void put_text(const char *key, const char *text, out *to)
{
    put_key(key, to);
    json_text_or_null(text, to);
}

static void put_bool(const char *key, bool is, out *to)
{
    out_format(to, ",\"%s\":%s", key, is ? "true" : "false");
}

/* The bytes of a name as an address has them. */
static void put_encoded(const char *name, out *to)
{
    for (const char *p = name; *p; p++) {
        const bool plain = strchr("-_.~", *p) || (*p >= '0' && *p <= '9') || ((*p | 32) >= 'a' && (*p | 32) <= 'z');
        out_format(to, plain ? "%c" : "%%%02X", (unsigned char)*p);
    }
}

static void put_cases(const console *c, out *to)
{
    for (int i = 0; i < c->cases.count; i++) {
        out_text(to, i ? ",{\"name\":" : "{\"name\":");
        json_text(c->cases.list[i].name, to);
        out_text(to, ",\"picture\":");
        if (c->cases.list[i].picture) {
            out_text(to, "\"/case/");
            put_encoded(c->cases.list[i].name, to);
            out_text(to, "/picture.png\"}");
        } else {
            out_text(to, "null}");
        }
    }
}

static const char *tool_name(const console *c)
{
    return c->face ? "tled-run" : "msds-run";
}

static void put_tool(const console *c, out *to)
{
    out_text(to, ",\"tool\":{\"name\":");
    json_text(tool_name(c), to);
    put_text("method", c->face ? NULL : c->method, to);
    out_text(to, c->face ? ",\"methods\":[]"
                         : ",\"methods\":[\"msds\",\"fem\",\"exact\",\"warp\",\"exact-warp\",\"tissue\"]");
    put_key("settings", to);
    dials_put(&c->dials, to);
    out_text(to, "}");
    if (c->face)
        return;
    out_text(to, ",\"image\":{\"settings\":");
    dials_put(&c->knobs, to);
    out_text(to, "},\"probe\":{\"shape\":");
    json_text_or_null(dials_value(&c->dials, "probe"), to);
    double row[7];
    pose_to_row(&c->pose, row);
    put_key("pose", to);
    json_numbers(row, 7, to);
    const char *word = steering_word(c->steering);
    put_text("from", c->by_hand || !word ? "hand" : word, to);
    out_text(to, "}");
}

static bool has(const char *name, const char *word)
{
    for (const char *p = name; *p; p++)
        if (!strncasecmp(p, word, strlen(word)))
            return true;
    return false;
}

static const char *side_of(const char *name)
{
    if (*name == '@')
        return "expression";
    const char *end = name + strlen(name);
    const bool l = end - name > 2 && !strcasecmp(end - 2, "_l"), r = end - name > 2 && !strcasecmp(end - 2, "_r");
    if (l || has(name, "left"))
        return "left";
    return r || has(name, "right") ? "right" : "middle";
}

static void put_muscles(const console *c, out *to)
{
    const char *name;
    out_text(to, ",\"muscles\":[");
    for (int64_t i = 0; (name = console_muscle(c, i)); i++) {
        out_text(to, i ? ",{\"name\":" : "{\"name\":");
        json_text(name, to);
        put_text("side", side_of(name), to);
        put_key("level", to);
        json_number(c->level[i], to);
        out_text(to, "}");
    }
    out_text(to, "]");
}

/* One or three lengths, m, as a number or an array. */
static void put_lengths(const char *text, out *to)
{
    num_length list[3];
    double metres[3];
    const int count = num_lengths_of(text, list, 3);
    for (int i = 0; i < count; i++)
        metres[i] = num_length_in(list[i], num_unit_of("m"), num_unit_of("m"));
    if (count == 1)
        json_number(metres[0], to);
    else
        json_numbers(metres, count > 0 ? count : 0, to);
}

/* "pull ID X,Y,Z RADIUS TX,TY,TZ K", but for its first word. */
static void put_pull(char *words, out *to)
{
    static const char *const keys[] = {"point", "radius", "target", "stiffness"};
    char *rest, *word = strtok_r(words, " ", &rest);
    out_text(to, "{\"id\":");
    json_text(word ? word : "", to);
    for (int k = 0; k < 4 && (word = strtok_r(NULL, " ", &rest)); k++) {
        put_key(keys[k], to);
        put_lengths(word, to);
    }
    out_text(to, "}");
}

static void put_pulls(const console *c, out *to)
{
    char line[CONSOLE_LINE];
    out_text(to, ",\"pulls\":[");
    for (int i = 0; i < c->pull_count; i++) {
        memcpy(line, c->pulls[i].line, sizeof line);
        out_text(to, i ? "," : "");
        put_pull(line + strcspn(line, " "), to);
    }
    out_text(to, "]");
}

static void put_child(const char *name, const child *is, bool *any, out *to)
{
    char how[80] = "";
    out_text(to, *any ? ",{\"tool\":" : "{\"tool\":");
    *any = true;
    json_text(name, to);
    put_bool("alive", is->pid, to);
    if (!is->pid)
        child_how(is, how, sizeof how);
    put_text("why", *how ? how : NULL, to);
    out_text(to, "}");
}

static void put_children(const console *c, out *to)
{
    bool any = false;
    out_text(to, ",\"children\":[");
    if (c->has_compute)
        put_child(tool_name(c), &c->compute, &any, to);
    if (c->has_slice)
        put_child("us-slice", &c->slice, &any, to);
    for (int i = 0; i < STEERING_PROGRAMS; i++) {
        const child *is = steering_program(c->steering, i);
        if (is)
            put_child(is->plan.tool, is, &any, to);
    }
    out_text(to, "]");
}

static void put_open(const console *c, out *to)
{
    if (c->open < 0) {
        out_text(to, ",\"case\":null,\"kind\":null,\"tool\":null,\"image\":null,\"probe\":null");
        return;
    }
    put_text("case", c->cases.list[c->open].name, to);
    put_text("kind", c->face ? "face" : "ultrasound", to);
    put_tool(c, to);
}

void console_send_state(console *c)
{
    char device[CONSOLE_WORD];
    err none = {0};
    out *o = out_memory(&none);
    if (!o)
        return;
    pthread_mutex_lock(&c->shared.lock);
    memcpy(device, c->shared.device, sizeof device);
    pthread_mutex_unlock(&c->shared.lock);
    out_text(o, "{\"type\":\"state\",\"cases\":[");
    put_cases(c, o);
    out_text(o, "]");
    put_open(c, o);
    put_muscles(c, o);
    put_pulls(c, o);
    put_bool("paused", c->paused, o);
    put_bool("recording", c->recording, o);
    put_bool("replaying", c->replaying, o);
    put_text("device", *device ? device : NULL, o);
    put_text("colour", colouring_name((colouring)atomic_load(&c->colour)), o);
    out_text(o, ",");
    colouring_put(o);
    put_children(c, o);
    put_text("why", *c->why ? c->why : NULL, o);
    out_text(o, "}");
    web_send(c->web, -1, MAIL_STATE, json_mail(o, &none));
}
