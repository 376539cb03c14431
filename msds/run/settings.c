#include "msds/run/settings.h"

#include "base/mem.h"
#include "base/near.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Each key is an option's name. */
static const struct {
    const char *key;
    session_part part; /* that has to take it over */
} settings[] = {
    {"iterations", SESSION_PACE},   {"rate", SESSION_PACE},         {"dt", SESSION_STEP},
    {"mass", SESSION_STEP},         {"damping", SESSION_SPRINGS},   {"spring-scale", SESSION_SPRINGS},
    {"repulsion", SESSION_SPRINGS}, {"contact", SESSION_FORCES},    {"friction", SESSION_FORCES},
    {"gravity", SESSION_FORCES},    {"probe", SESSION_PROBE},       {"skin-stiffness", SESSION_SKIN},
    {"skin-anchors", SESSION_SKIN}, {"skin-tension", SESSION_SKIN}, {"cavity", SESSION_CAVITIES},
};

enum { SETTINGS = sizeof settings / sizeof *settings };

int settings_count(void)
{
    return SETTINGS;
}

static int find_key(const keyfile *k, err *e)
{
    const char *names[SETTINGS];
    for (int i = 0; i < SETTINGS; i++) {
        names[i] = settings[i].key;
        if (!strcmp(names[i], k->word[1]))
            return i;
    }
    return near_unknown(e, k->name, k->line, "setting", k->word[1], names, SETTINGS);
}

/* The value as the option would take it, into a copy of the options, from a text that lasts. */
static int parse(const session *s, const keyfile *k, int i, struct options *to, char **text, err *e)
{
    err wrong = {0};
    *to = *s->o;
    *text = mem_text(k->word[2], e);
    if (!*text)
        return -1;
    if (opt_set(&run_options_table, settings[i].key, *text, to, &wrong)) {
        free(*text);
        keyfile_error(k, e, "%s", wrong.text);
        return -1;
    }
    if (settings[i].part == SESSION_PROBE && !strcmp(*text, "none"))
        to->probe = NULL;
    return 0;
}

/* Of friction: what the method and the device can do. */
static int check_friction(const session *s, const keyfile *k, method_word method, double friction, err *e)
{
    err wrong = {0};
    if (session_slides(s, method, friction, &wrong))
        return keyfile_error(k, e, "%s", wrong.text);
    if (friction > 0 && !(s->device->is.features & EXECUTOR_FRICTION))
        return keyfile_error(k, e, "friction %g is not done on a card; expected -d cpu", friction);
    return 0;
}

static bool has_file(const char *shape)
{
    return shape && !strncmp(shape, "convex:", 7);
}

static int check(const session *s, const keyfile *k, int i, const struct options *to, err *e)
{
    if (settings[i].part == SESSION_PROBE && has_file(to->probe))
        return keyfile_error(k, e, "set probe %.100s; expected a shape that needs no file, such as sphere:2cm",
                             to->probe);
    if (settings[i].part == SESSION_CAVITIES && !s->cavities.count)
        return keyfile_error(k, e, "set %s, but there is no cavity; expected --cavity", settings[i].key);
    if (settings[i].part == SESSION_SKIN && !s->skin.vertices)
        return keyfile_error(k, e, "set %s, but there is no skin; expected --skin", settings[i].key);
    return check_friction(s, k, s->method, to->friction, e);
}

/* Makes the options those of `to`; where that fails, as they were. */
static int adopt(session *s, const keyfile *k, int i, const struct options *to, err *e)
{
    const struct options before = *s->o;
    err wrong = {0}, none = {0};
    *s->o = *to;
    if (!session_change(s, settings[i].part, &wrong))
        return 0;
    *s->o = before;
    if (settings[i].part != SESSION_PROBE)
        session_change(s, settings[i].part, &none); /* as it was once already */
    return keyfile_error(k, e, "%s", wrong.text);
}

static int take_setting(session *s, const keyfile *k, err *e)
{
    struct options to;
    char *text;
    if (k->count != 3)
        return keyfile_error(k, e, "%d words after set; expected set KEY VALUE", k->count - 1);
    const int i = find_key(k, e);
    if (i < 0)
        return -1;
    if (parse(s, k, i, &to, &text, e))
        return -1;
    if (check(s, k, i, &to, e) || adopt(s, k, i, &to, e)) {
        free(text);
        return -1;
    }
    free(s->text[i]);
    s->text[i] = text;
    tool_detail(s->t, "line %lld: %s is %s from here on", (long long)k->line, settings[i].key, text);
    return 0;
}

static int take_method(session *s, const keyfile *k, err *e)
{
    if (k->count != 2)
        return keyfile_error(k, e, "%d words after method; expected method fem, or method msds", k->count - 1);
    const int method = methods_find(k->word[1]);
    if (method < 0)
        return near_unknown(e, k->name, k->line, "method", k->word[1], methods_words, METHOD_WORDS);
    const method_word to = methods_with((method_word)method, s->o->exact, s->o->warp);
    if (s->cavities.count && to != METHOD_TISSUE)
        return keyfile_error(k, e, "method %s with --cavity; expected method tissue", methods_words[to]);
    if (methods_features(to) & ~s->device->is.features)
        return keyfile_error(k, e, "method %s is not done on a card; expected -d cpu", methods_words[to]);
    if (check_friction(s, k, (method_word)method, s->o->friction, e))
        return -1;
    session_method(s, (method_word)method);
    tool_detail(s->t, "line %lld: the method is %s from here on", (long long)k->line, k->word[1]);
    return 0;
}

int settings_take(session *s, const keyfile *k, err *e)
{
    progress_clear(&s->progress);
    if (!strcmp(k->word[0], "method"))
        return take_method(s, k, e);
    if (!strcmp(k->word[0], "set"))
        return take_setting(s, k, e);
    return keyfile_error(k, e, "'%.100s'; expected method NAME, or set KEY VALUE", k->word[0]);
}

/* The option's row. */
static const opt *row_of(int i)
{
    const opt *o = run_options_table.options;
    while (strcmp(o->name, settings[i].key) != 0)
        o++;
    return o;
}

/* The word of a choice. */
static void put_choice(const char *choices, int at, char *to, size_t size)
{
    while (at--)
        choices = strchr(choices, '|') + 1;
    snprintf(to, size, "%.*s", (int)strcspn(choices, "|"), choices);
}

static void put_numbers(const opt_numbers *list, char *to, size_t size)
{
    char number[3][NUM_TEXT];
    for (int a = 0; a < 3; a++)
        num_text(list->count ? list->value[a] : 0, false, number[a]);
    snprintf(to, size, "%s,%s,%s", number[0], number[1], number[2]);
}

static void put_value(const opt *o, const void *at, char *to, size_t size)
{
    char number[NUM_TEXT];
    if (o->kind == OPT_CHOICE) {
        put_choice(o->choices, *(const int *)at, to, size);
    } else if (o->kind == OPT_NUMBERS) {
        put_numbers(at, to, size);
    } else if (o->kind == OPT_TEXT) {
        const char *text = *(const char *const *)at;
        snprintf(to, size, "%s", text ? text : "none");
    } else {
        num_text(o->kind == OPT_INT ? (double)*(const int64_t *)at : *(const double *)at, false, number);
        snprintf(to, size, "%s", number);
    }
}

bool settings_text(const session *s, int i, char text[SETTINGS_TEXT])
{
    char value[SETTINGS_TEXT - 40];
    if ((settings[i].part == SESSION_SKIN && !s->skin.vertices) ||
        (settings[i].part == SESSION_CAVITIES && !s->cavities.count) ||
        (settings[i].part == SESSION_PROBE && has_file(s->o->probe)))
        return false;
    const opt *o = row_of(i);
    put_value(o, (const char *)s->o + o->to, value, sizeof value);
    snprintf(text, SETTINGS_TEXT, "set %s %s", settings[i].key, value);
    return true;
}
