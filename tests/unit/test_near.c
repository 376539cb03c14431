/* Names that are near others, lists of names, and the message that offers them. */
#include "base/near.h"

#include "tap.h"

#include <string.h>

static const char *const keys[] = {"level", "priority", "material", "surfaces"};

static void near_misses(void)
{
    const char *names[] = {"skin", "skull", "muscle_zyg"};
    ok(near_name("skul", names, 3) == 1, "skul is near skull");
    ok(near_name("MUSCLE_ZYK", names, 3) == 2, "letters of either case");
    ok(near_name("muscle_zgy", names, 3) == 2, "a swap is one edit");
    ok(near_name("liver", names, 3) == -1, "liver is near nothing");
}

static void lists(void)
{
    char to[27];
    near_list(to, sizeof to, keys, 2);
    ok(!strcmp(to, "level, priority"), "names between commas: %s", to);
    near_list(to, sizeof to, keys, 4);
    ok(!strcmp(to, "level, priority, ..."), "as many as fit: %s", to);
    near_list(to, sizeof to, keys, 0);
    ok(!*to, "of none");
}

static void unknown(void)
{
    err e = {0};
    ok(near_unknown(&e, NULL, 0, "thing", "x", NULL, 0) == -1 && strstr(e.text, "none here"), "no names: %s", e.text);
    e = (err){0};
    near_unknown(&e, "p", 7, "key", "levl", keys, 4);
    ok(!strcmp(e.text, "p:7: unknown key 'levl'; did you mean 'level'? expected one of: level, priority, material, "
                       "surfaces"),
       "a near name is offered: %s", e.text);
    e = (err){0};
    near_unknown(&e, "p", 7, "key", "qqqqqqqq", keys, 4);
    ok(!strstr(e.text, "did you mean") && strstr(e.text, "material"), "a far one is not: %s", e.text);
    const char *muscles[] = {"Zyg_left", "skin", "zyg_right", "zyg_lower", "zyg_upper"};
    e = (err){0};
    near_unknown(&e, NULL, 0, "muscle", "zyg", muscles, 3);
    ok(strstr(e.text, "did you mean 'Zyg_left' or 'zyg_right'? expected"), "what begins so: %s", e.text);
    e = (err){0};
    near_unknown(&e, NULL, 0, "muscle", "zyg", muscles, 5);
    ok(strstr(e.text, "'zyg_right' or 'zyg_lower'? expected"), "three at most: %s", e.text);
    e = (err){0};
    near_unknown(&e, NULL, 0, "muscle", "", muscles, 5);
    ok(!strstr(e.text, "did you mean"), "all begin with nothing: %s", e.text);
    e = (err){0};
    ok(near_option(&e, "-c", "key", "levl", keys, 4) == -1 && e.status == STATUS_USAGE &&
           !strncmp(e.text, "-c: unknown key 'levl'; did you mean 'level'? expected one of: level", 68),
       "on the command line: %s", e.text);
    e = (err){0};
    near_unknown(&e, NULL, 0, "key", "caf\xe8\x1b", keys, 4);
    ok(!strncmp(e.text, "unknown key 'caf\\xe8\\x1b'; ", 27), "bytes of any kind: %s", e.text);
    const char *many[100];
    for (int i = 0; i < 100; i++)
        many[i] = "a_long_name_of_a_thing";
    e = (err){0};
    near_unknown(&e, NULL, 0, "key", "b", many, 100);
    ok(strlen(e.text) < 500 && strstr(e.text, ", ..."), "a long list is cut (%zu bytes)", strlen(e.text));
}

int main(void)
{
    near_misses();
    lists();
    unknown();
    return done_testing();
}
