/* Words in a picture: one font, drawn into an image. The one user of FreeType. The creator owns a font; a size is
 * set before anything is measured or drawn. Text is UTF-8; what is not is drawn as U+FFFD.
 */
#ifndef SINEW_FONT_H
#define SINEW_FONT_H

#include "picture/image.h"

typedef struct font font;

/* Where Debian's fonts-dejavu-core puts the font that is taken where none is asked for. */
#define FONT_DEFAULT "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"

/* path NULL: FONT_DEFAULT. NULL with e filled. */
font *font_open(const char *path, err *e);
void font_close(font *t); /* t may be NULL */

/* The size of an em, in pixels. */
int font_set(font *t, int size, err *e);

/* How far words reach, in pixels. */
int font_width(font *t, const char *words);

/* Draws words in one colour (linear), from x on, upon a baseline. What falls outside the image is left out. */
void font_draw(font *t, image *im, int x, int baseline, const char *words, const float colour[3]);

/* The same with x at their middle, moved to stay within low to high. */
void font_draw_middle(font *t, image *im, int x, int low, int high, int baseline, const char *words,
                      const float colour[3]);

/* Cuts words short to at most `most` pixels, with three dots where they were longer. to:
 * at least as large as words and 4 bytes. */
void font_shorten(font *t, const char *words, int most, char *to);

#endif
