// Where the console listens and whom it answers; and what waits for a client: texts in order, of the rest the newest.
// needs: common/console/origin.c common/console/mailbox.c
#include "console/mailbox.h"
#include "console/origin.h"
#include "tap.h"

#include <string.h>

static void try_address(const char *text, const char *want, bool local)
{
    address a;
    err e = {0};
    char got[ORIGIN_URL] = "";
    if (!address_of(&a, text, &e))
        address_text(&a, got, sizeof got);
    ok(!strcmp(got, want), "'%s' is %s (%s%s)", text ? text : "nothing", want, got, e.text);
    if (*want)
        ok(address_is_local(&a) == local, "and is%s of this machine alone", local ? "" : " not");
    else
        ok(e.status == STATUS_USAGE && strstr(e.text, "expected [ADDRESS:]PORT"), "refused: %s", e.text);
}

static void try_hosts(void)
{
    address a, any;
    err e = {0};
    address_of(&a, "8080", &e);
    address_of(&any, "0.0.0.0:8080", &e);
    ok(origin_has_host(&a, "127.0.0.1:8080") && origin_has_host(&a, "LOCALHOST:8080"), "the host is its address");
    ok(!origin_has_host(&a, "evil.example:8080"), "a name that leads here is not");
    ok(!origin_has_host(&a, "127.0.0.1") && !origin_has_host(&a, "127.0.0.1:80") && !origin_has_host(&a, NULL) &&
           !origin_has_host(&a, ""),
       "nor another port, or none");
    ok(!origin_has_host(&a, "127.0.0.1:8080.evil.example"), "nor what only begins so");
    ok(address_is_any(&any) && origin_has_host(&any, "lab.example:8080"), "every address has any name");
    ok(origin_is_page("http://127.0.0.1:8080", "127.0.0.1:8080"), "the page's own origin");
    ok(!origin_is_page("http://evil.example", "127.0.0.1:8080") && !origin_is_page(NULL, "127.0.0.1:8080") &&
           !origin_is_page("null", "127.0.0.1:8080") && !origin_is_page("https://127.0.0.1:8080", "127.0.0.1:8080"),
       "others");
}

static void try_token(void)
{
    char a[ORIGIN_TOKEN], b[ORIGIN_TOKEN], url[ORIGIN_URL], query[80];
    err e = {0};
    address at;
    address_of(&at, "[::]:80", &e);
    ok(!origin_token(a, &e) && !origin_token(b, &e) && strlen(a) == 32 && strcmp(a, b) != 0, "two tokens differ");
    origin_url(&at, "abc", url, sizeof url);
    ok(!strcmp(url, "http://[::]:80/?token=abc"), "the address has it: %s", url);
    snprintf(query, sizeof query, "x=1&token=%s&y", a);
    ok(origin_has_token(query, a) && !origin_has_token(query, b), "it is found in a query, and no other");
    snprintf(query, sizeof query, "token=%.31s", a);
    ok(!origin_has_token(query, a) && !origin_has_token(NULL, a) && !origin_has_token("", a) &&
           !origin_has_token("token=", a),
       "a part of it is not enough");
}

static void put(mailbox *b, mail_slot slot, const char *text)
{
    err e = {0};
    mail *m = mail_of_text(text, &e);
    mailbox_put(b, slot, m);
    mail_done(m);
}

static bool took(mailbox *b, const char *want)
{
    mail *m = mailbox_take(b);
    const bool same = m && m->size == strlen(want) && !memcmp(m->bytes, want, m->size);
    if (!same)
        printf("# got '%.*s', wanted '%s'\n", m ? (int)m->size : 0, m ? (const char *)m->bytes : "", want);
    mail_done(m);
    return same;
}

static void try_pace(void)
{
    mailbox b;
    err e = {0};
    mailbox_open(&b, &e);
    put(&b, MAIL_IMAGE, "1");
    ok(!mailbox_is_free(&b, MAIL_IMAGE) && took(&b, "1") && mailbox_is_free(&b, MAIL_IMAGE),
       "who says nothing gets all");
    mailbox_got(&b, MAIL_IMAGE);
    put(&b, MAIL_IMAGE, "2");
    ok(took(&b, "2") && !mailbox_is_free(&b, MAIL_IMAGE), "who says what it is done with is busy with one");
    put(&b, MAIL_IMAGE, "3");
    put(&b, MAIL_POSITIONS, "p");
    put(&b, MAIL_IMAGE, "4");
    ok(took(&b, "p"), "meanwhile gets others");
    mailbox_got(&b, MAIL_IMAGE);
    ok(took(&b, "4"), "and then the newest");
    mailbox_close(&b);
}

static void try_box(void)
{
    mailbox b;
    err e = {0};
    char text[16];
    ok(!mailbox_open(&b, &e), "a mailbox");
    put(&b, MAIL_POSITIONS, "p1");
    put(&b, MAIL_IMAGE, "i1");
    put(&b, MAIL_IMAGE, "i2");
    put(&b, MAIL_STATE, "s");
    put(&b, MAIL_SAID, "one");
    put(&b, MAIL_SAID, "two");
    ok(took(&b, "one") && took(&b, "two") && took(&b, "s"), "texts in order, then the state");
    ok(took(&b, "i2"), "of images the newest");
    put(&b, MAIL_IMAGE, "i3");
    ok(took(&b, "p1") && took(&b, "i3"), "kinds by turns: an image that came later does not go first");
    put(&b, MAIL_POSITIONS, "old");
    put(&b, MAIL_GEOMETRY, "g");
    mailbox_drop(&b, MAIL_POSITIONS);
    put(&b, MAIL_FRAME, "f");
    ok(took(&b, "g") && took(&b, "f"), "what is dropped is not sent");
    for (int i = 0; i < MAILBOX_TEXTS + 3; i++) {
        snprintf(text, sizeof text, "%d", i);
        put(&b, MAIL_SAID, text);
    }
    ok(took(&b, "3"), "of too many texts the oldest are dropped");
    mailbox_end(&b);
    put(&b, MAIL_SAID, "late");
    ok(!mailbox_take(&b), "a box that was ended gives nothing");
    mailbox_close(&b);
}

int main(void)
{
    try_address(NULL, "127.0.0.1:0", true);
    try_address("8080", "127.0.0.1:8080", true);
    try_address("127.0.0.2:1", "127.0.0.2:1", true);
    try_address("localhost:80", "127.0.0.1:80", true);
    try_address("192.168.1.7:8080", "192.168.1.7:8080", false);
    try_address("0.0.0.0:0", "0.0.0.0:0", false);
    try_address("[::1]:8080", "[::1]:8080", true);
    try_address("[::]:8080", "[::]:8080", false);
    static const char *const wrong[] = {
        "",     ":",      ":80",       "80:",     "65536",        "-1", "x", "host.example:80",
        "[]:1", "::1:80", "127.0.0.1", "1.2.3:4", "127.0.0.1:80 "};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        try_address(wrong[i], "", false);
    try_hosts();
    try_token();
    try_box();
    try_pace();
    return done_testing();
}
