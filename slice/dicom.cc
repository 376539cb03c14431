#include "slice/dicom.h"

extern "C" {
#include "slice/dicom_lengths.h"
}

#include "dcmtk/config/osconfig.h"

#include "dcmtk/dcmdata/dcistrmb.h"
#include "dcmtk/dcmdata/dcrledrg.h"
#include "dcmtk/dcmdata/dctk.h"
#include "dcmtk/dcmjpeg/djdecode.h"
#include "dcmtk/dcmjpls/djdecode.h"

#include <climits>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>
#include <pthread.h>

/* No exception may leave this file, and none is thrown in it but for want of memory. */
namespace
{

/* Philips' cartesian volumes: their class, frames of a volume, and mm (cm) between them. */
const char *const PHILIPS_VOLUME = "1.2.840.113543.6.6.1.3.10002";
const DcmTagKey PHILIPS_DEPTH(0x3001, 0x1001), PHILIPS_DELTA_Z(0x3001, 0x1003);

enum { CENTIMETRES = 3, FEW_ITEMS = 500, MOST_ITEMS = 100000 };

/* Of a thread that reads many items: DCMTK goes down into items that lie in items by recursion, and takes less than 2 KB for
 * each. Only what is used of it becomes memory. */
const size_t STACK = size_t(256) << 20;

struct reading {
    dicom_image *d;
    DcmDataset *set;
    const char *name;
    size_t size; /* of the file */
    dicom_elements *seen;
    err *e;
};

int refuse(const reading &r, const char *what, const char *expected)
{
    return err_set(r.e, r.name, 0, "%s; expected %s", what, expected);
}

/* ---- elements by tag; what is used is noted */

void use(const reading &r, const DcmTagKey &k)
{
    if (r.seen)
        dicom_elements_use(r.seen, k.getGroup(), k.getElement());
}

/* Up to `most` numbers of an element: how many there are, 0 where there is no such element. */
int numbers(const reading &r, DcmItem *item, const DcmTagKey &k, double *to, int most)
{
    int count = 0;
    DcmElement *element = nullptr;
    if (!item || item->findAndGetElement(k, element).bad() || !element)
        return 0;
    for (; count < most; count++) {
        OFString text;
        Float64 value = 0;
        if (element->getFloat64(value, static_cast<unsigned long>(count)).bad()) {
            Sint32 whole = 0;
            Uint16 small = 0;
            if (element->getSint32(whole, static_cast<unsigned long>(count)).good())
                value = whole;
            else if (element->getUint16(small, static_cast<unsigned long>(count)).good())
                value = small;
            else if (element->getOFString(text, static_cast<unsigned long>(count)).good() && !text.empty()) {
                OFBool good = OFFalse;
                value = OFStandard::atof(text.c_str(), &good);
                if (!good)
                    break;
            } else
                break;
        }
        if (!std::isfinite(value))
            break;
        to[count] = value;
    }
    if (count)
        use(r, k);
    return count;
}

double number(const reading &r, DcmItem *item, const DcmTagKey &k, double otherwise)
{
    double value;
    return numbers(r, item, k, &value, 1) == 1 ? value : otherwise;
}

OFString text(const reading &r, const DcmTagKey &k)
{
    OFString value;
    if (r.set->findAndGetOFString(k, value).good())
        use(r, k);
    return value;
}

DcmItem *inner(const reading &r, DcmItem *item, const DcmTagKey &k, long at = 0)
{
    DcmItem *found = nullptr;
    if (!item || item->findAndGetSequenceItem(k, found, at).bad())
        return nullptr;
    use(r, k);
    return found;
}

/* ---- the list of elements */

dicom_element element_of(DcmObject *object)
{
    dicom_element what = dicom_element();
    DcmTag tag = object->getTag();
    what.group = tag.getGroup();
    what.element = tag.getElement();
    std::strncpy(what.name, what.group % 2 ? "private" : tag.getTagName(), sizeof what.name - 1);
    return what;
}

/* Every element once a file, those of nested items too. */
int note_all(const reading &r)
{
    dicom_elements here = dicom_elements();
    DcmStack stack;
    int code = 0;
    while (!code && r.set->nextObject(stack, OFTrue).good()) {
        DcmObject *object = stack.top();
        dicom_element what = element_of(object);
        if (object->ident() != EVR_item && object->ident() != EVR_pixelItem)
            code = dicom_elements_note(&here, &what, r.e);
    }
    for (int64_t i = 0; !code && i < here.count; i++)
        code = dicom_elements_note(r.seen, &here.one[i], r.e);
    dicom_elements_free(&here);
    return code;
}

/* ---- geometry */

int set_axes(const reading &r, const double o[6])
{
    double length[2] = {0, 0}, dot = 0;
    for (int i = 0; i < 3; i++) {
        length[0] += o[i] * o[i];
        length[1] += o[3 + i] * o[3 + i];
        dot += o[i] * o[3 + i];
    }
    if (!(std::fabs(length[0] - 1) < .01 && std::fabs(length[1] - 1) < .01 && std::fabs(dot) < .01))
        return refuse(r, "an orientation of rows and columns that is none", "two unit vectors at a right angle");
    for (int i = 0; i < 3; i++) {
        r.d->along_row[i] = o[i] / std::sqrt(length[0]);
        r.d->along_column[i] = o[3 + i] / std::sqrt(length[1]);
    }
    return 0;
}

/* PixelSpacing is between rows, then between columns. */
void set_spacing(const reading &r, DcmItem *item)
{
    double s[2];
    if (numbers(r, item, DCM_PixelSpacing, s, 2) == 2) {
        r.d->spacing[0] = s[1];
        r.d->spacing[1] = s[0];
    }
    double between = number(r, item, DCM_SpacingBetweenSlices, NAN);
    if (std::isfinite(between))
        r.d->spacing[2] = std::fabs(between);
}

/* Pixels of ultrasound regions, in cm. */
void set_region_spacing(const reading &r, DcmItem *item)
{
    double dx = number(r, item, DCM_PhysicalDeltaX, NAN), dy = number(r, item, DCM_PhysicalDeltaY, NAN);
    double ux = number(r, item, DCM_PhysicalUnitsXDirection, 0), uy = number(r, item, DCM_PhysicalUnitsYDirection, 0);
    if (int(ux) == CENTIMETRES && int(uy) == CENTIMETRES && !std::isfinite(r.d->spacing[0])) {
        r.d->spacing[0] = 10 * std::fabs(dx);
        r.d->spacing[1] = 10 * std::fabs(dy);
    }
}

int read_plain_geometry(const reading &r)
{
    double p[3], o[6];
    dicom_image *d = r.d;
    set_spacing(r, r.set);
    set_region_spacing(r, r.set);
    set_region_spacing(r, inner(r, r.set, DCM_SequenceOfUltrasoundRegions));
    if (numbers(r, r.set, DCM_ImageOrientationPatient, o, 6) == 6 && set_axes(r, o))
        return -1;
    if (numbers(r, r.set, DCM_ImagePositionPatient, p, 3) == 3) {
        d->placed = d->frames == 1;
        std::memcpy(d->position, p, sizeof p);
    }
    return 0;
}

/* The frame's own functional groups go before those that all frames share. */
DcmItem *group_of(const reading &r, DcmItem *frame, DcmItem *shared, const DcmTagKey &k)
{
    DcmItem *own = inner(r, frame, k);
    return own ? own : inner(r, shared, k);
}

double time_of(const reading &r, DcmItem *frame, DcmItem *shared)
{
    double time =
        number(r, group_of(r, frame, shared, DCM_TemporalPositionSequence), DCM_TemporalPositionTimeOffset, NAN);
    if (!std::isfinite(time))
        time = number(r, group_of(r, frame, shared, DCM_FrameContentSequence), DCM_TemporalPositionIndex, 0);
    return time;
}

int read_frame_groups(const reading &r, DcmItem *frame, DcmItem *shared, int64_t at, double first[6])
{
    dicom_image *d = r.d;
    double o[6];
    DcmItem *place = group_of(r, frame, shared, DCM_PlanePositionVolumeSequence);
    DcmItem *turn = group_of(r, frame, shared, DCM_PlaneOrientationVolumeSequence);
    DcmTagKey position = DCM_ImagePositionVolume, orientation = DCM_ImageOrientationVolume;
    d->own_frame = place != nullptr;
    if (!place) {
        place = group_of(r, frame, shared, DCM_PlanePositionSequence);
        position = DCM_ImagePositionPatient;
    }
    if (!turn) {
        turn = group_of(r, frame, shared, DCM_PlaneOrientationSequence);
        orientation = DCM_ImageOrientationPatient;
    }
    if (numbers(r, place, position, d->position + 3 * at, 3) != 3)
        return err_set(r.e, r.name, 0, "frame %lld has no position; expected one in its functional groups",
                       (long long)at + 1);
    if (numbers(r, turn, orientation, o, 6) != 6)
        return err_set(r.e, r.name, 0, "frame %lld has no orientation; expected one in its functional groups",
                       (long long)at + 1);
    for (int i = 0; at && i < 6; i++)
        if (std::fabs(o[i] - first[i]) > 1e-4)
            return err_set(r.e, r.name, 0, "frame %lld is turned against frame 1; expected parallel frames",
                           (long long)at + 1);
    d->time[at] = time_of(r, frame, shared);
    if (at)
        return 0;
    std::memcpy(first, o, sizeof o);
    set_spacing(r, group_of(r, frame, shared, DCM_PixelMeasuresSequence));
    DcmItem *values = group_of(r, frame, shared, DCM_PixelValueTransformationSequence);
    d->slope = number(r, values, DCM_RescaleSlope, d->slope);
    d->intercept = number(r, values, DCM_RescaleIntercept, d->intercept);
    return set_axes(r, o);
}

int read_functional_groups(const reading &r)
{
    double first[6] = {0, 0, 0, 0, 0, 0};
    DcmItem *shared = inner(r, r.set, DCM_SharedFunctionalGroupsSequence);
    for (int64_t at = 0; at < r.d->frames; at++)
        if (read_frame_groups(r, inner(r, r.set, DCM_PerFrameFunctionalGroupsSequence, long(at)), shared, at, first))
            return -1;
    r.d->placed = true;
    return 0;
}

/* A volume in time of which NumberOfFrames counts the times, and private elements the planes. */
int read_philips_geometry(const reading &r)
{
    dicom_image *d = r.d;
    double depth = number(r, r.set, PHILIPS_DEPTH, 0), between = number(r, r.set, PHILIPS_DELTA_Z, NAN);
    if (!(depth >= 1 && depth <= 65535) || !std::isfinite(between))
        return refuse(r, "a Philips volume without the private elements of its depth", "(3001,1001) and (3001,1003)");
    int64_t planes = int64_t(depth), times = d->frames;
    DcmElement *pixels = nullptr;
    if (r.set->findAndGetElement(DCM_PixelData, pixels).bad() ||
        depth * double(times * d->rows * d->columns) > double(pixels->getLength()))
        return refuse(r, "fewer pixels than the planes of its depth need", "frames x planes x rows x columns of them");
    d->frames *= planes;
    void *position = std::realloc(d->position, size_t(3 * d->frames) * sizeof *d->position);
    if (position)
        d->position = static_cast<double *>(position);
    void *time = std::realloc(d->time, size_t(d->frames) * sizeof *d->time);
    if (time)
        d->time = static_cast<double *>(time);
    if (!position || !time)
        return err_memory(r.e, "frames");
    set_spacing(r, r.set);
    set_region_spacing(r, r.set);
    set_region_spacing(r, inner(r, r.set, DCM_SequenceOfUltrasoundRegions));
    d->spacing[2] = 10 * std::fabs(between);
    for (int64_t f = 0; f < planes * times; f++) {
        d->time[f] = double(f / planes);
        d->position[3 * f] = d->position[3 * f + 1] = 0;
        d->position[3 * f + 2] = d->spacing[2] * double(f % planes);
    }
    d->placed = d->own_frame = d->private_geometry = true;
    return 0;
}

int read_geometry(const reading &r)
{
    dicom_image *d = r.d;
    d->position = static_cast<double *>(std::malloc(size_t(3 * d->frames) * sizeof *d->position));
    d->time = static_cast<double *>(std::calloc(size_t(d->frames), sizeof *d->time));
    if (!d->position || !d->time)
        return err_memory(r.e, "frames");
    for (int64_t i = 0; i < 3 * d->frames; i++)
        d->position[i] = NAN;
    d->along_row[0] = d->along_column[1] = 1;
    d->slope = number(r, r.set, DCM_RescaleSlope, 1);
    d->intercept = number(r, r.set, DCM_RescaleIntercept, 0);
    if (r.set->tagExists(DCM_PerFrameFunctionalGroupsSequence))
        return read_functional_groups(r);
    if (text(r, DCM_SOPClassUID) == PHILIPS_VOLUME ||
        (r.set->tagExists(PHILIPS_DEPTH) && r.set->tagExists(PHILIPS_DELTA_Z)))
        return read_philips_geometry(r);
    return read_plain_geometry(r);
}

/* ---- pixels */

/* Red, green and blue to how bright they are (ITU-R BT.601, as YBR_FULL has it). */
void to_grey(const unsigned char *from, int64_t pixels, int64_t plane, bool luminance, unsigned char *to)
{
    int64_t across = plane ? 1 : 3, along = plane ? plane : 1;
    for (int64_t i = 0; i < pixels; i++) {
        const unsigned char *p = plane ? from + i / plane * 3 * plane + i % plane : from + i * across;
        to[i] = luminance ? p[0] : (unsigned char)((299 * p[0] + 587 * p[along] + 114 * p[2 * along] + 500) / 1000);
    }
}

/* Samples whose bits end below the top ones are moved down and their sign is spread. */
void to_whole(dicom_image *d, int64_t samples, int stored, int high, bool inverted)
{
    int bits = 8 * d->bytes, low = high + 1 - stored;
    for (int64_t i = 0; i < samples; i++) {
        uint32_t value = d->bytes == 1 ? d->pixels[i] : uint32_t(d->pixels[2 * i] | d->pixels[2 * i + 1] << 8);
        value = value >> low & ((1U << stored) - 1);
        if (inverted)
            value = d->negative ? ~value : ((1U << stored) - 1) - value;
        if (d->negative && (value >> (stored - 1) & 1) && stored < bits)
            value |= ~0U << stored;
        d->pixels[d->bytes * i] = (unsigned char)value;
        if (d->bytes == 2)
            d->pixels[2 * i + 1] = (unsigned char)(value >> 8);
    }
}

/* The bytes of the pixels, decompressed where they were not, in the data set; NULL with e filled. */
const unsigned char *find_pixels(const reading &r, int bytes, int64_t need)
{
    DcmElement *element = nullptr;
    const Uint8 *small = nullptr;
    const Uint16 *large = nullptr;
    DcmXfer syntax(r.set->getOriginalXfer());
    if (syntax.isEncapsulated() && r.set->chooseRepresentation(EXS_LittleEndianExplicit, nullptr).bad()) {
        err_set(r.e, r.name, 0, "pixels are compressed as %s, or not whole; expected none, RLE, JPEG or JPEG-LS",
                syntax.getXferName());
        return nullptr;
    }
    if (r.set->findAndGetElement(DCM_PixelData, element).bad() || !element)
        refuse(r, "no pixels", "PixelData");
    else if (int64_t(element->getLength()) < need)
        err_set(r.e, r.name, 0, "%lld bytes of pixels; expected %lld", (long long)element->getLength(),
                (long long)need);
    else if (bytes == 1 && r.set->findAndGetUint8Array(DCM_PixelData, small).good() && small)
        return small;
    else if (r.set->findAndGetUint16Array(DCM_PixelData, large).good() && large)
        return reinterpret_cast<const unsigned char *>(large);
    else
        refuse(r, "pixels that cannot be read", "bytes or words");
    return nullptr;
}

int read_pixels(const reading &r)
{
    dicom_image *d = r.d;
    use(r, DCM_PixelData);
    /* decompression may change what follows */
    double samples = number(r, r.set, DCM_SamplesPerPixel, 1), planar = 0;
    double allocated = number(r, r.set, DCM_BitsAllocated, 0), stored = number(r, r.set, DCM_BitsStored, allocated);
    double high = number(r, r.set, DCM_HighBit, stored - 1);
    OFString colour = text(r, DCM_PhotometricInterpretation);
    bool grey = colour == "MONOCHROME1" || colour == "MONOCHROME2";
    if (!grey && colour.compare(0, 3, "RGB") != 0 && colour.compare(0, 3, "YBR") != 0)
        return refuse(r, "pixels of another kind", "MONOCHROME1, MONOCHROME2, RGB or YBR");
    if ((allocated != 8 && allocated != 16) || !(stored >= 1 && stored <= allocated) ||
        !(high >= stored - 1 && high < allocated) || samples != (grey ? 1 : 3) || (!grey && allocated != 8))
        return err_set(r.e, r.name, 0,
                       "%g samples of %g bits a pixel, %g of them used; expected 8 or 16, or 3 samples of 8", samples,
                       allocated, stored);
    d->bytes = int(allocated) / 8;
    d->negative = grey && int(number(r, r.set, DCM_PixelRepresentation, 0)) == 1;
    int64_t plane = d->rows * d->columns, pixels = plane * d->frames;
    const unsigned char *from = find_pixels(r, d->bytes, pixels * d->bytes * int64_t(samples));
    if (!from)
        return -1;
    d->pixels = static_cast<unsigned char *>(std::malloc(size_t(pixels * d->bytes)));
    if (!d->pixels)
        return err_memory(r.e, "pixels");
    if (grey) {
        std::memcpy(d->pixels, from, size_t(pixels * d->bytes));
        if (int(stored) != int(allocated) || colour == "MONOCHROME1")
            to_whole(d, pixels, int(stored), int(high), colour == "MONOCHROME1");
        return 0;
    }
    planar = number(r, r.set, DCM_PlanarConfiguration, 0);
    colour = text(r, DCM_PhotometricInterpretation);
    if (colour == "YBR_FULL_422" || colour == "YBR_PARTIAL_422")
        return refuse(r, "pixels that share their colours (YBR_..._422) without compression", "RGB or YBR_FULL");
    to_grey(from, pixels, int(planar) == 1 ? plane : 0, colour.compare(0, 3, "YBR") == 0, d->pixels);
    return 0;
}

/* ---- the file */

/* Tags of items, in either byte order: a file cannot have more levels of items in items than these. */
int64_t count_items(const unsigned char *bytes, size_t size)
{
    int64_t items = 0;
    const unsigned char *end = bytes + size;
    for (const unsigned char *p = bytes; p + 4 <= end; p++) {
        p = static_cast<const unsigned char *>(std::memchr(p, 0xFE, size_t(end - p)));
        if (!p || p + 4 > end)
            break;
        bool little = p[1] == 0xFF && p[2] == 0 && p[3] == 0xE0;
        bool big = p > bytes && p[-1] == 0xFF && p[1] == 0xE0 && p[2] == 0;
        items += little || big;
    }
    return items;
}

int parse(const reading &r, DcmFileFormat &file, const void *bytes, size_t size)
{
    DcmInputBufferStream stream;
    stream.setBuffer(bytes, offile_off_t(size));
    stream.setEos();
    file.transferInit();
    OFCondition code = file.read(stream, EXS_Unknown, EGL_noChange, DCM_MaxReadLength);
    file.transferEnd();
    if (code.bad())
        return err_set(r.e, r.name, 0, "not whole, or damaged: %s", code.text());
    return 0;
}

int read_image(reading &r)
{
    dicom_image *d = r.d;
    double rows = number(r, r.set, DCM_Rows, 0), columns = number(r, r.set, DCM_Columns, 0);
    double frames = number(r, r.set, DCM_NumberOfFrames, 1);
    if (!(rows >= 1 && columns >= 1))
        return err_set(r.e, r.name, 0, "an image of %g rows and %g columns; expected 1 or more", rows, columns);
    if (!(frames >= 1 && frames <= INT_MAX && frames == std::floor(frames)))
        return err_set(r.e, r.name, 0, "%g frames; expected 1 or more", frames);
    d->rows = int64_t(rows);
    d->columns = int64_t(columns);
    d->frames = int64_t(frames);
    DcmElement *pixels = nullptr;
    /* Before memory is asked for, frame by frame. A compressed frame has its own item, and so at least 8 bytes. */
    if (r.set->findAndGetElement(DCM_PixelData, pixels).bad() || !pixels)
        return refuse(r, "no pixels", "PixelData");
    bool packed = DcmXfer(r.set->getOriginalXfer()).isEncapsulated();
    if (!packed && double(pixels->getLength()) < rows * columns * frames)
        return err_set(r.e, r.name, 0, "%lld bytes of pixels; expected %g or more", (long long)pixels->getLength(),
                       rows * columns * frames);
    /* Flat images shrink a lot, but not without end. */
    if (packed && (frames > MOST_ITEMS || rows * columns * frames > 1000. * double(r.size) + 16e6))
        return err_set(r.e, r.name, 0, "%g frames of %g x %g pixels in %lu bytes; expected fewer", frames, columns,
                       rows, (unsigned long)r.size);
    OFString series = text(r, DCM_SeriesInstanceUID), burned = text(r, DCM_BurnedInAnnotation);
    std::strncpy(d->series, series.c_str(), sizeof d->series - 1);
    d->burned = burned == "YES" ? DICOM_BURNED : burned == "NO" ? DICOM_CLEAN : DICOM_NOT_SAID;
    for (int i = 0; i < 3; i++)
        d->spacing[i] = NAN;
    return read_geometry(r) || read_pixels(r) ? -1 : 0;
}

int read_file(reading &r, const void *bytes, size_t size)
{
    DcmFileFormat file;
    if (parse(r, file, bytes, size))
        return -1;
    r.set = file.getDataset();
    if (!r.set->tagExists(DCM_Rows) && !r.set->tagExists(DCM_PixelData))
        return 1;
    if (r.seen && note_all(r))
        return -1;
    return read_image(r);
}

/* What a thread is given, and what it gives back. */
struct errand {
    reading *r;
    const void *bytes;
    size_t size;
    int code;
};

void *run(void *given)
{
    errand *job = static_cast<errand *>(given);
    try {
        job->code = read_file(*job->r, job->bytes, job->size);
    } catch (const std::bad_alloc &) {
        job->code = err_memory(job->r->e, job->r->name);
    }
    return nullptr;
}

int run_on_large_stack(errand *job)
{
    pthread_t thread;
    pthread_attr_t how;
    int code = pthread_attr_init(&how);
    if (!code) {
        code = pthread_attr_setstacksize(&how, STACK);
        if (!code)
            code = pthread_create(&thread, &how, run, job);
        pthread_attr_destroy(&how);
    }
    if (code)
        return err_system(job->r->e, job->r->name, code, "cannot start a thread to read it");
    pthread_join(thread, nullptr);
    return job->code;
}

void begin()
{
    OFLog::configure(OFLogger::OFF_LOG_LEVEL);
    DcmRLEDecoderRegistration::registerCodecs();
    DJDecoderRegistration::registerCodecs();
    DJLSDecoderRegistration::registerCodecs();
}

/* The one object of the program's life: DCMTK's own registers are such, too. */
bool begun;

} // namespace

bool dicom_is(const void *bytes, size_t size)
{
    return size >= 132 && !std::memcmp(static_cast<const char *>(bytes) + 128, "DICM", 4);
}

int dicom_read(dicom_image *d, const void *bytes, size_t size, const char *name, dicom_elements *seen, err *e)
{
    if (!dicom_is(bytes, size))
        return err_set(e, name, 0, "not a DICOM file; expected DICM after 128 bytes");
    if (dicom_lengths_check(static_cast<const unsigned char *>(bytes), size, name, e))
        return -1;
    if (!begun)
        begin();
    begun = true;
    if (!dcmDataDict.isDictionaryLoaded())
        return err_set(e, nullptr, 0,
                       "DCMTK has no data dictionary; expected its dicom.dic (or DCMDICTPATH to say where it is)");
    reading r = {d, nullptr, name, size, seen, e};
    errand job = {&r, bytes, size, -1};
    int64_t items = count_items(static_cast<const unsigned char *>(bytes), size);
    if (items > MOST_ITEMS)
        return err_set(e, name, 0, "more than %d items; expected fewer", int(MOST_ITEMS));
    if (items > FEW_ITEMS)
        run_on_large_stack(&job);
    else
        run(&job);
    int code = job.code;
    if (code)
        dicom_free(d);
    return code;
}

void dicom_free(dicom_image *d)
{
    std::free(d->position);
    std::free(d->time);
    std::free(d->pixels);
    *d = dicom_image();
}

void dicom_end(void)
{
    if (begun) {
        DcmRLEDecoderRegistration::cleanup();
        DJDecoderRegistration::cleanup();
        DJLSDecoderRegistration::cleanup();
    }
    begun = false;
}
