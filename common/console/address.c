#include "console/address.h"

#include "base/num.h"

#include <arpa/inet.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/random.h>

static int wrong(const char *text, err *e)
{
    return err_usage(e, "--listen '%.80s': expected [ADDRESS:]PORT, such as 8080 or 127.0.0.1:8080", text);
}

int address_of(address *a, const char *text, err *e)
{
    unsigned char bytes[16];
    int64_t port = 0;
    *a = (address){.host = "127.0.0.1"};
    if (!text)
        return 0;
    const char *colon = strrchr(text, ':'), *digits = colon ? colon + 1 : text;
    if (num_int(digits, 0, 65535, &port))
        return wrong(text, e);
    a->port = (int)port;
    if (!colon)
        return 0;
    const size_t n = (size_t)(colon - text);
    a->v6 = n > 2 && text[0] == '[' && text[n - 1] == ']';
    const size_t from = a->v6 ? 1 : 0, length = n - 2 * from;
    if (!length || length >= sizeof a->host)
        return wrong(text, e);
    memcpy(a->host, text + from, length);
    a->host[length] = '\0';
    if (!strcmp(a->host, "localhost") && !a->v6)
        strcpy(a->host, "127.0.0.1");
    return inet_pton(a->v6 ? AF_INET6 : AF_INET, a->host, bytes) == 1 ? 0 : wrong(text, e);
}

bool address_is_local(const address *a)
{
    return a->v6 ? !strcmp(a->host, "::1") : !strncmp(a->host, "127.", 4);
}

bool address_is_any(const address *a)
{
    static const unsigned char none[16];
    unsigned char bytes[16] = {1};
    return inet_pton(a->v6 ? AF_INET6 : AF_INET, a->host, bytes) == 1 && !memcmp(bytes, none, a->v6 ? 16 : 4);
}

void address_text(const address *a, char *to, size_t size)
{
    snprintf(to, size, a->v6 ? "[%s]:%d" : "%s:%d", a->host, a->port);
}

void address_url(const address *a, const char *token, char *to, size_t size)
{
    char text[ADDRESS_MOST + 16];
    address_text(a, text, sizeof text);
    snprintf(to, size, "http://%s/%s%s", text, token ? "?token=" : "", token ? token : "");
}

/* Whether a Host is this name with the port, which 80 may leave out. */
static bool is_named(const address *a, const char *host, const char *name)
{
    char text[ADDRESS_MOST + 16];
    snprintf(text, sizeof text, "%s:%d", name, a->port);
    return !strcasecmp(host, text) || (a->port == 80 && !strcasecmp(host, name));
}

bool address_has_host(const address *a, const char *host)
{
    char own[ADDRESS_MOST + 2];
    if (!host)
        return false;
    snprintf(own, sizeof own, a->v6 ? "[%s]" : "%s", a->host);
    return address_is_any(a) || is_named(a, host, own) || (address_is_local(a) && is_named(a, host, "localhost"));
}

bool address_is_origin(const char *origin, const char *host)
{
    return origin && host && !strncasecmp(origin, "http://", 7) && !strcasecmp(origin + 7, host);
}

int address_token(char token[ADDRESS_TOKEN], err *e)
{
    unsigned char bytes[ADDRESS_TOKEN / 2];
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
        return err_system(e, "the token", errno, "cannot get random numbers");
    for (size_t i = 0; i < sizeof bytes; i++)
        snprintf(token + 2 * i, 3, "%02x", bytes[i]);
    return 0;
}

bool address_has_token(const char *query, const char *token)
{
    const size_t n = strlen(token);
    for (const char *p = query; p && *p; p += strcspn(p, "&"), p += *p == '&') {
        if (strncmp(p, "token=", 6) != 0 || strcspn(p, "&") != 6 + n)
            continue;
        unsigned different = 0;
        for (size_t i = 0; i < n; i++)
            different |= (unsigned char)(p[6 + i] ^ token[i]);
        return !different;
    }
    return false;
}
