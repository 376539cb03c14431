#include "picture/font.h"

#include "base/mem.h"

#include <ft2build.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include FT_FREETYPE_H

struct font {
    FT_Library library;
    FT_Face face;
};

font *font_open(const char *path, err *e)
{
    const char *file = path ? path : FONT_DEFAULT;
    font *t = mem_array(1, sizeof *t, "a font", e);
    if (!t)
        return NULL;
    if (FT_Init_FreeType(&t->library))
        err_set(e, NULL, 0, "FreeType cannot be used");
    else if (!FT_New_Face(t->library, file, 0, &t->face))
        return t;
    else if (path)
        err_set(e, path, 0, "cannot be read as a font; expected a TrueType or OpenType file");
    else
        err_set(e, file, 0, "no such font; expected Debian's fonts-dejavu-core, or --font FILE");
    font_close(t);
    return NULL;
}

void font_close(font *t)
{
    if (!t)
        return;
    if (t->face)
        FT_Done_Face(t->face);
    if (t->library)
        FT_Done_FreeType(t->library);
    free(t);
}

int font_set(font *t, int size, err *e)
{
    if (FT_Set_Pixel_Sizes(t->face, 0, (FT_UInt)size))
        return err_set(e, NULL, 0, "the font has no size of %d pixels; expected one with outlines", size);
    return 0;
}

/* How many bytes follow the first of a character; -1: none begins so. */
static int bytes_after(unsigned char first)
{
    if (first < 0x80)
        return 0;
    if ((first & 0xe0) == 0xc0)
        return 1;
    if ((first & 0xf0) == 0xe0)
        return 2;
    return (first & 0xf8) == 0xf0 ? 3 : -1;
}

/* The next character of UTF-8 at *at, which moves on; 0 at the end. */
static FT_ULong next(const char **at)
{
    const unsigned char *p = (const unsigned char *)*at;
    int more = bytes_after(*p);
    FT_ULong code = more > 0 ? *p & (0x3fu >> more) : *p;
    if (!*p)
        return 0;
    p++;
    for (int i = 0; i < more; i++, p++) {
        if ((*p & 0xc0) != 0x80) {
            more = -1;
            break;
        }
        code = code << 6 | (*p & 0x3f);
    }
    *at = (const char *)p;
    return more < 0 ? 0xfffd : code;
}

/* Loads the next glyph and moves the pen (in 64ths of a pixel) by the kerning before it. False at the end. */
static bool load(font *t, const char **at, FT_UInt *last, FT_Pos *pen, FT_Int32 how)
{
    FT_ULong code = next(at);
    FT_Vector kern = {0, 0};
    if (!code)
        return false;
    FT_UInt glyph = FT_Get_Char_Index(t->face, code);
    if (*last && !FT_Get_Kerning(t->face, *last, glyph, FT_KERNING_DEFAULT, &kern))
        *pen += kern.x;
    *last = glyph;
    if (FT_Load_Glyph(t->face, glyph, how | FT_LOAD_TARGET_LIGHT))
        t->face->glyph->advance.x = 0;
    return true;
}

int font_width(font *t, const char *words)
{
    FT_Pos pen = 0;
    FT_UInt last = 0;
    while (load(t, &words, &last, &pen, FT_LOAD_DEFAULT))
        pen += t->face->glyph->advance.x;
    return (int)((pen + 63) / 64);
}

/* Dark text laid over light by its coverage alone looks thin where light is added linearly: so a little more of it. */
static float cover(unsigned char coverage)
{
    return powf((float)coverage / 255, .7f);
}

static void put(image *im, const FT_Bitmap *b, int left, int top, const float colour[3])
{
    for (int r = 0; r < (int)b->rows; r++)
        for (int c = 0; c < (int)b->width; c++) {
            int x = left + c, y = top + r;
            if (x < 0 || y < 0 || x >= im->width || y >= im->height)
                continue;
            float a = cover(b->buffer[r * b->pitch + c]), *p = &im->pixel[4 * ((int64_t)y * im->width + x)];
            for (int i = 0; i < 4; i++)
                p[i] = a * (i < 3 ? colour[i] : 1) + (1 - a) * p[i];
        }
}

void font_draw(font *t, image *im, int x, int baseline, const char *words, const float colour[3])
{
    FT_Pos pen = 64 * (FT_Pos)x;
    FT_UInt last = 0;
    while (load(t, &words, &last, &pen, FT_LOAD_RENDER)) {
        FT_GlyphSlot g = t->face->glyph;
        if (g->bitmap.pixel_mode == FT_PIXEL_MODE_GRAY)
            put(im, &g->bitmap, (int)((pen + 32) >> 6) + g->bitmap_left, baseline - g->bitmap_top, colour);
        pen += g->advance.x;
    }
}

void font_draw_middle(font *t, image *im, int x, int low, int high, int baseline, const char *words,
                      const float colour[3])
{
    int width = font_width(t, words), from = x - width / 2;
    if (from + width > high)
        from = high - width;
    font_draw(t, im, from > low ? from : low, baseline, words, colour);
}

void font_shorten(font *t, const char *words, int most, char *to)
{
    strcpy(to, words);
    for (size_t n = strlen(words); n && font_width(t, to) > most;) {
        do
            n--;
        while (n && (words[n] & 0xc0) == 0x80);
        strcpy(to + n, "...");
    }
}
