/* Volume images: NRRD and MetaImage in all their encodings, orders and types, the geometry that they give, what is
 * written and read again, and what is refused, with its reason.
 */
#include "volume/metaimage.h"
#include "volume/nrrd.h"
#include "volume/volume.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

static int read_bytes(volume *v, const void *bytes, size_t size, err *e)
{
    in *s = in_memory(bytes, size, "v", e);
    int status = s ? volume_read(v, s, NULL, NULL, e) : -1;
    in_close(s);
    return status;
}

/* A header and data behind it. */
static int read_parts(volume *v, const char *header, const void *data, size_t size, err *e)
{
    size_t n = strlen(header);
    char *all = malloc(n + size + 1);
    if (!all)
        return -1;
    memcpy(all, header, n + 1);
    if (size)
        memcpy(all + n, data, size);
    int status = read_bytes(v, all, n + size, e);
    free(all);
    return status;
}

static void refuse(const char *header, const char *data, size_t size, const char *want)
{
    volume v;
    err e = {0};
    int status = read_parts(&v, header, data, size, &e);
    ok(status == -1 && e.status == STATUS_BAD && strstr(e.text, want), "%s", e.text[0] ? e.text : header);
    if (!strstr(e.text, want))
        printf("# wanted: %s\n", want);
    volume_free(&v);
}

/* ---- types, orders, encodings */

enum { VOXELS = 24 };

/* Numbers that every type holds, and the ends of its range. */
static void fill(volume *v)
{
    for (int i = 0; i < VOXELS; i++)
        switch (v->type) {
#define FILL(name, of, nrrd, meta, low, high)                                                                          \
    case VOLUME_##name:                                                                                                \
        ((of *)v->data)[i] = (of)(i / ((low) < (high) ? 1. : 3.));                                                     \
        if ((low) < (high) && i < 2)                                                                                   \
            ((of *)v->data)[i] = ((const of[]){(of)(low), (of)(high)})[i];                                             \
        break;
            VOLUME_TYPES(FILL)
        default:
            break;
        }
}

static void reverse(unsigned char *p, size_t size, size_t count)
{
    for (size_t n = 0; n < count; n++, p += size)
        for (size_t i = 0; i < size / 2; i++) {
            unsigned char one = p[i];
            p[i] = p[size - 1 - i];
            p[size - 1 - i] = one;
        }
}

static bool same_voxels(const volume *a, const volume *b)
{
    return a->type == b->type && !memcmp(a->size, b->size, sizeof a->size) &&
           !memcmp(a->data, b->data, (size_t)volume_count(a) * volume_type_size(a->type));
}

/* Reads the voxels of v behind a header, as they are, turned over, and compressed. */
static void orders(const volume *v, const char *little, const char *big, const char *deflated, int window)
{
    size_t size = volume_type_size(v->type), bytes = VOXELS * size;
    unsigned char turned[VOXELS * 8], packed[1000];
    z_stream z = {.next_in = v->data, .avail_in = (uInt)bytes, .next_out = packed, .avail_out = sizeof packed};
    volume got;
    err e = {0};
    memcpy(turned, v->data, bytes);
    reverse(turned, size, VOXELS);
    ok(!read_parts(&got, little, v->data, bytes, &e) && same_voxels(&got, v), "type %d, little-endian %s", v->type,
       e.text);
    volume_free(&got);
    ok(!read_parts(&got, big, turned, bytes, &e) && same_voxels(&got, v), "big-endian %s", e.text);
    volume_free(&got);
    deflateInit2(&z, 6, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY);
    deflate(&z, Z_FINISH);
    ok(!read_parts(&got, deflated, packed, sizeof packed - z.avail_out, &e) && same_voxels(&got, v), "compressed %s",
       e.text);
    deflateEnd(&z);
    volume_free(&got);
}

static void as_text(const volume *v, const char *header)
{
    char text[VOXELS * 40];
    size_t n = 0;
    volume got;
    err e = {0};
    for (int i = 0; i < VOXELS; i++)
        if (v->type == VOLUME_I64 || v->type == VOLUME_U64)
            n += (size_t)snprintf(text + n, sizeof text - n, "%lld\n", (long long)((int64_t *)v->data)[i]);
        else
            n += (size_t)snprintf(text + n, sizeof text - n, "%.17g%s", volume_value(v, i), i % 4 ? " " : "\r\n");
    ok(!read_parts(&got, header, text, n, &e) && same_voxels(&got, v), "as text %s", e.text);
    volume_free(&got);
}

static void types(void)
{
#define NAMES(name, of, nrrd, meta, low, high) {nrrd, meta},
    static const char *const name[][2] = {VOLUME_TYPES(NAMES)};
    for (int t = 0; t < VOLUME_TYPE_COUNT; t++) {
        volume v = {.type = (volume_type)t, .size = {4, 3, 2}};
        err e = {0};
        char h[4][400];
        if (volume_make(&v, &e))
            return;
        fill(&v);
        static const char *const nrrd[] = {"endian: little\nencoding: raw", "endian: big\nencoding: raw",
                                           "endian: little\nencoding: gzip", "encoding: ascii"};
        for (int i = 0; i < 4; i++)
            snprintf(h[i], sizeof h[i], "NRRD0004\ntype: %s\ndimension: 3\nsizes: 4 3 2\n%s\n\n", name[t][0], nrrd[i]);
        orders(&v, h[0], h[1], h[2], 15 + 16);
        as_text(&v, h[3]);
        static const char *const meta[] = {"BinaryDataByteOrderMSB = False", "BinaryDataByteOrderMSB = True",
                                           "CompressedData = True", "BinaryData = False"};
        for (int i = 0; i < 4; i++)
            snprintf(h[i], sizeof h[i],
                     "ObjectType = Image\nNDims = 3\n%s\nDimSize = 4 3 2\nElementType = %s\nElementDataFile = LOCAL\n",
                     meta[i], name[t][1]);
        orders(&v, h[0], h[1], h[2], 15);
        as_text(&v, h[3]);
        volume_free(&v);
    }
}

/* ---- geometry */

#define NRRD(fields) "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n" fields "\n"
#define META(fields)                                                                                                   \
    "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n" fields "ElementDataFile = LOCAL\n"

static bool is_geometry(const char *header, const double want[12])
{
    volume v;
    err e = {0};
    bool same = !read_parts(&v, header, "01234567", 8, &e);
    for (int i = 0; same && i < 3; i++)
        for (int a = 0; a < 4; a++)
            same = same && fabs((a < 3 ? v.axis[a][i] : v.origin[i]) - want[3 * a + i]) < 1e-12;
    if (e.text[0])
        printf("# %s\n", e.text);
    volume_free(&v);
    return same;
}

static void geometry(void)
{
    ok(is_geometry(NRRD(""), (double[]){1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), "nothing said: 1 mm, LPS");
    ok(is_geometry(NRRD("spacings: 0.5 2 3\n"), (double[]){.5, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0}), "spacings");
    ok(is_geometry(
           NRRD("space: left-posterior-superior\nspace directions: (0,2,0) (-3,0,0) (0,0,4)\nspace origin: (5,6,7)\n"),
           (double[]){0, 2, 0, -3, 0, 0, 0, 0, 4, 5, 6, 7}),
       "directions and an origin, LPS");
    ok(is_geometry(NRRD("space: RAS\nspace directions: (1,2,0) (-3,1,0) (0,0,4)\nspace origin: (5,6,7)\n"),
                   (double[]){-1, -2, 0, 3, -1, 0, 0, 0, 4, -5, -6, 7}),
       "RAS becomes LPS");
    ok(is_geometry(
           NRRD("space: left-anterior-superior\nspace directions: (1,2,0) (-3,1,0) (0,0,4)\nspace origin: (5,6,7)\n"),
           (double[]){1, -2, 0, -3, -1, 0, 0, 0, 4, 5, -6, 7}),
       "so does LAS");
    ok(is_geometry(
           NRRD("space dimension: 3\nspace units: \"m\" \"cm\" \"um\"\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
                "space origin: ( 1 , 1,1)\n"),
           (double[]){1000, 0, 0, 0, 10, 0, 0, 0, .001, 1000, 10, .001}),
       "units become mm");
    ok(is_geometry(META("ElementSpacing = 0.5 2 3\nOffset = 1 2 3\n"), (double[]){.5, 0, 0, 0, 2, 0, 0, 0, 3, 1, 2, 3}),
       "MetaImage: spacing and offset");
    ok(is_geometry(META("ElementSize = 0.5 2 3\nPosition = 1 2 3\nOrientation = 0 1 0 -1 0 0 0 0 1\n"),
                   (double[]){0, .5, 0, -2, 0, 0, 0, 0, 3, 1, 2, 3}),
       "by the other names; each axis's direction in a row");
    ok(is_geometry(META("ElementSize = 9 9 9\nElementSpacing = 1 2 3\nElementSize = 9 9 9\n"),
                   (double[]){1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0}),
       "the distance of voxels goes before their size");
    static const char plane[] = "NRRD0001\ntype: uchar\ndimension: 2\nsizes: 4 2\nencoding: raw\nspacings: 2 3\n\n";
    ok(is_geometry(plane, (double[]){2, 0, 0, 0, 3, 0, 0, 0, 1, 0, 0, 0}), "an image in a plane, NRRD");
    ok(is_geometry("NRRD0004\ntype: uchar\ndimension: 2\nsizes: 4 2\nencoding: raw\nspace: LPS\n"
                   "space directions: (0,2,0) (0,0,3)\n\n",
                   (double[]){0, 2, 0, 0, 0, 3, 1, 0, 0, 0, 0, 0}),
       "an image in another plane has that plane's normal");
    ok(is_geometry("ObjectType = Image\nNDims = 2\nDimSize = 4 2\nElementType = MET_UCHAR\nElementSpacing = 2 3\n"
                   "TransformMatrix = 0 1 -1 0\nElementDataFile = LOCAL\n",
                   (double[]){0, 2, 0, -3, 0, 0, 0, 0, 1, 0, 0, 0}),
       "and MetaImage");
    ok(is_geometry(
           "NRRD0005\ntype: uchar\ndimension: 4\nsizes: 1 2 2 2\nkinds: list domain domain domain\nencoding: raw\n"
           "space: LPS\nspace directions: none (1,0,0) (0,1,0) (0,0,2)\n\n",
           (double[]){1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0}),
       "an axis of one value is passed over");
    ok(is_geometry("NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nkinds: domain domain list\nencoding: raw\n"
                   "space: LPS\nspace directions: (1,0,0) (0,2,0) none\n\n",
                   (double[]){1, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0}),
       "a list of images lies along their normal");
}

/* Places and voxels, both ways, of an oblique and left-handed image. */
static void places(void)
{
    volume v = {.size = {5, 6, 7}, .origin = {10, -20, 30}, .axis = {{0, 2, .1}, {3, .5, 0}, {.2, 0, 4}}};
    volume_finder f = volume_finder_of(&v);
    double voxel[3], place[3], worst = 0;
    int64_t wrong = 0;
    for (int n = 0; n < 5 * 6 * 7; n++) {
        const double at[3] = {n % 5, n / 5 % 6, n / 30};
        volume_place(&v, at, place);
        volume_voxel(&f, place, voxel);
        for (int a = 0; a < 3; a++)
            worst = fmax(worst, fabs(voxel[a] - at[a]));
        wrong += volume_nearest(&v, &f, place) != n;
    }
    ok(worst < 1e-12 && !wrong, "a voxel's centre is the voxel's (%g)", worst);
    volume_place(&v, (double[]){1, 0, 0}, place);
    near_(place[0], .010, 1e-15, "places are in m");
    volume_place(&v, (double[]){-.51, 0, 0}, place);
    ok(volume_nearest(&v, &f, place) == -1, "outside");
    volume_place(&v, (double[]){4.49, 5.49, 6.49}, place);
    ok(volume_nearest(&v, &f, place) == 5 * 6 * 7 - 1, "the last voxel reaches half a voxel out");
    ok(volume_nearest(&v, &f, (double[]){NAN, 0, 0}) == -1, "nowhere");
    ok(volume_handed(&v) < 0, "left-handed");
    near_(volume_spacing(&v, 0), sqrt(4.01), 1e-15, "the spacing");
}

/* ---- writing */

static void written(bool gzip)
{
    for (int t = 0; t < VOLUME_TYPE_COUNT; t++) {
        volume v = {.type = (volume_type)t,
                    .size = {4, 3, 2},
                    .origin = {.1, -1e-3 / 3, 12345.678901234567},
                    .axis = {{0, .501, .1}, {1. / 3, .5, 0}, {.2, 0, .7}}};
        volume got = {0};
        err e = {0};
        size_t size;
        out *to = out_memory(&e);
        if (!to || volume_make(&v, &e))
            return;
        fill(&v);
        volume_name(&v, 7, "vein\\ left\xC3\xA9", &e);
        volume_name(&v, -2, "bone", &e);
        volume_name(&v, 7, "vein\\new", &e);
        int status = nrrd_write(&v, gzip, to, &e);
        const unsigned char *bytes = out_bytes(to, &size);
        status |= read_bytes(&got, bytes, size, &e);
        ok(!status && same_voxels(&got, &v) && !memcmp(got.axis, v.axis, sizeof v.axis) &&
               !memcmp(got.origin, v.origin, sizeof v.origin),
           "type %d, %s: what is read is what was written, to the bit %s", t, gzip ? "gzip" : "raw", e.text);
        ok(got.labels == 2 && got.label[0].value == -2 && volume_label_of(&got, 7) &&
               !strcmp(volume_label_of(&got, 7), "vein\\new") && !volume_label_of(&got, 1),
           "with the names of its labels");
        volume_free(&v);
        volume_free(&got);
        out_discard(to);
    }
}

/* ---- what is refused */

static void refused_nrrd(void)
{
    refuse("", "", 0, "no volume in it (0 bytes)");
    refuse("hello\n", "", 0, "v:1: 'hello' begins no volume of a known format");
    refuse("\x89PNG\n", "", 0, "v: is not a volume of a known format");
    refuse("NRRD0004\n", "", 0, "v:1: the header ends here");
    refuse("NRRD0004\n\n", "", 0, "a header without dimension");
    refuse("NRRD0004\nsizes: 2 2 2\n\n", "", 0, "v:2: sizes: comes first; expected dimension before it");
    refuse("NRRD0004\ntyp: uchar\n\n", "", 0, "v:2: field: 'typ'; expected a field of NRRD");
    refuse("NRRD0004\ntype: block\n\n", "", 0, "type: 'block'");
    refuse("NRRD0004\ntype uchar\n\n", "", 0, "v:2: the header: 'type uchar'");
    refuse("NRRD0004\ndimension: 17\n\n", "", 0, "dimension: '17'; expected 1 whole number from 1 to 16");
    refuse("NRRD0004\ndimension: 3\nsizes: 2 2\n\n", "", 0, "sizes: too few");
    refuse("NRRD0004\ndimension: 3\nsizes: 2 0 2\n\n", "", 0, "sizes: '0'");
    refuse("NRRD0004\ndimension: 3\nsizes: 2 -3 2\n\n", "", 0, "sizes: '-3'");
    refuse("NRRD0004\ndimension: 3\nsizes: 2 2 2 2\n\n", "", 0, "sizes: '2'");
    refuse(NRRD("encoding: bzip2\n"), "01234567", 8, "encoding: 'bzip2'; expected raw, gzip or ascii");
    refuse(NRRD("endian: middle\n"), "01234567", 8, "endian: 'middle'");
    refuse(NRRD("type: short\n"), "0123456789abcdef", 16, "a header without endian");
    refuse(NRRD("space: left-handed\n"), "01234567", 8, "space: 'left-handed'");
    refuse(NRRD("space directions: (1,0,0) (0,1,0)\n"), "01234567", 8, "expected (x,y,z), finite, or none");
    refuse(NRRD("space directions: (1,0,0) (0,1,0) (0,0,nan)\n"), "01234567", 8, "space directions: 'nan'");
    refuse(NRRD("space directions: (1,0,0) (0,1,0) (0,0)\n"), "01234567", 8, "expected (x,y,z)");
    refuse(NRRD("space directions: (1,0,0) (0,1,0) (1,1,0)\n"), "01234567", 8, "axes that lie in a plane");
    refuse(NRRD("space directions: (1,0,0) (0,1,0) (0,0,0)\n"), "01234567", 8, "voxels 0 mm apart along axis 2");
    refuse(NRRD("space directions: (1,0,0) (0,1,0) (0,0,1e200)\n"), "01234567", 8,
           "mm apart along axis 2; expected 1e-06 to 1e+09");
    refuse(NRRD("space origin: none\n"), "01234567", 8, "space origin: 'none'");
    refuse(NRRD("space origin: (1e30,0,0)\n"), "01234567", 8, "an origin at 1e+30 mm");
    refuse(NRRD("spacings: 1 -1 1\n"), "01234567", 8, "spacings: '-1'; expected a distance above 0");
    refuse(NRRD("spacings: 1 1\n"), "01234567", 8, "spacings: too few");
    refuse(NRRD("space units: \"mm\" \"mm\" \"ell\"\n"), "01234567", 8, "space units: 'ell'");
    refuse(NRRD("axis mins: 0 0 0\n"), "01234567", 8, "axis mins: '0 0 0'; expected space directions");
    refuse(NRRD("kinds: RGB-color domain domain\n"), "01234567", 8, "axis 0 holds 2 values of each voxel");
    refuse(NRRD("data file: LIST\n"), "", 0, "data file: 'LIST'; expected one file");
    refuse(NRRD("data file: x.raw\n"), "", 0,
           "v: its data are in a file of their own, 'x.raw', and it is in no folder");
    refuse(NRRD(""), "0123456", 7, "data for only 7 of 2 x 2 x 2 voxels");
    refuse(NRRD(""), "012345678", 9, "data for more than 8 of 2 x 2 x 2 voxels");
    refuse(NRRD("encoding: gzip\n"), "01234567", 8, "compressed data is damaged");
    refuse(NRRD("encoding: gzip\n"), "\x1f\x8b\x08", 3, "compressed data is cut short");
    refuse(NRRD("encoding: ascii\n"), "1 2 3 4 5 6 7", 13, "data for only 7 of");
    refuse(NRRD("encoding: ascii\n"), "1 2 3 4 5 6 7 8 9", 17, "data for more than 8 of");
    refuse(NRRD("encoding: ascii\n"), "1 2 3 4 5 6 7 256", 17, "voxel 7: '256'; expected a number of the type");
    refuse(NRRD("encoding: ascii\n"), "1 2 3 4 5 6 7 x", 15, "voxel 7: 'x'");
    refuse(NRRD("encoding: ascii\n"), "1 2 \x01", 5, "data that is not text");
    refuse(NRRD("encoding: ascii\nbyte skip: -1\n"), "1", 1, "byte skip: -1 of data that are not raw");
    refuse(NRRD("byte skip: -1\n"), "0123", 4, "data for only 4 of");
    refuse(NRRD("byte skip: 9\n"), "01234567", 8, "fewer than the 9 bytes to skip");
    refuse(NRRD("line skip: 1\n"), "01234567", 8, "fewer than the 1 lines to skip");
    refuse(NRRD("Segment0_LabelValue:=x\n"), "01234567", 8, "Segment0_LabelValue: 'x'");
    refuse("NRRD0004\ntype: uchar\ndimension: 3\nencoding: raw\nsizes: 4000000000 4000000000 4000000000\n\n", "0", 1,
           "voxels are more than can be counted");
    refuse("NRRD0004\ntype: uchar\ndimension: 3\nencoding: raw\nsizes: 4000000 4000000 40000\n\n", "0", 1,
           "expected at most the memory there is");
}

static void refused_meta(void)
{
    refuse("ObjectType = Tube\n", "", 0, "v:1: ObjectType: 'Tube'; expected Image");
    refuse("ObjectType = Image\n", "", 0, "v:1: the header ends here; expected ElementDataFile");
    refuse("ObjectType = Image\nElementDataFile = LOCAL\n", "", 0, "a header without NDims");
    refuse("ObjectType = Image\nNDims = 3\nElementDataFile = LOCAL\n", "", 0, "a header without DimSize");
    refuse("ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementDataFile = LOCAL\n", "", 0,
           "a header without ElementType");
    refuse("ObjectType = Image\nDimSize = 2 2 2\n", "", 0, "v:2: DimSize: comes first; expected NDims before it");
    refuse("ObjectType = Image\nNDims = 4\n", "", 0, "NDims: '4'");
    refuse("ObjectType = Image\nwhat\n", "", 0, "v:2: the header: 'what'");
    refuse(META("ElementType = MET_LONG\n"), "", 0,
           "ElementType: 'MET_LONG'; expected a type of one length everywhere");
    refuse(META("ElementType = MET_ODD\n"), "", 0, "ElementType: 'MET_ODD'");
    refuse(META("ElementNumberOfChannels = 3\n"), "", 0, "ElementNumberOfChannels: '3'");
    refuse(META("ElementSpacing = 1 -1 1\n"), "01234567", 8, "ElementSpacing: a distance that is not above 0");
    refuse(META("ElementSpacing = 1 nan 1\n"), "01234567", 8, "ElementSpacing: 'nan'; expected 3 finite numbers");
    refuse(META("TransformMatrix = 1 0 0 0 1 0 1 0 0\n"), "01234567", 8, "axes that lie in a plane");
    refuse(META("TransformMatrix = 2 0 0 0 1 0 0 0 1\n"), "01234567", 8, "a direction whose length is not 1");
    refuse(META("TransformMatrix = 0 0 0 0 1 0 0 0 1\n"), "01234567", 8, "a direction whose length is not 1");
    refuse(META("TransformMatrix = 1 0 0 0 1 0 0 0\n"), "01234567", 8,
           "TransformMatrix: too few; expected 9 finite numbers");
    refuse(META("Offset = 1 2 inf\n"), "01234567", 8, "Offset: 'inf'");
    refuse(META("BinaryData = maybe\n"), "01234567", 8, "BinaryData: 'maybe'; expected True or False");
    refuse(META("BinaryData = False\nCompressedData = True\n"), "01234567", 8, "expected one of them");
    refuse(META("CompressedData = True\n"), "01234567", 8, "compressed data is damaged");
    refuse(META("CompressedData = True\nHeaderSize = -1\n"), "01234567", 8,
           "HeaderSize = -1 with data that are not raw bytes");
    refuse(META(""), "0123456", 7, "data for only 7 of 2 x 2 x 2 voxels");
    refuse(META(""), "012345678", 9, "data for more than 8 of");
    refuse("ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = LIST\n", "", 0,
           "ElementDataFile: 'LIST'; expected LOCAL, or one file");
    refuse("ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = a%d.raw\n", "",
           0, "ElementDataFile: 'a%d.raw'");
}

/* ---- data beside the header */

static bool put(const char *folder, const char *name, const char *text, size_t size)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "wb");
    bool whole = f && fwrite(text, 1, size, f) == size;
    return f && !fclose(f) && whole;
}

static void load(const char *folder, const char *data, const char *fields, const char *want)
{
    char path[4096], header[4096];
    volume v;
    err e = {0};
    snprintf(header, sizeof header, NRRD("%sdata file: %s\n"), fields, data);
    snprintf(path, sizeof path, "%s/v.nhdr", folder);
    bool there = put(folder, "v.nhdr", header, strlen(header));
    int status = volume_load(&v, path, NULL, &e);
    ok(there && (want ? status && strstr(e.text, want) : !status && volume_value(&v, 7) == '7'), "data file: %s %s",
       data, e.text);
    volume_free(&v);
}

static void beside(void)
{
    char folder[] = "/tmp/sinew-volume-XXXXXX", outside[sizeof folder + 16], link_path[sizeof folder + 16], name[4096];
    if (!mkdtemp(folder)) {
        ok(false, "a folder");
        return;
    }
    snprintf(outside, sizeof outside, "%s.raw", folder);
    snprintf(link_path, sizeof link_path, "%s/link.raw", folder);
    bool made = put(folder, "v.raw", "headline\n01234567", 17) && put(folder, "plain.raw", "01234567", 8) &&
                put("/", outside + 1, "01234567", 8) && !symlink(outside, link_path);
    ok(made, "files to read");
    load(folder, "plain.raw", "", NULL);
    load(folder, "v.raw", "byte skip: 9\n", NULL);
    load(folder, "v.raw", "line skip: 1\n", NULL);
    load(folder, "v.raw", "byte skip: -1\n", NULL);
    load(folder, "./plain.raw", "", NULL);
    load(folder, "v.raw", "", "v.raw: data for more than 8 of");
    load(folder, "none.raw", "", "none.raw: cannot open");
    snprintf(name, sizeof name, "../%s", strrchr(outside, '/') + 1);
    load(folder, name, "", "outside its folder");
    load(folder, outside, "", "outside its folder");
    load(folder, "link.raw", "", "outside its folder");
    load(folder, "/dev/zero", "", "outside its folder");
    load(folder, ".", "", "outside its folder");
    static const char *const left[] = {"v.nhdr", "v.raw", "plain.raw", "link.raw"};
    for (size_t i = 0; i < sizeof left / sizeof *left; i++) {
        snprintf(name, sizeof name, "%s/%s", folder, left[i]);
        unlink(name);
    }
    unlink(outside);
    ok(!rmdir(folder), "and nothing was left beside them");
}

static void real(void)
{
    const char *shared = getenv("SINEW_SHARED");
    char path[4096];
    volume v;
    err e = {0};
    snprintf(path, sizeof path, "%s/data/ultrasound/SpinePhantomFreehandReconstructed.mha",
             shared ? shared : "../shared");
    if (access(path, R_OK)) {
        skip(1, "no shared data");
        return;
    }
    ok(!volume_load(&v, path, NULL, &e) && v.size[0] == 147 && v.size[1] == 106 && v.size[2] == 104 &&
           v.type == VOLUME_U8 && v.axis[1][1] == .5 && v.origin[0] == -74.5217,
       "the spine phantom: 147 x 106 x 104, 0.5 mm %s", e.text);
    volume_free(&v);
}

/* ---- comments, and lists that are too long or too short */

#define NRRD_BODY                                                                                                      \
    "type: uint8\ndimension: 3\nspace: LPS\nsizes: 2 1 1\nspace directions: (1,0,0) (0,2,0) (0,0,3)\n"                 \
    "encoding: raw\nspace origin: (4,5,6)\nSegment0_Name:=vein\nSegment0_LabelValue:=1\n"

/* A comment may say anything, among it what would be a field or a key, anywhere between the first line and the empty
 * one. */
static void comments(void)
{
    static const char *const comment[] = {"#",
                                          "# more words",
                                          "# type: float",
                                          "#sizes: 9 9 9",
                                          "# field: with a value, and more words: yes",
                                          "# Segment0_Name:=artery",
                                          "#Segment0_LabelValue:=7 or 8",
                                          "# key:=value: of more words",
                                          "# field: key:=value",
                                          "#:=",
                                          "#: ",
                                          "# ends with a colon:",
                                          "# no such field: 3"};
    for (size_t i = 0; i < sizeof comment / sizeof *comment; i++)
        for (int after = 0; after < 2; after++) {
            char text[600];
            volume v;
            err e = {0};
            snprintf(text, sizeof text, "NRRD0004\n%s\n" NRRD_BODY "%s\n\n", after ? "# made by hand" : comment[i],
                     after ? comment[i] : "#");
            const bool read = !read_parts(&v, text, "ab", 2, &e);
            ok(read && v.type == VOLUME_U8 && v.size[0] == 2 && v.origin[2] == 6 && v.labels == 1 &&
                   v.label[0].value == 1 && !strcmp(v.label[0].name, "vein"),
               "'%s' is passed over %s", comment[i], e.text);
            volume_free(&v);
        }
    refuse("NRRD0004\nno comment\n" NRRD_BODY "\n", "ab", 2, "the header: 'no comment'");
}

/* A list of numbers has as many as are expected: what is more is not read, and what is less is not made up. */
static void lists(void)
{
    static const struct {
        const char *key, *right;
        int count;
    } list[] = {{"TransformMatrix", "1 0 0 0 1 0 0 0 1", 9}, {"Offset", "4 5 6", 3}, {"ElementSpacing", "1 2 3", 3}};
    for (size_t i = 0; i < sizeof list / sizeof *list; i++)
        for (int off = -1; off < 2; off++) {
            char text[600], value[60], want[100];
            volume v;
            err e = {0};
            const size_t n = strlen(list[i].right);
            snprintf(value, sizeof value, "%.*s%s", (int)(off < 0 ? n - 2 : n), list[i].right, off > 0 ? " 7" : "");
            snprintf(text, sizeof text,
                     "ObjectType = Image\nNDims = 3\nDimSize = 2 1 1\nElementType = MET_UCHAR\n%s = %s\n"
                     "ElementDataFile = LOCAL\n",
                     list[i].key, value);
            if (off) {
                snprintf(want, sizeof want, "v:5: %s: %s; expected %d finite numbers", list[i].key,
                         off > 0 ? "'7'" : "too few", list[i].count);
                refuse(text, "ab", 2, want);
                continue;
            }
            ok(!read_parts(&v, text, "ab", 2, &e), "%s = %s %s", list[i].key, value, e.text);
            volume_free(&v);
        }
    refuse("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 1 1 1\nencoding: raw\n\n", "ab", 2,
           "v:4: sizes: '1'; expected 3 whole numbers");
    refuse("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 1\nencoding: raw\n\n", "ab", 2,
           "v:4: sizes: too few; expected 3 whole numbers");
}

int main(void)
{
    comments();
    lists();
    types();
    geometry();
    places();
    written(true);
    written(false);
    refused_nrrd();
    refused_meta();
    beside();
    real();
    return done_testing();
}
