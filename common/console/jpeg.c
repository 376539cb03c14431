#include "console/jpeg.h"

#include <turbojpeg.h>

int jpeg_make(jpeg *j, const unsigned char *pixel, int columns, int rows, int channels, err *e)
{
    const int format = channels == 3 ? TJPF_RGB : TJPF_GRAY, sampling = channels == 3 ? TJSAMP_444 : TJSAMP_GRAY;
    unsigned long size = 0;
    if (!j->compressor && !(j->compressor = tjInitCompress()))
        return err_memory(e, "compressing a picture");
    /* Room for the worst, so that it stays where it is from picture to picture. */
    const unsigned long most = tjBufSize(columns, rows, sampling);
    if (most > j->capacity) {
        tjFree(j->bytes);
        j->bytes = tjAlloc((int)most);
        j->capacity = j->bytes ? most : 0;
        if (!j->bytes)
            return err_memory(e, "compressing a picture");
    }
    size = j->capacity;
    if (tjCompress2(j->compressor, pixel, columns, 0, rows, format, &j->bytes, &size, sampling, JPEG_QUALITY,
                    TJFLAG_NOREALLOC))
        return err_set(e, NULL, 0, "cannot compress a picture: %s", tjGetErrorStr2(j->compressor));
    j->size = size;
    return 0;
}

void jpeg_free(jpeg *j)
{
    if (j->compressor)
        tjDestroy(j->compressor);
    tjFree(j->bytes);
    *j = (jpeg){0};
}
