/* What may change while msds-run runs: the lines `set KEY VALUE` of poses, of live controls and of records. A key is an
 * option's name, and its value is read as the option's is; how it takes effect is said in one table. Owns nothing.
 */
#ifndef SINEW_SETTINGS_H
#define SINEW_SETTINGS_H

#include "base/keyfile.h"
#include "msds/run/session.h"

/* Takes a line `method NAME` or `set KEY VALUE`, from the next frame on. -1 with e filled, and all is as it was. */
int settings_take(session *s, const keyfile *k, err *e);

/* The setting's present value as its line has it, for i from 0 on; false: there is no such setting, or it has no value
 * that a line could give. */
enum { SETTINGS_TEXT = 300 };
bool settings_text(const session *s, int i, char text[SETTINGS_TEXT]);
int settings_count(void);

#endif
