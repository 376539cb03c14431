#include "console/web.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/thread.h"

#include <arpa/inet.h>
#include <civetweb.h>
#include <ctype.h>
#include <errno.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

/* A place for a client. It is taken from the upgrade on until its connection has ended. */
typedef struct client {
    bool taken, ready;
    bool raw;         /* it said "pixels raw" */
    atomic_bool lost; /* sending failed: what it says next ends it */
    struct mg_connection *connection;
    pthread_t sender;
    mailbox box;
} client;

struct web {
    web_plan plan;
    struct mg_context *server;
    atomic_int port;      /* that it listens on: known once it does */
    pthread_mutex_t lock; /* of the places, but for the boxes' insides, and of what follows */
    client clients[WEB_CLIENTS];
    mail *last[MAIL_SLOTS]; /* that was sent to all */
    pthread_cond_t got;     /* a client came, went or got something: for web_wait */
};

static const char headers[] = "X-Content-Type-Options: nosniff\r\n"
                              "Referrer-Policy: no-referrer\r\n"
                              "X-Frame-Options: DENY\r\n"
                              "Content-Security-Policy: default-src 'self'; img-src 'self' blob: data:; "
                              "style-src 'self' 'unsafe-inline'; object-src 'none'; base-uri 'none'\r\n";

/* ---- who may ask */

static int refuse(struct mg_connection *c, int status, const char *text)
{
    mg_printf(c,
              "HTTP/1.1 %d %s\r\nContent-Type: text/plain; charset=utf-8\r\nContent-Length: %zu\r\n"
              "Connection: close\r\n%s\r\n%s\n",
              status, mg_get_response_code_text(c, status), strlen(text) + 1, headers, text);
    return status;
}

static bool begins(const char *text, const char *with)
{
    return !strncmp(text, with, strlen(with));
}

/* Names of letters, digits, '.', '-' and '_' between slashes, none of which begins with a dot; so no way leads out of a
 * folder. (civetweb has decoded what was encoded; names of cases are looked up, not walked.) */
static bool is_plain(const char *uri)
{
    for (const char *p = uri; *p; p++)
        if (!isalnum((unsigned char)*p) && !strchr("/.-_", *p))
            return false;
    return !strstr(uri, "/.") && !strstr(uri, "//");
}

static bool needs_token(const char *uri)
{
    return !strcmp(uri, "/") || begins(uri, "/live") || begins(uri, "/case/") || begins(uri, "/save/");
}

/* 0: it may go on; else the status it was answered with. */
static int check_request(struct mg_connection *c)
{
    const struct mg_request_info *r = mg_get_request_info(c);
    const web *w = mg_get_user_data(mg_get_context(c));
    const web_plan *plan = &w->plan;
    address at = plan->at;
    at.port = atomic_load(&w->port);
    const char *host = mg_get_header(c, "Host"), *origin = mg_get_header(c, "Origin"), *uri = r->local_uri;
    if (!origin_has_host(&at, host))
        return refuse(c, 403,
                      "the header Host is not the console's address; open the address that the console printed");
    if (strcmp(r->request_method, "GET") != 0)
        return refuse(c, 405, "only GET is answered");
    const bool live = uri && !strcmp(uri, "/live");
    if (!uri || live != (mg_get_header(c, "Upgrade") != NULL))
        return refuse(c, 404, "there is no such file");
    if ((live || origin) && !origin_is_page(origin, host))
        return refuse(c, 403, "the header Origin is not the console's address: only its own page may ask");
    if (plan->token && needs_token(uri) && !origin_has_token(r->query_string, plan->token))
        return refuse(c, 403, "the token is missing or wrong; open the address that the console printed");
    return 0;
}

/* ---- files */

static int send_file(struct mg_connection *c, const char *path)
{
    if (access(path, R_OK))
        return refuse(c, 404, "there is no such file");
    mg_send_mime_file2(c, path, NULL, headers);
    return 200;
}

static int on_request(struct mg_connection *c, void *context)
{
    const web *w = context;
    const char *uri = mg_get_request_info(c)->local_uri;
    char path[WEB_PATH];
    if (begins(uri, "/case/") || begins(uri, "/save/"))
        return w->plan.file(w->plan.context, uri + 1, path) ? refuse(c, 404, "there is no such file")
                                                            : send_file(c, path);
    if (!is_plain(uri))
        return refuse(c, 404, "there is no such file");
    const bool three = begins(uri, "/three/");
    const char *name = three ? uri + strlen("/three") : uri;
    const int n = snprintf(path, sizeof path, "%s%s%s", three ? w->plan.three : w->plan.page, name,
                           strcmp(uri, "/") ? "" : "index.html");
    return n < (int)sizeof path ? send_file(c, path) : refuse(c, 404, "there is no such file");
}

/* ---- clients */

/* Sends a mail, and gives up its use of it (mail_done). True: it was sent whole. */
static bool send_one(client *c, mail *m)
{
    const int opcode = m->text ? MG_WEBSOCKET_OPCODE_TEXT : MG_WEBSOCKET_OPCODE_BINARY;
    const int sent = mg_websocket_write(c->connection, opcode, (const char *)m->bytes, m->size);
    const bool whole = sent >= 0 && (size_t)sent == m->size;
    mail_done(m);
    return whole;
}

/* At the end the client is told that the server goes away (RFC 6455: 1001), so that it closes. */
static void *send_all(void *context)
{
    static const char goes_away[2] = {3, (char)233};
    client *c = context;
    mail *m = NULL;
    bool sound = true;
    while (sound && (m = mailbox_take(&c->box)))
        sound = send_one(c, m);
    atomic_store(&c->lost, true);
    if (sound)
        mg_websocket_write(c->connection, MG_WEBSOCKET_OPCODE_CONNECTION_CLOSE, goes_away, sizeof goes_away);
    return NULL;
}

static int take_place(web *w)
{
    int at = -1;
    pthread_mutex_lock(&w->lock);
    for (int i = 0; i < WEB_CLIENTS && at < 0; i++)
        if (!w->clients[i].taken)
            at = i;
    if (at >= 0)
        w->clients[at] = (client){.taken = true};
    pthread_mutex_unlock(&w->lock);
    return at;
}

static void leave_place(web *w, int at)
{
    pthread_mutex_lock(&w->lock);
    w->clients[at].taken = w->clients[at].ready = false;
    pthread_mutex_unlock(&w->lock);
}

/* The place is the connection's. Where there is none, or no memory, the connection ends. */
static int on_connect(const struct mg_connection *c, void *context)
{
    web *w = context;
    err e = {0};
    const int at = take_place(w);
    if (at < 0)
        return 1;
    if (mailbox_open(&w->clients[at].box, &e)) {
        leave_place(w, at);
        return 1;
    }
    mg_set_user_connection_data(c, &w->clients[at]);
    return 0;
}

static void on_ready(struct mg_connection *c, void *context)
{
    web *w = context;
    client *one = mg_get_user_connection_data(c);
    one->connection = c;
    if (thread_start(&one->sender, send_all, one)) {
        atomic_store(&one->lost, true);
        return;
    }
    pthread_mutex_lock(&w->lock);
    one->ready = true;
    for (int i = 0; i < MAIL_SLOTS; i++)
        if (w->last[i])
            mailbox_put(&one->box, (mail_slot)i, w->last[i]);
    pthread_mutex_unlock(&w->lock);
}

/* What a client says of how it is sent to. True where it was that. */
static bool take_pace(web *w, client *one, const char *text, size_t size)
{
    static const struct {
        const char *text;
        mail_slot slot; /* it is done with the last of this; MAIL_SAID: it takes raw pixels */
    } known[] = {{"got image", MAIL_IMAGE}, {"got positions", MAIL_POSITIONS}, {"pixels raw", MAIL_SAID}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (size != strlen(known[i].text) || memcmp(text, known[i].text, size) != 0)
            continue;
        if (known[i].slot != MAIL_SAID)
            mailbox_got(&one->box, known[i].slot);
        pthread_mutex_lock(&w->lock);
        one->raw |= known[i].slot == MAIL_SAID;
        pthread_cond_broadcast(&w->got);
        pthread_mutex_unlock(&w->lock);
        return true;
    }
    return false;
}

/* Messages are whole texts: one in parts, or of bytes, ends the connection, as a client does that closes it. */
static int on_data(struct mg_connection *c, int bits, char *data, size_t size, void *context)
{
    enum { WHOLE = 0x80 };
    web *w = context;
    client *one = mg_get_user_connection_data(c);
    const int opcode = bits & 0xf;
    if (opcode == MG_WEBSOCKET_OPCODE_PING || opcode == MG_WEBSOCKET_OPCODE_PONG)
        return !atomic_load(&one->lost);
    if (atomic_load(&one->lost) || opcode != MG_WEBSOCKET_OPCODE_TEXT || !(bits & WHOLE))
        return 0;
    if (!take_pace(w, one, data, size))
        w->plan.said(w->plan.context, (int)(one - w->clients), data, size);
    return 1;
}

static void on_close(const struct mg_connection *c, void *context)
{
    web *w = context;
    client *one = mg_get_user_connection_data(c);
    if (!one)
        return;
    pthread_mutex_lock(&w->lock);
    const bool ready = one->ready;
    one->ready = false;
    pthread_cond_broadcast(&w->got);
    pthread_mutex_unlock(&w->lock);
    mailbox_end(&one->box);
    if (ready)
        pthread_join(one->sender, NULL);
    mailbox_close(&one->box);
    leave_place(w, (int)(one - w->clients));
}

void web_send(web *w, int to, mail_slot slot, mail *m)
{
    if (!m)
        return;
    pthread_mutex_lock(&w->lock);
    for (int i = 0; i < WEB_CLIENTS; i++)
        if (w->clients[i].ready && (to < 0 || to == i))
            mailbox_put(&w->clients[i].box, slot, m);
    if (to < 0 && slot != MAIL_SAID) {
        mail *before = w->last[slot];
        w->last[slot] = m;
        m = before;
    }
    pthread_mutex_unlock(&w->lock);
    mail_done(m);
}

/* Under the lock. */
static bool is_awaited(web *w, mail_slot slot)
{
    int clients = 0;
    for (int i = 0; i < WEB_CLIENTS; i++) {
        clients += w->clients[i].ready;
        if (w->clients[i].ready && mailbox_is_free(&w->clients[i].box, slot))
            return true;
    }
    return !clients;
}

void web_wait(web *w, mail_slot slot, double seconds)
{
    const struct timespec until = clock_timespec(clock_now() + seconds);
    int code = 0;
    pthread_mutex_lock(&w->lock);
    while (!is_awaited(w, slot) && !code)
        code = pthread_cond_timedwait(&w->got, &w->lock, &until);
    pthread_mutex_unlock(&w->lock);
}

void web_drop(web *w, mail_slot slot)
{
    pthread_mutex_lock(&w->lock);
    for (int i = 0; i < WEB_CLIENTS; i++)
        if (w->clients[i].ready)
            mailbox_drop(&w->clients[i].box, slot);
    mail_done(w->last[slot]);
    w->last[slot] = NULL;
    pthread_mutex_unlock(&w->lock);
}

int web_clients(web *w)
{
    int count = 0;
    pthread_mutex_lock(&w->lock);
    for (int i = 0; i < WEB_CLIENTS; i++)
        count += w->clients[i].ready;
    pthread_mutex_unlock(&w->lock);
    return count;
}

bool web_all_raw(web *w)
{
    int count = 0;
    bool all = true;
    pthread_mutex_lock(&w->lock);
    for (int i = 0; i < WEB_CLIENTS; i++) {
        count += w->clients[i].ready;
        all &= !w->clients[i].ready || w->clients[i].raw;
    }
    pthread_mutex_unlock(&w->lock);
    return count && all;
}

/* ---- beginning and ending */

/* An address as the system has it. */
typedef struct place {
    union {
        struct sockaddr any;
        struct sockaddr_in four;
        struct sockaddr_in6 six;
    } at;
    socklen_t size;
} place;

/* -1: it is none. */
static int place_of(const address *a, int port, place *to)
{
    *to = (place){.size = a->v6 ? sizeof to->at.six : sizeof to->at.four};
    to->at.any.sa_family = a->v6 ? AF_INET6 : AF_INET;
    if (a->v6) {
        to->at.six.sin6_port = htons((uint16_t)port);
        return inet_pton(AF_INET6, a->host, &to->at.six.sin6_addr) == 1 ? 0 : -1;
    }
    to->at.four.sin_port = htons((uint16_t)port);
    return inet_pton(AF_INET, a->host, &to->at.four.sin_addr) == 1 ? 0 : -1;
}

/* civetweb says that it cannot listen, but not why. */
static int try_to_listen(const address *a, err *e)
{
    place to;
    char text[ADDRESS_MOST + 16];
    address_text(a, text, sizeof text);
    int code = place_of(a, a->port, &to) ? EINVAL : 0;
    const int on = 1, s = code ? -1 : socket(to.at.any.sa_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (!code && (s < 0 || setsockopt(s, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) || bind(s, &to.at.any, to.size)))
        code = errno;
    if (s >= 0)
        close(s);
    if (!code)
        return 0;
    return err_set(e, text, 0, "cannot listen there: %s; expected another [ADDRESS:]PORT in --listen", strerror(code));
}

/* While it stops, civetweb's thread that listens sleeps for up to two seconds, unless somebody comes. */
static void *come(void *context)
{
    const web *w = context;
    place to;
    clock_sleep(.02);
    const int s = place_of(&w->plan.at, atomic_load(&w->port), &to) ? -1 : socket(to.at.any.sa_family, SOCK_STREAM, 0);
    if (s >= 0) {
        (void)!connect(s, &to.at.any, to.size); /* where it fails, the end takes longer */
        close(s);
    }
    return NULL;
}

static void stop(web *w)
{
    pthread_t visitor;
    const bool visited = !thread_start(&visitor, come, w);
    mg_stop(w->server);
    if (visited)
        pthread_join(visitor, NULL);
}

static int is_silent(const struct mg_connection *c, const char *text)
{
    (void)c;
    (void)text;
    return 1;
}

static int start(web *w, err *e)
{
    char ports[ADDRESS_MOST + 16];
    address_text(&w->plan.at, ports, sizeof ports);
    const char *options[] = {"listening_ports",
                             ports,
                             "num_threads",
                             "24",
                             "tcp_nodelay",
                             "1",
                             "enable_keep_alive",
                             "no",
                             "request_timeout_ms",
                             "20000",
                             "websocket_timeout_ms",
                             "5000",
                             "enable_websocket_ping_pong",
                             "yes",
                             "enable_directory_listing",
                             "no",
                             "static_file_max_age",
                             "0",
                             "max_request_size",
                             "8192",
                             NULL};
    const struct mg_callbacks callbacks = {.begin_request = check_request, .log_message = is_silent};
    mg_init_library(MG_FEATURES_WEBSOCKET);
    if (!mg_check_feature(MG_FEATURES_WEBSOCKET) || (w->plan.at.v6 && !mg_check_feature(MG_FEATURES_IPV6)))
        return err_set(e, ports, 0, "the civetweb of this machine was built without %s",
                       w->plan.at.v6 ? "IPv6; expected an address such as 127.0.0.1" : "WebSockets");
    w->server = mg_start(&callbacks, w, options);
    if (!w->server)
        return err_set(e, ports, 0, "the server did not start");
    mg_set_websocket_handler(w->server, "/live", on_connect, on_ready, on_data, on_close, w);
    mg_set_request_handler(w->server, "**", on_request, w);
    return 0;
}

web *web_open(const web_plan *plan, err *e)
{
    if (try_to_listen(&plan->at, e))
        return NULL;
    web *w = mem_array(1, sizeof *w, "the server", e);
    if (!w)
        return NULL;
    w->plan = *plan;
    pthread_mutex_init(&w->lock, NULL);
    const int code = thread_condition(&w->got);
    struct mg_server_port port = {0};
    if (code) {
        err_system(e, NULL, code, "cannot serve the page");
        pthread_mutex_destroy(&w->lock);
        free(w);
        return NULL;
    }
    if (!start(w, e)) {
        if (mg_get_server_ports(w->server, 1, &port) == 1)
            atomic_store(&w->port, port.port);
        return w;
    }
    web_close(w);
    return NULL;
}

/* Without this wait, mg_stop would wait for each of them, up to two seconds. */
static void say_goodbye(web *w)
{
    pthread_mutex_lock(&w->lock);
    for (int i = 0; i < WEB_CLIENTS; i++)
        if (w->clients[i].ready)
            mailbox_end(&w->clients[i].box);
    pthread_mutex_unlock(&w->lock);
    for (int i = 0; i < 60 && web_clients(w); i++)
        clock_sleep(.005);
}

void web_close(web *w)
{
    if (!w)
        return;
    say_goodbye(w);
    if (w->server)
        stop(w);
    mg_exit_library();
    for (int i = 0; i < MAIL_SLOTS; i++)
        mail_done(w->last[i]);
    pthread_cond_destroy(&w->got);
    pthread_mutex_destroy(&w->lock);
    free(w);
}

int web_port(const web *w)
{
    return atomic_load(&w->port);
}
