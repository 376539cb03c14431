/* TCP between programs: where a tool listens or connects, as [ADDRESS:]PORT or HOST:PORT. Descriptors are the
 * caller's, do not block, and are closed in programs that are started.
 */
#ifndef SINEW_SOCKET_H
#define SINEW_SOCKET_H

#include "link/address.h"

/* Listens at an address; *at becomes what it is, where the port was 0. -1 with e filled, as where the port is taken. */
int socket_listen(address *at, err *e);

/* The next who connects, and its address as text (ADDRESS_MOST + 16 bytes). -1: nobody has, or it went away. */
int socket_accept(int listening, char *from, size_t size);

enum { SOCKET_HOST = 256 };

/* Divides HOST:PORT, [HOST]:PORT or HOST, whose port is then `port`, as text. -1 with e filled (status 2). */
int socket_name(const char *text, const char *option, int port, char host[SOCKET_HOST], char digits[8], err *e);

/* Whether a host, by name or digits, has an address. -1 with e filled. */
int socket_known(const char *host, const char *digits, err *e);

/* Connects to a host by name or digits, each of its addresses in turn, within so many seconds in all. -1 with e
 * filled. */
int socket_connect(const char *host, const char *digits, double seconds, err *e);

/* Sends what it says to who listens at once, and asks a peer that is silent for minutes whether it is there. */
void socket_prompt(int fd);

#endif
