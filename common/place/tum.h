/* A pose as a line of words, as TUM's: time tx ty tz qx qy qz qw, in s and m, a unit quaternion, scalar last. It keeps
 * nothing.
 */
#ifndef SINEW_TUM_H
#define SINEW_TUM_H

#include "base/keyfile.h"
#include "base/pose.h"

enum { TUM_WORDS = 8 };

#define TUM_LINE "time tx ty tz qx qy qz qw"

/* Takes the TUM_WORDS words of k. -1 with e filled: a word that is no finite number, a quaternion whose length is not
 * 1. */
int tum_take(const keyfile *k, double *time, pose *to, err *e);

#endif
