#define _GNU_SOURCE /* accept4 */
#include "link/socket.h"

#include "base/clock.h"
#include "base/num.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

/* An address as the system has it; returns its size. */
static socklen_t to_system(const address *a, struct sockaddr_storage *to)
{
    struct sockaddr_in *four = (struct sockaddr_in *)to;
    struct sockaddr_in6 *six = (struct sockaddr_in6 *)to;
    memset(to, 0, sizeof *to);
    if (a->v6) {
        six->sin6_family = AF_INET6;
        six->sin6_port = htons((uint16_t)a->port);
        inet_pton(AF_INET6, a->host, &six->sin6_addr);
        return sizeof *six;
    }
    four->sin_family = AF_INET;
    four->sin_port = htons((uint16_t)a->port);
    inet_pton(AF_INET, a->host, &four->sin_addr);
    return sizeof *four;
}

/* The port that the system has given. */
static void take_port(int fd, address *at)
{
    struct sockaddr_storage given = {0};
    socklen_t size = sizeof given;
    if (getsockname(fd, (struct sockaddr *)&given, &size))
        return;
    at->port = ntohs(at->v6 ? ((struct sockaddr_in6 *)&given)->sin6_port : ((struct sockaddr_in *)&given)->sin_port);
}

int socket_listen(address *at, err *e)
{
    struct sockaddr_storage where;
    char text[ADDRESS_MOST + 16];
    const int on = 1;
    const socklen_t size = to_system(at, &where);
    const int fd = socket(at->v6 ? AF_INET6 : AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    address_text(at, text, sizeof text);
    if (fd < 0)
        return err_system(e, text, errno, "cannot listen");
    if (setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) || bind(fd, (struct sockaddr *)&where, size) ||
        listen(fd, SOMAXCONN)) {
        err_system(e, text, errno, "cannot listen");
        close(fd);
        return -1;
    }
    take_port(fd, at);
    return fd;
}

int socket_accept(int listening, char *from, size_t size)
{
    struct sockaddr_storage peer = {0};
    socklen_t length = sizeof peer;
    address a = {.host = "?"};
    const int fd = accept4(listening, (struct sockaddr *)&peer, &length, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd < 0)
        return -1;
    a.v6 = peer.ss_family == AF_INET6;
    if (a.v6) {
        const struct sockaddr_in6 *six = (struct sockaddr_in6 *)&peer;
        inet_ntop(AF_INET6, &six->sin6_addr, a.host, sizeof a.host);
        a.port = ntohs(six->sin6_port);
    } else {
        const struct sockaddr_in *four = (struct sockaddr_in *)&peer;
        inet_ntop(AF_INET, &four->sin_addr, a.host, sizeof a.host);
        a.port = ntohs(four->sin_port);
    }
    address_text(&a, from, size);
    socket_prompt(fd);
    return fd;
}

void socket_prompt(int fd)
{
    const int on = 1;
    /* Where the system knows neither, messages come later: no more than that. */
    (void)setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    (void)setsockopt(fd, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
}

int socket_name(const char *text, const char *option, int port, char host[SOCKET_HOST], char digits[8], err *e)
{
    const char *end = text[0] == '[' ? strchr(text, ']') : NULL;
    const char *colon = end ? end + 1 : strrchr(text, ':');
    const char *begin = end ? text + 1 : text;
    const size_t n = end ? (size_t)(end - begin) : (colon ? (size_t)(colon - begin) : strlen(begin));
    int64_t given = port;
    const bool has_port = colon && *colon == ':';
    if (!n || n >= SOCKET_HOST || (end && *colon && *colon != ':') ||
        (has_port && num_int(colon + 1, 1, 65535, &given)))
        return err_usage(e, "%s '%.80s': expected HOST:PORT, such as localhost:%d or 192.168.0.7:%d", option, text,
                         port, port);
    memcpy(host, begin, n);
    host[n] = '\0';
    snprintf(digits, 8, "%d", (int)given);
    return 0;
}

/* Waits until a connection is made or refused. 0, or an errno value. */
static int wait_connected(int fd, double until)
{
    struct pollfd p = {.fd = fd, .events = POLLOUT};
    const double left = until - clock_now();
    int code = 0;
    socklen_t size = sizeof code;
    const int n = poll(&p, 1, left > 0 ? (int)(left * 1000) + 1 : 0);
    if (n <= 0)
        return n ? errno : ETIMEDOUT;
    return getsockopt(fd, SOL_SOCKET, SO_ERROR, &code, &size) ? errno : code;
}

/* A descriptor, or -1 and *code. */
static int connect_to(const struct addrinfo *to, double until, int *code)
{
    const int fd = socket(to->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    *code = fd < 0 ? errno : 0;
    if (fd < 0)
        return -1;
    if (connect(fd, to->ai_addr, to->ai_addrlen))
        *code = errno == EINPROGRESS ? wait_connected(fd, until) : errno;
    if (!*code) {
        socket_prompt(fd);
        return fd;
    }
    close(fd);
    return -1;
}

/* The addresses of a host, which the caller frees; NULL with e filled. */
static struct addrinfo *find_addresses(const char *host, const char *digits, const char *place, err *e)
{
    const struct addrinfo hints = {.ai_socktype = SOCK_STREAM, .ai_flags = AI_ADDRCONFIG | AI_NUMERICSERV};
    struct addrinfo *list = NULL;
    const int failed = getaddrinfo(host, digits, &hints, &list);
    if (!failed)
        return list;
    err_set(e, place, 0, "no address is known: %s", gai_strerror(failed));
    return NULL;
}

static void put_place(char place[SOCKET_HOST + 16], const char *host, const char *digits)
{
    snprintf(place, SOCKET_HOST + 16, strchr(host, ':') ? "[%s]:%s" : "%s:%s", host, digits);
}

int socket_known(const char *host, const char *digits, err *e)
{
    char place[SOCKET_HOST + 16];
    put_place(place, host, digits);
    struct addrinfo *list = find_addresses(host, digits, place, e);
    if (!list)
        return -1;
    freeaddrinfo(list);
    return 0;
}

int socket_connect(const char *host, const char *digits, double seconds, err *e)
{
    char place[SOCKET_HOST + 16];
    const double until = clock_now() + seconds;
    int fd = -1, code = 0;
    put_place(place, host, digits);
    struct addrinfo *list = find_addresses(host, digits, place, e);
    if (!list)
        return -1;
    for (const struct addrinfo *to = list; to && fd < 0; to = to->ai_next)
        fd = connect_to(to, until, &code);
    freeaddrinfo(list);
    return fd < 0 ? err_system(e, place, code, "cannot connect") : fd;
}
