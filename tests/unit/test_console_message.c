// What a page may ask for: each message as a struct, and what is none refused with a word.
// needs: common/console/message.c
#include "base/chars.h"
#include "console/message.h"
#include "tap.h"

#include <string.h>

/* A text as a test's name has it. */
static const char *shown(const char *text)
{
    static char name[80];
    snprintf(name, sizeof name, "%.60s", text);
    chars_tame(name);
    return name;
}

static void takes(const char *text, message_kind kind, const char *line)
{
    message m;
    err e = {0};
    if (!ok(!message_read(text, strlen(text), &m, &e), "'%s' is taken", shown(text)))
        printf("# %s\n", e.text);
    ok(m.kind == kind && !strcmp(m.line, line), "its line is '%s', expected '%s'", m.line, line);
}

static void refuses(const char *text, const char *part)
{
    message m;
    err e = {0};
    ok(message_read(text, strlen(text), &m, &e) == -1 && strstr(e.text, part), "'%s' is refused: %s", shown(text),
       e.text);
}

static void try_pose(void)
{
    message m;
    err e = {0};
    const char *text = "pose 0.1 -0.2 3e-1 0 0 0 1.001\n";
    ok(!message_read(text, strlen(text), &m, &e) && m.kind == MESSAGE_POSE, "a pose");
    near_(m.at.position[0], .1, 1e-15, "its place");
    near_(m.at.position[2], .3, 1e-15, "in all three");
    near_(m.at.quaternion[3], 1, 1e-15, "its quaternion has length 1");
    refuses("pose 0 0 0 0 0 0 2", "a quaternion of length 2; expected 1");
    refuses("pose 0 0 0 0 0 0 0", "a quaternion of length 0");
    refuses("pose nan 0 0 0 0 0 1", "'nan' is no number");
    refuses("pose 1e999 0 0 0 0 0 1", "is no number");
    refuses("pose 0 0 0 0 0 0", "pose with 6 words; expected pose TX TY TZ QX QY QZ QW");
    refuses("pose 0 0 0 0 0 0 1 1", "with 8 words");
}

static void try_long(void)
{
    static char text[MESSAGE_MOST + 2];
    message m;
    err e = {0};
    memset(text, 'x', sizeof text);
    strcpy(text, "now ");
    text[4] = 'x';
    ok(!message_read(text, MESSAGE_MOST, &m, &e) && strlen(m.line) == MESSAGE_MOST, "a message of the most bytes");
    ok(message_read(text, MESSAGE_MOST + 1, &m, &e) == -1 && strstr(e.text, "expected at most 4096"),
       "and one more: %s", e.text);
    e = (err){0};
    ok(message_read("step\0step", 9, &m, &e) == -1 && strstr(e.text, "NUL"), "a NUL: %s", e.text);
    memset(text, 0, sizeof text);
    strcpy(text, "image ");
    for (int i = 6; i < MESSAGE_MOST - 3; i += 2)
        strcpy(text + i, "a ");
    refuses(text, "more than 64 words");
}

int main(void)
{
    takes("method exact-warp", MESSAGE_TOOL, "method exact-warp");
    takes("set  iterations\t30", MESSAGE_TOOL, "set iterations 30");
    takes("image gain 6", MESSAGE_IMAGE, "set gain 6");
    takes("now contract zyg_left 0.4", MESSAGE_TOOL, "now contract zyg_left 0.4");
    takes("pull hand 0,0,0.1 0.01 0,0,0.2 50", MESSAGE_TOOL, "pull hand 0,0,0.1 0.01 0,0,0.2 50");
    takes("release hand # let go", MESSAGE_TOOL, "release hand");
    takes("colour quality", MESSAGE_COLOUR, "quality");
    takes("open arm of a friend", MESSAGE_OPEN, "arm of a friend");
    takes("open #1", MESSAGE_OPEN, "#1");
    takes("save image", MESSAGE_SAVE, "image");
    takes("step", MESSAGE_STEP, "");
    takes("reset\n", MESSAGE_RESET, "");
    takes("replay", MESSAGE_REPLAY, "");
    message m;
    err e = {0};
    ok(!message_read("pause on", 8, &m, &e) && m.kind == MESSAGE_PAUSE && m.on, "pause on");
    ok(!message_read("record off", 10, &m, &e) && m.kind == MESSAGE_RECORD && !m.on, "record off");
    try_pose();
    refuses("", "an empty message");
    refuses("  # only a comment", "an empty message");
    refuses("pose\n1 2 3", "control character 0x0a");
    refuses("quit", "unknown message 'quit'");
    refuses("methd fem", "did you mean 'method'?");
    refuses("method", "method with 0 words; expected method NAME");
    refuses("set gain", "set with 1 words; expected set KEY VALUE");
    refuses("pause maybe", "pause 'maybe'; expected pause on, or pause off");
    refuses("save all", "save 'all'; expected save image, or save model");
    refuses("step 2", "step with 1 words");
    refuses("open", "open with 0 words; expected open CASE");
    refuses("set a\033[2J 1", "control character 0x1b");
    refuses("set a\xff 1", "is not UTF-8");
    try_long();
    return done_testing();
}
