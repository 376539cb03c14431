#include "picture/png.h"

#include "base/mem.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* libpng says what went wrong, if little. */
static int failed(png_image *image, const char *place, const char *what, err *e)
{
    err_set(e, place, 0, "%s: %s", what, image->message);
    png_image_free(image);
    return -1;
}

/* The picture as a PNG, *size bytes that the caller frees. NULL with e filled. */
static uint8_t *make(const uint8_t *pixel, int width, int height, int channels, png_alloc_size_t *size, err *e)
{
    png_image image = {.version = PNG_IMAGE_VERSION,
                       .width = (png_uint_32)width,
                       .height = (png_uint_32)height,
                       .format = channels == 4 ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB,
                       /* Half the time, and hardly a larger file. */
                       .flags = PNG_IMAGE_FLAG_FAST};
    *size = PNG_IMAGE_PNG_SIZE_MAX(image);
    uint8_t *bytes = mem_array((int64_t)*size, 1, "a PNG", e);
    if (!bytes || png_image_write_to_memory(&image, bytes, size, 0, pixel, 0, NULL))
        return bytes;
    failed(&image, NULL, "cannot make a PNG", e);
    free(bytes);
    return NULL;
}

int png_put(const uint8_t *pixel, int width, int height, int channels, out *to, err *e)
{
    png_alloc_size_t size;
    uint8_t *bytes = make(pixel, width, height, channels, &size, e);
    if (bytes)
        out_write(to, bytes, size);
    free(bytes);
    return bytes ? 0 : -1;
}

enum { HEADER = 8 + 25, PHYS = 9 }; /* the signature and IHDR; what pHYs holds */

static void put_u32(uint8_t *to, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(value >> (24 - 8 * i));
}

/* libpng's simple calls, which make the same bytes as ever, have no pHYs; it goes right after IHDR. */
int png_put_scaled(const uint8_t *pixel, int width, int height, int channels, const double each[2], out *to, err *e)
{
    png_alloc_size_t size;
    uint8_t chunk[12 + PHYS] = {0, 0, 0, PHYS, 'p', 'H', 'Y', 's', [8 + PHYS - 1] = 1 /* a metre */};
    const bool fits = each[0] >= 1 && each[0] < INT32_MAX && each[1] >= 1 && each[1] < INT32_MAX;
    uint8_t *bytes = make(pixel, width, height, channels, &size, e);
    if (!bytes)
        return -1;
    for (int i = 0; i < 2 && fits; i++)
        put_u32(chunk + 8 + 4 * i, (uint32_t)(each[i] + .5));
    put_u32(chunk + 8 + PHYS, (uint32_t)crc32(0, chunk + 4, 4 + PHYS));
    out_write(to, bytes, HEADER);
    if (fits)
        out_write(to, chunk, sizeof chunk);
    out_write(to, bytes + HEADER, size - HEADER);
    free(bytes);
    return 0;
}
