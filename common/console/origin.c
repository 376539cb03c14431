#include "console/origin.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/random.h>

void origin_url(const address *a, const char *token, char *to, size_t size)
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

bool origin_has_host(const address *a, const char *host)
{
    char own[ADDRESS_MOST + 2];
    if (!host)
        return false;
    snprintf(own, sizeof own, a->v6 ? "[%s]" : "%s", a->host);
    return address_is_any(a) || is_named(a, host, own) || (address_is_local(a) && is_named(a, host, "localhost"));
}

bool origin_is_page(const char *origin, const char *host)
{
    return origin && host && !strncasecmp(origin, "http://", 7) && !strcasecmp(origin + 7, host);
}

int origin_token(char token[ORIGIN_TOKEN], err *e)
{
    unsigned char bytes[ORIGIN_TOKEN / 2];
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
        return err_system(e, "the token", errno, "cannot get random numbers");
    for (size_t i = 0; i < sizeof bytes; i++)
        snprintf(token + 2 * i, 3, "%02x", bytes[i]);
    return 0;
}

bool origin_has_token(const char *query, const char *token)
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
