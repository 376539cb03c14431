/* Where a tool listens, as [ADDRESS:]PORT. Owns nothing.
 */
#ifndef SINEW_ADDRESS_H
#define SINEW_ADDRESS_H

#include "base/err.h"

#include <stddef.h>

enum { ADDRESS_MOST = 64 };

typedef struct address {
    char host[ADDRESS_MOST]; /* of digits, as 127.0.0.1 or ::1: no name */
    int port;                /* 0: any that is free */
    bool v6;
} address;

/* Reads "[ADDRESS:]PORT"; NULL: 127.0.0.1 and any port. -1 with e filled (status 2). */
int address_of(address *a, const char *text, err *e);

/* Whether only programs of this machine reach it. */
bool address_is_local(const address *a);

/* Whether it stands for every address of this machine. */
bool address_is_any(const address *a);

/* "127.0.0.1:8080", "[::1]:8080". */
void address_text(const address *a, char *to, size_t size);

#endif
