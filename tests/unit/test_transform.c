/* Files of rigid motions against matrices that are multiplied out here: each kind of file, what it is taken for, PLUS's
 * chains and inverses, ITK's centre and direction; the composition with --body and --marker; and what is refused. */
#include "place/itk.h"
#include "place/transform.h"
#include "volume/placing.h"

#include "any_pose.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

static int read_text(const char *text, const char *frames, transform_use use, pose *to, err *e)
{
    const transform_file f = {"file", text, (int64_t)strlen(text), frames, use};
    return transform_read(&f, to, e);
}

/* What p does to a point of its own, mm, against where that is to be. */
static double apart(const pose *p, const double own[3], const double want[3])
{
    double x[3], most = 0;
    for (int i = 0; i < 3; i++)
        x[i] = own[i] / 1e3;
    pose_apply(p, x, x);
    for (int i = 0; i < 3; i++)
        most = fmax(most, fabs(x[i] * 1e3 - want[i]));
    return most;
}

static void takes_as(const char *name, const char *text, const char *frames, transform_use use, const double own[3],
                     const double want[3])
{
    pose p = pose_none();
    err e = {0};
    const int failed = read_text(text, frames, use, &p, &e);
    const double off = failed ? 1e9 : apart(&p, own, want);
    ok(!failed && off < 1e-9, "%s (%g mm)%s", name, off, e.text);
}

static const double point[3] = {1, 2, 3};

/* (x, y, z) -> (x, -z, y) + (10, 20, 30), in each kind of file. */
static const double there[3] = {11, 17, 32};

static void test_numbers(void)
{
    takes_as("a line of TUM, in m", "# a comment\n5.5 .01 .02 .03 .70710678118654752 0 0 .70710678118654752\n", NULL,
             TRANSFORM_MARKER, point, there);
    takes_as("four rows, in mm", "1 0 0 10\n0 0 -1 20\n0 1 0 30\n0 0 0 1\n", NULL, TRANSFORM_MARKER, point, there);
    takes_as("and for a body", "1 0 0 10\n0 0 -1 20\n0 1 0 30\n0 0 0 1\n", NULL, TRANSFORM_BODY, point, there);
    takes_as("sixteen on one line", "1 0 0 10 0 0 -1 20 0 1 0 30 0 0 0 1", NULL, TRANSFORM_MARKER, point, there);
    takes_as("in LPS, as without the word", "LPS\n1 0 0 10\n0 0 -1 20\n0 1 0 30\n0 0 0 1\n", NULL, TRANSFORM_BODY,
             point, there);
    /* (-1 -2 3) -> (-1 -3 -2) + (10 20 30) = (9 17 28) -> (-9 -17 28) */
    takes_as("in RAS: both sides turn", "RAS\n1 0 0 10\n0 0 -1 20\n0 1 0 30\n0 0 0 1\n", NULL, TRANSFORM_BODY, point,
             (const double[3]){-9, -17, 28});
}

static void test_itk(void)
{
    /* The inverse of the motion above: (x y z) -> (x - 10, z - 30, 20 - y). */
    static const char plain[] = "#Insight Transform File V1.0\n#Transform 0\nTransform: AffineTransform_double_3_3\n"
                                "Parameters: 1 0 0 0 0 1 0 -1 0 -10 -30 20\nFixedParameters: 0 0 0\n";
    takes_as("ITK's file is the inverse of the motion, in LPS", plain, NULL, TRANSFORM_BODY, point, there);
    /* What Slicer shows has the signs of x and y turned on both sides, as above. */
    takes_as("for a marker it is as Slicer shows it", plain, NULL, TRANSFORM_MARKER, point,
             (const double[3]){-9, -17, 28});
    /* A (x - c) + t + c with c = (1 2 3): A c = (1 3 -2), so t = t0 - c + A c = (-10 -29 15). */
    takes_as("its centre is taken in",
             "#Insight Transform File V1.0\r\nTransform: MatrixOffsetTransformBase_float_3_3\r\n"
             "Parameters: 1 0 0 0 0 1 0 -1 0 -10 -29 15\r\nFixedParameters: 1 2 3\r\n",
             NULL, TRANSFORM_BODY, point, there);
    double worst = 0;
    for (int i = 0; i < 50; i++) {
        const transform_use use = i % 2 ? TRANSFORM_MARKER : TRANSFORM_BODY;
        const pose p = any_pose();
        pose back = pose_none();
        err e = {0};
        out *o = out_memory(&e);
        size_t size;
        itk_write(&p, use, o);
        const transform_file f = {"file", (const char *)out_bytes(o, &size), 0, NULL, use};
        char *copy = calloc(size + 1, 1);
        transform_file g = f;
        memcpy(copy, f.bytes, size);
        g.bytes = copy;
        g.size = (int64_t)size;
        worst = transform_read(&g, &back, &e) ? 1e9 : worst;
        const pose none = pose_relative(&p, &back);
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fmax(fabs(none.position[k]), fabs(none.quaternion[k])));
        free(copy);
        out_discard(o);
    }
    ok(worst < 1e-14, "what is written is read as it was (%g)", worst);
}

#define PLUS(transforms)                                                                                               \
    "<?xml version=\"1.0\"?>\n<PlusConfiguration version=\"2.9\">\n <DataCollection>\n"                                \
    "  <Transform From=\"A\" To=\"B\"/>\n </DataCollection>\n <!-- <Transform/> -->\n "                                \
    "<CoordinateDefinitions>\n" transforms " </CoordinateDefinitions>\n</PlusConfiguration>\n"
#define LINK(from, to, matrix)                                                                                         \
    "  <Transform From=\"" from "\" To=\"" to "\" Matrix=\"\n    " matrix "\" Date=\"2026\" />\n"
#define MOTION "1 0 0 10\n  0 0 -1 20\n  0 1 0 30\n  0 0 0 1"
#define MOVE   "1 0 0 100 0 1 0 200 0 0 1 300 0 0 0 1"

/* Pixels of 0.1 mm by 0.2 mm; the middle of the array is at (256, 5). The image stands in the marker's frame so that
 * its columns go along y and its rows along -z, and its first pixel is at (1 2 3) mm. */
#define IMAGES                                                                                                         \
    LINK("Image", "TransducerOriginPixel", "1 0 0 -256 0 1 0 -5 0 0 1 0 0 0 0 1")                                      \
    LINK("TransducerOriginPixel", "TransducerOrigin", ".1 0 0 0 0 .2 0 0 0 0 .2 0 0 0 0 1")                            \
    LINK("Image", "Probe", "0 0 -.1 1 .1 0 0 2 0 -.2 0 3 0 0 0 1")

static void test_plus(void)
{
    static const char one[] = PLUS(LINK("Probe", "ProbeMarker", MOTION));
    takes_as("the one that there is", one, NULL, TRANSFORM_MARKER, point, there);
    takes_as("by its name", one, "ProbeToProbeMarker", TRANSFORM_MARKER, point, there);
    takes_as("the other way round, its inverse", PLUS(LINK("ProbeMarker", "Probe", MOTION)), NULL, TRANSFORM_MARKER,
             there, point);
    takes_as("for a body, by its name", PLUS(LINK("Model", "Reference", MOTION)), "ModelToReference", TRANSFORM_BODY,
             point, there);
    /* Model -> Stand by MOTION, then Stand -> Reference by the inverse of MOVE. */
    takes_as("a chain", PLUS(LINK("Reference", "Stand", MOVE) LINK("Model", "Stand", MOTION)), "ModelToReference",
             TRANSFORM_BODY, point, (const double[3]){-89, -183, -268});
    /* The middle is at (1, 2 + 25.6, 3 - 1); the face's x goes along y, its z along -z, its y then along x: z x x. */
    takes_as("the middle of the array, as a probe's frame: its origin", PLUS(IMAGES), NULL, TRANSFORM_MARKER,
             (const double[3]){0, 0, 0}, (const double[3]){1, 27.6, 2});
    takes_as("its axes, without the size of pixels", PLUS(IMAGES), NULL, TRANSFORM_MARKER, point,
             (const double[3]){1 + 2, 27.6 + 1, 2 - 3});
}

static void refuses(const char *name, const char *text, const char *frames, transform_use use, const char *said)
{
    pose p = pose_none();
    err e = {0};
    ok(read_text(text, frames, use, &p, &e) == -1 && e.status == 1 && strstr(e.text, said), "%s: %s", name, e.text);
}

static void test_refused(void)
{
    const transform_use m = TRANSFORM_MARKER, b = TRANSFORM_BODY;
    refuses("nothing", "", NULL, m, "is empty; expected a line time");
    refuses("words", "surface skin.obj unit=mm\n", NULL, m, "is none of these");
    refuses("seven numbers", "0 0 0 0 0 0 1\n", NULL, m, "file:1: 7 words");
    refuses("two poses", "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", NULL, m, "file:2: a second line");
    refuses("no unit quaternion", "0 0 0 0 0 0 0 2\n", NULL, m, "file:1: a quaternion of length 2");
    refuses("three rows", "1 0 0 0\n0 1 0 0\n0 0 1 0\n", NULL, m, "file: 12 numbers");
    refuses("five rows", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n0 0 0 1\n", NULL, m, "file:5: 4 words on line 5");
    refuses("no number", "1 0 0 0\n0 1 x 0\n0 0 1 0\n0 0 0 1\n", NULL, m, "file:2: 'x' is not a finite number");
    refuses("scale", "2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n", NULL, m, "lengths 2, 2 and 2");
    refuses("metres told as a last row", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1000\n", NULL, m, "last row is 0 0 0 1000");
    refuses("a space after the matrix", "1 0 0 0\nRAS\n", NULL, b, "file:2: 'RAS' after other lines");
    refuses("names of a matrix", "1 0 0 0\n", "AToB", m, "has no transforms with names, such as AToB");
    refuses("HDF5", "\x89HDF\r\n\x1a\n\x02", NULL, b, "save the transform as .tfm");
#define ITK(type, rest) "#Insight Transform File V1.0\nTransform: " type "\n" rest
    refuses("a spline", ITK("BSplineTransform_double_3_3", ""), NULL, m,
            "file:2: BSplineTransform_double_3_3; expected A");
    refuses("of two dimensions", ITK("AffineTransform_double_2_2", ""), NULL, m, "file:2: AffineTransform_double_2_2");
    refuses("without a centre", ITK("AffineTransform_double_3_3", "Parameters: 1 0 0 0 1 0 0 0 1 0 0 0\n"), NULL, m,
            "ends without FixedParameters:");
    refuses("eleven numbers", ITK("AffineTransform_double_3_3", "Parameters: 1 0 0 0 1 0 0 0 1 0 0\n"), NULL, m,
            "file:3: Parameters; expected 12 finite numbers");
    refuses("two transforms", ITK("AffineTransform_double_3_3", "#\nTransform: AffineTransform_double_3_3\n"), NULL, m,
            "file:4: a second transform");
    refuses("shear", ITK("AffineTransform_double_3_3", "Parameters: 1 .6 0 0 .8 0 0 0 1 0 0 0\nFixedParameters: 0 0 0"),
            NULL, m, "a matrix with shear: the cosine between two of its columns is 0.6");
    refuses("XML of another kind", "<a><b/></a>", NULL, m, "has no <CoordinateDefinitions>");
    refuses("no end of a tag", "<PlusConfiguration><CoordinateDefinitions", NULL, m, "malformed tag");
    refuses("neither face nor marker", PLUS(LINK("A", "B", MOTION)), NULL, m, "expected FILE:FROMToTO");
    refuses("it says what there is", PLUS(LINK("A", "B", MOTION) LINK("C", "B", MOTION)), NULL, m, "has: AToB, CToB");
    refuses("both", PLUS(IMAGES LINK("Probe", "ProbeMarker", MOTION)), NULL, m, "leads both from TransducerOrigin");
    refuses("a body without a name", PLUS(LINK("Model", "Reference", MOTION)), NULL, b, "as :ModelToReference");
    refuses("not linked", PLUS(LINK("A", "B", MOTION)), "AToC", b, "does not say where A is in C");
    refuses("an image", PLUS(IMAGES), "ImageToProbe", m, "expected TransducerOriginToProbe");
    refuses("scale by its name", PLUS(LINK("A", "B", "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1")), "AToB", b,
            "AToB: a matrix with scale");
    refuses("twice", PLUS(LINK("A", "B", MOTION) LINK("A", "B", MOVE)), "AToB", b, "file:13: a Transform whose From");
    refuses("fifteen numbers", PLUS(LINK("A", "B", "1 2 3")), "AToB", b, "file:8: a Transform's Matrix");
    refuses("no name", PLUS("<Transform To=\"B\" Matrix=\"" MOVE "\"/>"), "AToB", b, "a Transform's From");
}

static void test_paths(void)
{
    static const struct {
        const char *path, *file, *frames;
    } list[] = {{"a.xml:ProbeToProbeMarker", "a.xml", "ProbeToProbeMarker"},
                {"d:/b/a.xml", "d:/b/a.xml", NULL},
                {"ProbeToB", "ProbeToB", NULL},
                {"x:y.ProbeToB", "x:y.ProbeToB", NULL},
                {"a:b", "a:b", NULL}};
    for (int i = 0; i < 5; i++) {
        err e = {0};
        const char *frames;
        char *file = transform_path(list[i].path, &frames, &e);
        ok(file && !strcmp(file, list[i].file) &&
               (frames ? list[i].frames && !strcmp(frames, list[i].frames) : !list[i].frames),
           "%s", list[i].path);
        free(file);
    }
}

/* body^-1 o pose o marker, against matrices. */
static void test_placing(void)
{
    double worst = 0;
    for (int i = 0; i < 100; i++) {
        const pose came = any_pose(), around = any_pose(), marker = any_pose();
        const placing p = {true, true, around, marker}, none = {.has_body = false};
        const pose face = placing_of(&p, &came), same = placing_of(&none, &came);
        const double own[3] = {any(), any(), any()};
        double a[3], x[3];
        pose_apply(&face, own, a);
        pose_apply(&around, a, a);
        pose_apply(&marker, own, x);
        pose_apply(&came, x, x);
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs(a[k] - x[k]));
        if (memcmp(&same, &came, sizeof same) != 0)
            worst = 1e9;
    }
    ok(worst < 1e-14, "the face in the model, through the body, is the face on the marker that came (%g)", worst);
}

int main(void)
{
    test_numbers();
    test_itk();
    test_plus();
    test_refused();
    test_paths();
    test_placing();
    return done_testing();
}
