/* Which requests are the console's own: a page of another site may send requests to this address too, and a name
 * that an attacker owns may lead to it, so the headers Host and Origin must be what our page has. Owns nothing.
 */
#ifndef SINEW_ORIGIN_H
#define SINEW_ORIGIN_H

#include "link/address.h"

enum { ORIGIN_URL = 160, ORIGIN_TOKEN = 33 };

/* The page's, with the token where there is one (NULL: none). */
void origin_url(const address *a, const char *token, char *to, size_t size);

/* Whether the header Host (NULL: there was none) names this address: itself or, where it is local, localhost. Every
 * address stands for any name: there the token keeps others out. */
bool origin_has_host(const address *a, const char *host);

/* Whether the header Origin is the page's that Host names. */
bool origin_is_page(const char *origin, const char *host);

/* A token that nobody guesses: 32 hexadecimal digits. -1 with e filled. */
int origin_token(char token[ORIGIN_TOKEN], err *e);

/* Whether the query ("token=...&...", or NULL) has the token, in a time that does not tell how much of it was right. */
bool origin_has_token(const char *query, const char *token);

#endif
