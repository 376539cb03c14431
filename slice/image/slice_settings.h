/* Lines `set KEY VALUE`, which change what the images of a live run look like: gain, tgc, dynamic-range, depth, width,
 * probe, thickness and coupling, whose values are those of the options; labels and freeze, on or off. Owns nothing.
 */
#ifndef SINEW_SLICE_SETTINGS_H
#define SINEW_SLICE_SETTINGS_H

#include "base/keyfile.h"
#include "live/record.h"
#include "slice/image/slice_session.h"

/* Takes a line: -1 with e filled, its place in it, and all as it was. */
int slice_settings_take(slice_session *s, const keyfile *k, err *e);

/* Writes every setting's value into a record, as such lines. */
void slice_settings_record(const slice_session *s, record *r);

#endif
