/* Where the console listens, and which requests are its own: a page of another site may send requests to this address
 * too, and a name that an attacker owns may lead to it, so the headers Host and Origin must be what our page has. Owns
 * nothing.
 */
#ifndef SINEW_ADDRESS_H
#define SINEW_ADDRESS_H

#include "base/err.h"

#include <stddef.h>

enum { ADDRESS_MOST = 64, ADDRESS_URL = 160, ADDRESS_TOKEN = 33 };

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

/* The page's, with the token where there is one (NULL: none). */
void address_url(const address *a, const char *token, char *to, size_t size);

/* Whether the header Host (NULL: there was none) names this address: itself or, where it is local, localhost. Every
 * address stands for any name: there the token keeps others out. */
bool address_has_host(const address *a, const char *host);

/* Whether the header Origin is the page's that Host names. */
bool address_is_origin(const char *origin, const char *host);

/* A token that nobody guesses: 32 hexadecimal digits. -1 with e filled. */
int address_token(char token[ADDRESS_TOKEN], err *e);

/* Whether the query ("token=...&...", or NULL) has the token, in a time that does not tell how much of it was right. */
bool address_has_token(const char *query, const char *token);

#endif
