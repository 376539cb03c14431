/* The commands of PLUS (PlusServer commands, SetUsParameter and its like), as 3D Slicer sends them, answered: what they
 * set becomes lines for us-slice's --control, and what they ask for is told. Values are texts of numbers, in the units
 * that PLUS's names have:
 *
 *     DepthMm D                         set depth Dmm
 *     GainPercent P                     set gain (0.6 (P - 50)): 0 to 100 % are -30 to 30 dB
 *     DynRangeDb R                      set dynamic-range R
 *     TimeGainCompensation A B C ...    set tgc A,B,C,...: dB, at equal steps from face to depth
 *
 * The caller owns it.
 */
#ifndef SINEW_SERVE_US_H
#define SINEW_SERVE_US_H

#include "base/err.h"
#include "link/serve_control.h"

#include <stddef.h>

enum { SERVE_PAIRS = 20, SERVE_KEY = 40, SERVE_VALUE = 200, SERVE_TEXT = 6000 };

typedef struct serve_us serve_us;

/* An answer: its XML, and metadata of header version 2. */
typedef struct serve_answer {
    bool ok;
    char name[SERVE_KEY]; /* of the command */
    char text[SERVE_TEXT];
    char message[SERVE_TEXT]; /* what an old client gets: the result alone */
    char key[SERVE_PAIRS][SERVE_KEY], value[SERVE_PAIRS][SERVE_VALUE];
    const char *pair[SERVE_PAIRS][2];
    int pairs;
} serve_answer;

/* control: borrowed; NULL: nothing can be set. NULL with e filled. */
serve_us *serve_us_make(serve_control *control, err *e);
void serve_us_free(serve_us *u);

/* An image is so large, and its beams so long (m). Any thread may call it. */
void serve_us_saw(serve_us *u, int columns, int rows, double depth);

/* Answers a command, whose name counts where its XML has none. */
void serve_us_answer(serve_us *u, const char *name, const char *xml, size_t size, serve_answer *a);

#endif
