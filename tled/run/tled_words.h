/* What tled-run says on standard error of a run: as it begins, and once it is over. Owns nothing.
 */
#ifndef SINEW_TLED_WORDS_H
#define SINEW_TLED_WORDS_H

#include "tled/loop/multigrid.h"
#include "tled/run/options.h"
#include "tled/run/tled_session.h"

/* device: what computes, in words. */
void words_start(const session *s, const char *device, const struct options *o);

/* Where multiples of an option's interval lie between two steps, other than the last's end, which is met. */
void words_between(const session *s, const char *option, const char *what, double every);

/* run_setup's `refined`; context: the session. */
void words_refined(void *context, double time, double closest);

/* With -v: what coarser models the run begins from, or why from none. Without: that such a run failed, and begins
 * again. */
void words_coarse(const session *s, const err *none);
void words_anew(const session *s, const err *e);

/* Of the frames that were written, whether the run came to its end or not. */
void words_folds(session *s, const run_end *end, bool ended);

void words_end(session *s, const run_end *end);

#endif
