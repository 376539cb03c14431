/* Completion of command lines in bash and zsh, out of a tool's table of options: names, what an option's value may be,
 * and which files an operand is. Each script stands by itself. Owns nothing.
 */
#ifndef SINEW_OPT_COMPLETE_H
#define SINEW_OPT_COMPLETE_H

#include "cli/opt.h"

/* A function _sinew_complete_TOOL, with _ for -; the last line hands it to `complete`. */
void opt_complete_bash(const opt_tool *tool, out *to);

/* A file of functions for zsh's fpath. */
void opt_complete_zsh(const opt_tool *tool, out *to);

#endif
