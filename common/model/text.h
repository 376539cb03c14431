/* The text encoding of a model: one thing a line, one row of an array a line. See sinew-model(5). No state but the
 * source's.
 */
#ifndef SINEW_TEXT_H
#define SINEW_TEXT_H

#include "model/item.h"

extern const encoding text_encoding;

enum { TEXT_FIRST = '%' }; /* the first byte, for sniffing */

#endif
