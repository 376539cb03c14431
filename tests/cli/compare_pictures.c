/* compare_pictures A.png B.png: how far two pictures are from one another. Says the mean difference of all
 * bytes, in 255ths, and the share of pixels that differ by more than 32 of them in some channel; exits 1
 * where the mean is above 1 or the share above a hundredth (a processor may round an edge to the next
 * pixel), or the sizes differ; 2 on trouble.
 */
#include "base/err.h"
#include "base/mem.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>

/* [*height][*width][4] bytes, which the caller frees; NULL with e filled. */
static uint8_t *read_picture(const char *path, int *width, int *height, err *e)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    uint8_t *pixel = NULL;
    if (png_image_begin_read_from_file(&image, path)) {
        image.format = PNG_FORMAT_RGBA;
        pixel = mem_array(4 * (int64_t)image.width * image.height, 1, "a PNG", e);
    }
    if (pixel && !png_image_finish_read(&image, NULL, pixel, 0, NULL)) {
        free(pixel);
        pixel = NULL;
    }
    if (!pixel && !e->status)
        err_set(e, path, 0, "cannot be read as PNG: %s", image.message);
    png_image_free(&image);
    *width = (int)image.width;
    *height = (int)image.height;
    return pixel;
}

static int compare(const uint8_t *a, const uint8_t *b, int64_t pixels)
{
    double sum = 0;
    int64_t far = 0;
    for (int64_t p = 0; p < pixels; p++) {
        int worst = 0;
        for (int i = 0; i < 4; i++) {
            int d = abs(a[4 * p + i] - b[4 * p + i]);
            sum += d;
            worst = d > worst ? d : worst;
        }
        far += worst > 32;
    }
    double mean = sum / (4 * (double)pixels), share = (double)far / (double)pixels;
    printf("mean %.4f, %.5f of the pixels far\n", mean, share);
    return mean > 1 || share > .01;
}

int main(int argc, char **argv)
{
    int width[2], height[2], status = 2;
    uint8_t *picture[2] = {NULL, NULL};
    err e = {0};
    if (argc != 3) {
        fputs("usage: compare A.png B.png\n", stderr);
        return 2;
    }
    for (int i = 0; i < 2 && !e.status; i++)
        picture[i] = read_picture(argv[i + 1], &width[i], &height[i], &e);
    if (e.status) {
        fprintf(stderr, "compare: %s\n", e.text);
    } else if (width[0] != width[1] || height[0] != height[1]) {
        printf("%d x %d and %d x %d\n", width[0], height[0], width[1], height[1]);
        status = 1;
    } else {
        status = compare(picture[0], picture[1], (int64_t)width[0] * height[0]);
    }
    free(picture[0]);
    free(picture[1]);
    return status;
}
