// The cases that a console offers, of files and folders; and what a page is told of settings.
// needs: common/console/cases.c common/console/dials.c common/console/json.c common/console/mailbox.c
#include "console/cases.h"
#include "console/dials.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/sinew-cases-XXXXXX";

static const char *path(const char *name)
{
    static char text[4][300];
    static int next;
    char *to = text[next++ % 4];
    snprintf(to, sizeof text[0], "%s/%s", folder, name);
    return to;
}

static void make(const char *name)
{
    FILE *f = fopen(path(name), "w");
    if (!f || fclose(f))
        printf("# cannot make %s\n", name);
}

/* Adds what is at these paths (up to the first NULL). */
static int add(cases *c, const char *a, const char *b, const char *d, err *e)
{
    char *list[3] = {NULL};
    int count = 0;
    const char *const from[3] = {a, b, d};
    for (; count < 3 && from[count]; count++)
        list[count] = strdup(path(from[count]));
    const int failed = cases_add(c, list, count, e);
    for (int i = 0; i < count; i++)
        free(list[i]);
    return failed;
}

static bool ends(const char *text, const char *with)
{
    return text && strlen(text) >= strlen(with) && !strcmp(text + strlen(text) - strlen(with), with);
}

static void try_folders(void)
{
    cases c = {0};
    err e = {0};
    mkdir(path("all"), 0777);
    mkdir(path("all/arm of a friend"), 0777);
    mkdir(path("all/nothing"), 0777);
    make("all/arm of a friend/mesh.sinew");
    make("all/arm of a friend/arm.sinew");
    make("all/arm of a friend/labels.nrrd");
    make("all/arm of a friend/scan.mha");
    make("all/arm of a friend/picture.png");
    make("all/arm of a friend/body.txt");
    make("all/arm of a friend/skin.obj");
    make("all/arm of a friend/expressions.txt");
    make("all/face.sinew");
    make("all/notes.txt");
    ok(!add(&c, "all", NULL, NULL, &e) && c.count == 2, "a folder of cases: %d of them%s", c.count, e.text);
    const int arm = cases_find(&c, "arm of a friend"), face = cases_find(&c, "face");
    ok(arm >= 0 && ends(c.list[arm].model, "/mesh.sinew") && ends(c.list[arm].volume, "/scan.mha"), "the arm");
    ok(arm >= 0 && ends(c.list[arm].labels, "/labels.nrrd") && ends(c.list[arm].picture, "/picture.png"), "all of it");
    ok(arm >= 0 && ends(c.list[arm].body, "/body.txt") && ends(c.list[arm].skin, "/skin.obj") && !c.list[arm].bones,
       "and the body around it");
    ok(arm >= 0 && ends(c.list[arm].expressions, "/expressions.txt"), "and expressions");
    ok(face >= 0 && !c.list[face].volume && !c.list[face].picture, "the face");
    ok(!add(&c, "all/arm of a friend", NULL, NULL, &e) && c.count == 3, "a folder that is a case");
    ok(cases_find(&c, "arm of a friend-2") == 2, "has a name of its own");
    ok(cases_find(&c, "notes") < 0 && cases_find(&c, "nothing") < 0 && cases_find(&c, "") < 0, "nothing else is one");
    cases_free(&c);
}

static void try_files(void)
{
    cases c = {0};
    err e = {0};
    make("a.sinew");
    make("a.nrrd");
    make("b.sinew");
    ok(!add(&c, "a.sinew", "a.nrrd", "b.sinew", &e) && c.count == 2, "models, one with its volume");
    ok(ends(c.list[0].volume, "/a.nrrd") && !c.list[1].volume, "which is the first's");
    ok(add(&c, "a.nrrd", NULL, NULL, &e) == -1 && strstr(e.text, "a volume without a model"), "%s", e.text);
    e = (err){0};
    ok(add(&c, "none", NULL, NULL, &e) == -1 && strstr(e.text, "cannot open"), "%s", e.text);
    e = (err){0};
    ok(add(&c, "all/nothing", NULL, NULL, &e) == -1 && strstr(e.text, "there is no case"), "%s", e.text);
    cases_free(&c);
}

static void try_dials(void)
{
    err e = {0};
    size_t size;
    dials d = dials_of_slice(false);
    dials_note(&d, "set gain 12");
    dials_note(&d, "set nonsense 1");
    dials_note(&d, "set gain");
    dials_note(&d, "method fem");
    out *o = out_memory(&e);
    dials_put(&d, o);
    char text[4000];
    const unsigned char *bytes = out_bytes(o, &size);
    snprintf(text, sizeof text, "%.*s", (int)size, (const char *)bytes);
    ok(!strcmp(dials_value(&d, "gain"), "12") && !dials_value(&d, "nonsense"), "a value is noted");
    ok(strstr(text, "\"gain\":{\"value\":\"12\",\"unit\":\"dB\",\"default\":\"0\",") != NULL, "and told with its unit");
    ok(strstr(text, "\"choices\":[\"on\",\"off\"]") != NULL, "choices are a list");
    ok(!strstr(text, "\"labels\""), "labels are no setting where there are none");
    ok(text[0] == '{' && text[size - 1] == '}' && !strstr(text, ",}") && !strstr(text, "{,"), "it is whole");
    out_discard(o);
}

int main(void)
{
    if (!ok(mkdtemp(folder) != NULL, "a folder"))
        return done_testing();
    try_folders();
    try_files();
    try_dials();
    static const char *const made[] = {"all/arm of a friend/mesh.sinew",
                                       "all/arm of a friend/arm.sinew",
                                       "all/arm of a friend/labels.nrrd",
                                       "all/arm of a friend/scan.mha",
                                       "all/arm of a friend/picture.png",
                                       "all/arm of a friend/body.txt",
                                       "all/arm of a friend/skin.obj",
                                       "all/arm of a friend/expressions.txt",
                                       "all/face.sinew",
                                       "all/notes.txt",
                                       "a.sinew",
                                       "a.nrrd",
                                       "b.sinew"};
    for (size_t i = 0; i < sizeof made / sizeof *made; i++)
        unlink(path(made[i]));
    rmdir(path("all/arm of a friend"));
    rmdir(path("all/nothing"));
    rmdir(path("all"));
    ok(!rmdir(folder), "nothing else was made");
    return done_testing();
}
