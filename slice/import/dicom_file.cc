#include "slice/import/dicom_file.h"

#include "dcmtk/config/osconfig.h"

#include "dcmtk/dcmdata/dcistrmb.h"
#include "dcmtk/dcmdata/dcpixel.h"
#include "dcmtk/dcmdata/dcpixseq.h"
#include "dcmtk/dcmdata/dcpxitem.h"
#include "dcmtk/dcmdata/dcrledrg.h"
#include "dcmtk/dcmdata/dctk.h"
#include "dcmtk/dcmjpeg/djdecode.h"
#include "dcmtk/dcmjpls/djdecode.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>
#include <pthread.h>

extern "C" {
#include "slice/import/dicom_lengths.h"
}

/* No exception may leave this file, and none is thrown in it but for want of memory. */

/* DCMTK asks for as many bytes as an element claims to have, up to 4 GiB, before it looks whether they are there,
 * and takes no limit; where the data set begins, and how it is written, it guesses in more ways than can be
 * checked before. So C++'s allocation is replaced, which the language provides for: a thread's requests past its
 * limit fail as if memory were at its end. */
namespace
{
thread_local size_t most_at_once = SIZE_MAX;

void *allocate(size_t size) noexcept
{
    if (size > most_at_once)
        return nullptr;
    return std::malloc(size ? size : 1);
}

void *allocate_or_throw(size_t size)
{
    void *p = allocate(size);
    if (!p)
        throw std::bad_alloc();
    return p;
}
} // namespace

void *operator new(size_t size)
{
    return allocate_or_throw(size);
}

void *operator new[](size_t size)
{
    return allocate_or_throw(size);
}

void *operator new(size_t size, const std::nothrow_t &) noexcept
{
    return allocate(size);
}

void *operator new[](size_t size, const std::nothrow_t &) noexcept
{
    return allocate(size);
}

void operator delete(void *p) noexcept
{
    std::free(p);
}

void operator delete[](void *p) noexcept
{
    std::free(p);
}

void operator delete(void *p, size_t) noexcept
{
    std::free(p);
}

void operator delete[](void *p, size_t) noexcept
{
    std::free(p);
}

void operator delete(void *p, const std::nothrow_t &) noexcept
{
    std::free(p);
}

void operator delete[](void *p, const std::nothrow_t &) noexcept
{
    std::free(p);
}

struct dicom_file {
    DcmDataset *set;
    const char *name;
    size_t size;
    dicom_elements *seen;
    int64_t piece_at; /* the last that was asked for: finding one by its number takes as
                   * long as there are others before it */
    DcmObject *piece;
};

namespace
{

enum { FEW_ITEMS = 500, MOST_ITEMS = 100000 };

/* Of a thread that reads many items: DCMTK goes down into items that lie in items by recursion, and takes less than 2
 * KB for each. Only what is used of it becomes memory. */
const size_t STACK = size_t(256) << 20;

DcmTagKey key_of(uint32_t tag)
{
    return DcmTagKey(Uint16(tag >> 16), Uint16(tag & 0xFFFF));
}

void use(const dicom_file *f, uint32_t tag)
{
    if (f->seen)
        dicom_elements_use(f->seen, uint16_t(tag >> 16), uint16_t(tag & 0xFFFF));
}

DcmItem *item_of(dicom_item *item)
{
    return reinterpret_cast<DcmItem *>(item);
}

/* A number of an element, whichever way it is written. (DCMTK reads 1.5 as 1 where text should be whole.) */
bool number_at(DcmElement *element, unsigned long at, double *value)
{
    OFString text;
    Float64 real = 0;
    Sint32 whole = 0;
    Uint16 small = 0;
    OFBool good = OFTrue;
    bool written = element->ident() == EVR_IS || element->ident() == EVR_DS;
    if (!written && element->getFloat64(real, at).good())
        *value = real;
    else if (!written && element->getSint32(whole, at).good())
        *value = whole;
    else if (!written && element->getUint16(small, at).good())
        *value = small;
    else if (element->getOFString(text, at).good() && !text.empty())
        *value = OFStandard::atof(text.c_str(), &good);
    else
        return false;
    return good && std::isfinite(*value);
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
int note_all(const dicom_file *f, err *e)
{
    dicom_elements here = dicom_elements();
    DcmStack stack;
    int code = 0;
    while (!code && f->set->nextObject(stack, OFTrue).good()) {
        DcmObject *object = stack.top();
        dicom_element what = element_of(object);
        if (object->ident() != EVR_item && object->ident() != EVR_pixelItem)
            code = dicom_elements_note(&here, &what, e);
    }
    for (int64_t i = 0; !code && i < here.count; i++)
        code = dicom_elements_note(f->seen, &here.one[i], e);
    dicom_elements_free(&here);
    return code;
}

/* ---- the file */

/* What DCMTK may ask for at once while it reads: no value is longer than its file, whatever it claims. */
size_t room_to_read(size_t size)
{
    return 2 * size + (size_t(4) << 20);
}

/* What a thread is given, and what it gives back. */
struct errand {
    dicom_file *f;
    const unsigned char *bytes;
    void *to;
    err *e;
    int code;
};

int read_file(const errand *job)
{
    DcmFileFormat file;
    DcmInputBufferStream stream;
    dicom_file *f = job->f;
    stream.setBuffer(job->bytes, offile_off_t(f->size));
    stream.setEos();
    file.transferInit();
    most_at_once = room_to_read(f->size);
    OFCondition code = file.read(stream, EXS_Unknown, EGL_noChange, DCM_MaxReadLength);
    most_at_once = SIZE_MAX;
    file.transferEnd();
    if (code.bad())
        return err_set(job->e, f->name, 0, "not whole, or damaged: %s", code.text());
    f->set = file.getDataset();
    OFString syntax;
    if (file.getMetaInfo()->findAndGetOFString(DCM_TransferSyntaxUID, syntax).good() &&
        DcmXfer(syntax.c_str()).getXfer() == EXS_Unknown)
        return err_set(
            job->e, f->name, 0,
            "transfer syntax '%.64s'; expected pixels that are uncompressed, RLE, JPEG, JPEG-LS or JPEG 2000",
            syntax.c_str());
    if (f->seen && note_all(f, job->e))
        return -1;
    return dicom_file_take(f, job->to, job->e);
}

/* The one object of the program's life: DCMTK's own registers are such, too. */
bool begun;

/* What DCMTK takes for its dictionary and registers, and more: it does not look whether it got it. */
const size_t ROOM = size_t(32) << 20;

bool has_room(err *e)
{
    void *room = std::malloc(ROOM);
    if (!room)
        err_memory(e, "DCMTK's data dictionary");
    std::free(room);
    return room;
}

int begin(err *e)
{
    if (!begun && !has_room(e))
        return -1;
    if (!begun) {
        OFLog::configure(OFLogger::OFF_LOG_LEVEL);
        DcmRLEDecoderRegistration::registerCodecs();
        DJDecoderRegistration::registerCodecs();
        DJLSDecoderRegistration::registerCodecs();
    }
    begun = true;
    if (dcmDataDict.isDictionaryLoaded())
        return 0;
    return err_set(e, nullptr, 0,
                   "DCMTK has no data dictionary; expected its dicom.dic (or DCMDICTPATH to say where it is)");
}

void *run(void *given)
{
    errand *job = static_cast<errand *>(given);
    try {
        job->code = begin(job->e) ? -1 : read_file(job);
    } catch (const std::bad_alloc &) {
        job->code = err_memory(job->e, job->f->name);
    }
    most_at_once = SIZE_MAX;
    return nullptr;
}

void run_on_large_stack(errand *job)
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
        job->code = err_system(job->e, job->f->name, code, "cannot start a thread to read it");
    else
        pthread_join(thread, nullptr);
}

DcmPixelSequence *pieces_of(dicom_file *f)
{
    DcmElement *element = nullptr;
    DcmPixelSequence *items = nullptr;
    if (f->set->findAndGetElement(DCM_PixelData, element).bad() || !element || element->ident() != EVR_PixelData ||
        static_cast<DcmPixelData *>(element)
            ->getEncapsulatedRepresentation(f->set->getOriginalXfer(), nullptr, items)
            .bad())
        return nullptr;
    return items;
}

} // namespace

int dicom_file_read(const unsigned char *bytes, size_t size, const char *name, dicom_elements *seen, void *to, err *e)
{
    dicom_file f = {nullptr, name, size, seen, -1, nullptr};
    errand job = {&f, bytes, to, e, -1};
    int64_t items = dicom_lengths_items(bytes, size);
    if (dicom_lengths_check(bytes, size, name, e))
        return -1;
    if (items > MOST_ITEMS)
        return err_set(e, name, 0, "more than %d items; expected fewer", int(MOST_ITEMS));
    if (items > FEW_ITEMS)
        run_on_large_stack(&job);
    else
        run(&job);
    return job.code;
}

void dicom_file_end(void)
{
    if (begun) {
        DcmRLEDecoderRegistration::cleanup();
        DJDecoderRegistration::cleanup();
        DJLSDecoderRegistration::cleanup();
    }
    begun = false;
}

const char *dicom_file_name(const dicom_file *f)
{
    return f->name;
}

size_t dicom_file_size(const dicom_file *f)
{
    return f->size;
}

dicom_item *dicom_file_set(dicom_file *f)
{
    return reinterpret_cast<dicom_item *>(static_cast<DcmItem *>(f->set));
}

/* ---- elements */

bool dicom_has(dicom_file *f, uint32_t tag)
{
    return f->set->tagExists(key_of(tag));
}

int dicom_numbers(dicom_file *f, dicom_item *item, uint32_t tag, double *to, int most)
{
    int count = 0;
    DcmElement *element = nullptr;
    if (!item || item_of(item)->findAndGetElement(key_of(tag), element).bad() || !element)
        return 0;
    while (count < most && number_at(element, static_cast<unsigned long>(count), &to[count]))
        count++;
    if (count)
        use(f, tag);
    return count;
}

void dicom_text(dicom_file *f, dicom_item *item, uint32_t tag, char *to, size_t size)
{
    OFString value;
    *to = '\0';
    if (!item || item_of(item)->findAndGetOFString(key_of(tag), value).bad())
        return;
    use(f, tag);
    std::strncat(to, value.c_str(), size - 1);
}

dicom_item *dicom_inner(dicom_file *f, dicom_item *item, uint32_t tag, int64_t at)
{
    DcmItem *found = nullptr;
    if (!item || item_of(item)->findAndGetSequenceItem(key_of(tag), found, long(at)).bad() || !found)
        return nullptr;
    use(f, tag);
    return reinterpret_cast<dicom_item *>(found);
}

int64_t dicom_words(dicom_file *f, uint32_t tag, const uint16_t **words)
{
    unsigned long count = 0;
    if (f->set->findAndGetUint16Array(key_of(tag), *words, &count).bad() || !*words)
        return 0;
    use(f, tag);
    return int64_t(count);
}

/* ---- pixels */

dicom_packing dicom_file_packing(dicom_file *f, const char **name)
{
    DcmXfer syntax(f->set->getOriginalXfer());
    if (name)
        *name = syntax.getXferName();
    if (!syntax.isEncapsulated())
        return DICOM_PLAIN;
    bool jpeg2000 = syntax.getXfer() == EXS_JPEG2000LosslessOnly || syntax.getXfer() == EXS_JPEG2000;
    return jpeg2000 ? DICOM_JPEG2000 : DICOM_DCMTK;
}

bool dicom_file_is_jpeg(dicom_file *f)
{
    return dicom_file_packing(f, nullptr) == DICOM_DCMTK && f->set->getOriginalXfer() != EXS_RLELossless;
}

int64_t dicom_pixels_size(dicom_file *f)
{
    DcmElement *element = nullptr;
    if (f->set->findAndGetElement(DCM_PixelData, element).bad() || !element)
        return -1;
    use(f, 0x7FE00010);
    return int64_t(element->getLength());
}

bool dicom_pixels_unpack(dicom_file *f, int64_t most)
{
    most_at_once = size_t(most) + room_to_read(f->size);
    bool good = f->set->chooseRepresentation(EXS_LittleEndianExplicit, nullptr).good();
    most_at_once = SIZE_MAX;
    return good;
}

const unsigned char *dicom_pixels(dicom_file *f, int bytes)
{
    const Uint8 *small = nullptr;
    const Uint16 *large = nullptr;
    if (bytes == 1 && f->set->findAndGetUint8Array(DCM_PixelData, small).good() && small)
        return small;
    if (f->set->findAndGetUint16Array(DCM_PixelData, large).good() && large)
        return reinterpret_cast<const unsigned char *>(large);
    return nullptr;
}

int64_t dicom_pieces(dicom_file *f)
{
    DcmPixelSequence *items = pieces_of(f);
    return items && items->card() ? int64_t(items->card()) - 1 : 0;
}

/* The first item is the table of offsets. */
const unsigned char *dicom_piece(dicom_file *f, int64_t at, size_t *size)
{
    DcmPixelSequence *items = pieces_of(f);
    DcmPixelItem *item = nullptr;
    Uint8 *bytes = nullptr;
    if (!items)
        return nullptr;
    if (f->piece && at == f->piece_at + 1)
        item = static_cast<DcmPixelItem *>(items->nextInContainer(f->piece));
    else if (f->piece && at == f->piece_at)
        item = static_cast<DcmPixelItem *>(f->piece);
    else if (items->getItem(item, static_cast<unsigned long>(at + 1)).bad())
        item = nullptr;
    f->piece_at = at;
    f->piece = item;
    if (!item || item->getUint8Array(bytes).bad() || !bytes)
        return nullptr;
    *size = item->getLength();
    return bytes;
}
