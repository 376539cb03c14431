#include "live/broadcast.h"

#include "base/mem.h"
#include "base/temporary.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

enum { WAITING = 4096 /* bytes that wait for a client, as the system counts them: it doubles them */ };

typedef struct client {
    int fd;
    size_t left; /* bytes of a line that was sent in part */
    char rest[BROADCAST_LINE];
} client;

struct broadcast {
    int fd; /* that listens; -1: none */
    char *path;
    struct stat made; /* what is at the path, if it is still ours */
    client *client[BROADCAST_CLIENTS];
    int clients;
    broadcast_counts counts;
};

/* ---- the socket */

static int address_of(const char *path, struct sockaddr_un *to, err *e)
{
    *to = (struct sockaddr_un){.sun_family = AF_UNIX};
    if (!*path || strlen(path) >= sizeof to->sun_path)
        return err_set(e, path, 0, "%zu bytes of path; a socket's has 1 to %zu", strlen(path), sizeof to->sun_path - 1);
    memcpy(to->sun_path, path, strlen(path) + 1);
    return 0;
}

static int socket_of(err *e, const char *path)
{
    const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    return fd < 0 ? err_system(e, path, errno, "cannot make a socket") : fd;
}

/* Whether somebody listens there: 1, 0, or -1 with e filled. */
static int is_alive(const struct sockaddr_un *at, err *e)
{
    const int fd = socket_of(e, at->sun_path);
    if (fd < 0)
        return -1;
    const bool connected = !connect(fd, (const struct sockaddr *)at, sizeof *at);
    const int why = errno;
    close(fd);
    if (connected || why == EAGAIN) /* its queue is full */
        return 1;
    return why == ECONNREFUSED || why == ENOENT ? 0 : err_system(e, at->sun_path, why, "cannot connect to the socket");
}

/* What a run that was killed has left is removed; anything else stays. */
static int make_room(const struct sockaddr_un *at, err *e)
{
    struct stat there;
    if (lstat(at->sun_path, &there))
        return errno == ENOENT ? 0 : err_system(e, at->sun_path, errno, "cannot look at it");
    if (!S_ISSOCK(there.st_mode))
        return err_set(e, at->sun_path, 0, "a file that is no socket; expected a name that is free");
    const int alive = is_alive(at, e);
    if (alive)
        return alive < 0 ? -1
                         : err_set(e, at->sun_path, 0,
                                   "another program listens on this socket; expected a name that is free");
    return unlink(at->sun_path) && errno != ENOENT ? err_system(e, at->sun_path, errno, "cannot remove an old socket")
                                                   : 0;
}

typedef struct binding {
    int fd;
    const struct sockaddr_un *at;
} binding;

/* Nobody else may connect, from the beginning on: Linux makes the file with the socket's own mode. */
static int bind_to(const void *context, const char *path)
{
    const binding *b = context;
    (void)path;
    return fchmod(b->fd, S_IRUSR | S_IWUSR) ? -1 : bind(b->fd, (const struct sockaddr *)b->at, sizeof *b->at);
}

static int listen_at(broadcast *b, err *e)
{
    struct sockaddr_un at;
    if (address_of(b->path, &at, e) || make_room(&at, e))
        return -1;
    b->fd = socket_of(e, b->path);
    if (b->fd < 0)
        return -1;
    const binding way = {b->fd, &at};
    if (temporary_make(b->path, bind_to, &way, e))
        return err_system(e, b->path, errno, "cannot make the socket");
    if (lstat(b->path, &b->made) || listen(b->fd, BROADCAST_CLIENTS))
        return err_system(e, b->path, errno, "cannot listen on the socket");
    return 0;
}

broadcast *broadcast_open(const char *path, err *e)
{
    broadcast *b = mem_array(1, sizeof *b, "the socket", e);
    if (!b)
        return NULL;
    b->fd = -1;
    b->path = mem_text(path, e);
    if (b->path && !listen_at(b, e))
        return b;
    broadcast_close(b);
    return NULL;
}

/* ---- clients */

static void let_go(broadcast *b, int i)
{
    close(b->client[i]->fd);
    free(b->client[i]);
    b->client[i] = b->client[--b->clients];
}

void broadcast_close(broadcast *b)
{
    struct stat now;
    if (!b)
        return;
    while (b->clients)
        let_go(b, 0);
    if (b->path && b->made.st_ino && !lstat(b->path, &now) && now.st_ino == b->made.st_ino &&
        now.st_dev == b->made.st_dev)
        unlink(b->path);
    if (b->path)
        temporary_drop(b->path);
    if (b->fd >= 0)
        close(b->fd);
    free(b->path);
    free(b);
}

/* One that cannot be kept is hung up on. */
static void take(broadcast *b, int fd)
{
    const int waiting = WAITING;
    err none = {0};
    client *c = b->clients < BROADCAST_CLIENTS ? mem_array(1, sizeof *c, "the socket", &none) : NULL;
    if (!c || setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &waiting, sizeof waiting)) {
        b->counts.refused++;
        free(c);
        close(fd);
        return;
    }
    c->fd = fd;
    b->client[b->clients++] = c;
    b->counts.clients++;
}

static bool has_gone(const client *c)
{
    char heard[4096];
    const ssize_t got = recv(c->fd, heard, sizeof heard, MSG_DONTWAIT);
    return got == 0 || (got < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

int broadcast_clients(broadcast *b)
{
    int fd;
    while ((fd = accept(b->fd, NULL, NULL)) >= 0)
        take(b, fd);
    for (int i = b->clients - 1; i >= 0; i--)
        if (has_gone(b->client[i]))
            let_go(b, i);
    return b->clients;
}

/* Sends what it can of some bytes. Returns how many, or -1: the client has gone. */
static ssize_t push(const client *c, const char *from, size_t length)
{
    const ssize_t sent = send(c->fd, from, length, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent >= 0)
        return sent;
    return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR ? 0 : -1;
}

/* The rest of a line that was sent in part comes first; a line that none of could be sent is lost. -1: it has gone. */
static int tell(broadcast *b, client *c, const char *line, size_t length)
{
    ssize_t sent = c->left ? push(c, c->rest, c->left) : 0;
    if (sent < 0)
        return -1;
    memmove(c->rest, c->rest + sent, c->left - (size_t)sent);
    c->left -= (size_t)sent;
    sent = c->left ? 0 : push(c, line, length);
    if (sent < 0)
        return -1;
    if (!sent) {
        b->counts.lost++;
        return 0;
    }
    c->left = length - (size_t)sent;
    memcpy(c->rest, line + sent, c->left);
    return 0;
}

void broadcast_send(broadcast *b, const char *line, size_t length)
{
    b->counts.lines++;
    for (int i = b->clients - 1; i >= 0; i--)
        if (tell(b, b->client[i], line, length))
            let_go(b, i);
}

broadcast_counts broadcast_count(const broadcast *b)
{
    return b->counts;
}
