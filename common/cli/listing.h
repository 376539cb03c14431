/* Names as a sentence lists them, "a, b, c and 31 more", so that one warning can say of many what is wrong. Nothing is
 * allocated; begin with a zeroed one.
 */
#ifndef SINEW_LISTING_H
#define SINEW_LISTING_H

#include "base/err.h"

typedef struct listing {
    char text[480]; /* what has room is named */
    int64_t count, named;
} listing;

void listing_add(listing *l, const char *format, ...) SINEW_PRINTF(2, 3);

/* The sentence's part; nothing can be added after it. */
const char *listing_text(listing *l);

#endif
