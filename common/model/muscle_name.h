/* The names of muscles: volumes whose name may begin with muscle_, which people may leave out. Owns nothing. */
#ifndef SINEW_MUSCLE_NAME_H
#define SINEW_MUSCLE_NAME_H

/* The name of a muscle past "muscle_", where it begins so (any case) and goes on; else the name. */
const char *muscle_name_short(const char *name);

#endif
