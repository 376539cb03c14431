/* Frames of reference and the transforms that link them, named as PLUS names them: FROMToTO, ProbeToTracker. Which
 * transform leads from one frame to another, over those that there are, either way. It owns nothing.
 */
#ifndef SINEW_LINKS_H
#define SINEW_LINKS_H

#include <stdbool.h>
#include <stddef.h>

enum { LINKS_MOST = 64, LINKS_NAME = 64, LINKS_LIST = 400 };

typedef struct links_transform {
    char from[LINKS_NAME], to[LINKS_NAME];
    double m[16];  /* 4 x 4, row by row, affine: takes a place in `from` to one in `to` */
    bool set, bad; /* its matrix was given; it is not to be trusted */
} links_transform;

/* Splits a name of `length` bytes at the first "To" before a capital that has something before it; from and to hold
 * LINKS_NAME bytes. -1: it is no such name, or too long. */
int links_split(const char *name, size_t length, char *from, char *to);

/* What takes `from` to `to`, by those of the transforms (at most LINKS_MOST) that are set; bad: by those that are bad,
 * too. False: they are not linked. */
bool links_compose(const links_transform *list, int count, const char *from, const char *to, bool bad, double m[16]);

/* Their names between commas, as many as fit: "ProbeToTracker, StylusToTracker"; "(none)". */
void links_list(const links_transform *list, int count, char text[LINKS_LIST]);

#endif
