/* Hourglass control as users and models say it: an option of tled-run, and the metadata hourglass.control. It owns
 * nothing. */
#ifndef SINEW_HOURGLASS_TEXT_H
#define SINEW_HOURGLASS_TEXT_H

#include "physics/hourglass_numbers.h"

#define HOURGLASS_USUAL_KAPPA .0075
enum { HOURGLASS_TEXT = 48 };

/* "physical", "isotropic", "isotropic:KAPPA" or KAPPA, which means the same. -1: it is none of these. */
int hourglass_read(const char *text, hourglass_control *to);

/* "physical" or "isotropic:KAPPA", which reads back as the same. */
void hourglass_text(hourglass_control control, char text[HOURGLASS_TEXT]);

#endif
