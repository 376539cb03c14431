#include "render/png.h"

#include "base/mem.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>

/* libpng says what went wrong, if little. */
static int failed(png_image *image, const char *place, const char *what, err *e)
{
    err_set(e, place, 0, "%s: %s", what, image->message);
    png_image_free(image);
    return -1;
}

int png_put(const uint8_t *pixel, int width, int height, int channels, out *to, err *e)
{
    png_image image = {.version = PNG_IMAGE_VERSION,
                       .width = (png_uint_32)width,
                       .height = (png_uint_32)height,
                       .format = channels == 4 ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB,
                       /* Half the time, and hardly a larger file. */
                       .flags = PNG_IMAGE_FLAG_FAST};
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    uint8_t *bytes = mem_array((int64_t)size, 1, "a PNG", e);
    if (!bytes)
        return -1;
    int code = 0;
    if (png_image_write_to_memory(&image, bytes, &size, 0, pixel, 0, NULL))
        out_write(to, bytes, size);
    else
        code = failed(&image, NULL, "cannot make a PNG", e);
    free(bytes);
    return code;
}

uint8_t *png_get(const char *path, int *width, int *height, err *e)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_file(&image, path)) {
        failed(&image, path, "cannot be read as PNG", e);
        return NULL;
    }
    image.format = PNG_FORMAT_RGBA;
    uint8_t *pixel = mem_array(4 * (int64_t)image.width * image.height, 1, "a PNG", e);
    if (pixel && !png_image_finish_read(&image, NULL, pixel, 0, NULL)) {
        failed(&image, path, "cannot be read as PNG", e);
        free(pixel);
        return NULL;
    }
    png_image_free(&image);
    *width = (int)image.width;
    *height = (int)image.height;
    return pixel;
}
