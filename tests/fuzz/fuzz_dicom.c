// needs: slice/import/dicom_image.c slice/import/dicom_file.cc slice/import/dicom_pixels.c slice/import/dicom_colour.c
// needs: slice/import/dicom_inflate.c slice/import/dicom_jpeg2000.c
// needs: slice/import/dicom_elements.c slice/import/dicom_lengths.c slice/import/dicom_jpeg.c slice/import/series.c
/* A DICOM file of any bytes is read or refused; what was read makes a volume, or not, twice over too. What DCMTK keeps
 * for the whole of a program's life is its own.
 */
#include "slice/import/series.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static void make_volume(const series *s, bool spaced)
{
    series_wish wish = {{(double)NAN, (double)NAN, (double)NAN}, 1, 1, NULL, NULL};
    volume v = {0};
    err e = {0};
    for (int a = 0; spaced && a < 3; a++)
        wish.spacing[a] = 1 + a;
    int code = series_volume(&v, s, &wish, &e);
    if ((code != 0) != (e.status != 0))
        abort();
    double sum = 0; /* every voxel is there */
    for (int64_t i = 0; !code && i < volume_count(&v); i++)
        sum += volume_value(&v, i);
    if (sum > 1e300)
        abort();
    volume_free(&v);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    dicom_image d = {0}, again = {0};
    dicom_elements seen = {0};
    series s = {0};
    err e = {0};
    int code = dicom_read(&d, bytes, size, "fuzz.dcm", &seen, &e);
    if ((code < 0) != (e.status != 0))
        abort();
    if (!code) {
        series_add(&s, "fuzz.dcm", &d, &e);
        make_volume(&s, false);
        make_volume(&s, true);
        if (!dicom_read(&again, bytes, size, "again.dcm", NULL, &e))
            series_add(&s, "again.dcm", &again, &e);
        make_volume(&s, true);
    }
    series_free(&s);
    dicom_elements_free(&seen);
    return 0;
}
