#include "link/address.h"

#include "base/num.h"

#include <arpa/inet.h>
#include <stdio.h>
#include <string.h>

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
