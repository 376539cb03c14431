#include "slice/import/dicom_lengths.h"

#include <string.h>

/* PS3.5: 7.1 (elements), 7.5 (items), A.4 (pixels in items). */
enum { HEAD = 132, META = 2, ITEMS = 0xFFFE, ITEM = 0xE000, SEQUENCE_END = 0xE0DD };
#define UNDEFINED 0xFFFFFFFFU
#define PIXELS    0x7FE00010U

typedef struct walk {
    const unsigned char *bytes;
    size_t size, at;
    bool big, implicit, packed; /* packed: among the items of compressed pixels */
} walk;

typedef struct head {
    uint16_t group, element;
    char vr[3]; /* "" where it is implicit, or an item */
    uint32_t length;
    size_t size; /* of the head itself */
} head;

static uint16_t two(const walk *w, size_t at, bool big)
{
    const unsigned char *p = w->bytes + at;
    return (uint16_t)(big ? p[0] << 8 | p[1] : p[1] << 8 | p[0]);
}

static uint32_t four(const walk *w, size_t at, bool big)
{
    uint32_t first = two(w, at, big), second = two(w, at + 2, big);
    return big ? first << 16 | second : second << 16 | first;
}

/* The head at w->at; false: there is none that is understood. */
static bool read_head(const walk *w, bool implicit, bool big, head *h)
{
    static const char shorter[] = "AE AS AT CS DA DS DT FD FL IS LO LT PN SH SL SS ST TM UI UL US";
    if (w->size - w->at < 8)
        return false;
    *h = (head){.group = two(w, w->at, big), .element = two(w, w->at + 2, big), .size = 8};
    if (implicit || h->group == ITEMS) {
        h->length = four(w, w->at + 4, big);
        return true;
    }
    memcpy(h->vr, w->bytes + w->at + 4, 2);
    /* Of representations that it does not know, DCMTK takes those of two capitals as
     * UN, others as if they were short. */
    bool known = h->vr[0] >= 'A' && h->vr[0] <= 'Z' && h->vr[1] >= 'A' && h->vr[1] <= 'Z';
    h->length = two(w, w->at + 6, big);
    if (!known || strstr(shorter, h->vr))
        return true;
    h->size = 12;
    if (w->size - w->at < 12)
        return false;
    h->length = four(w, w->at + 8, big);
    return true;
}

static int refuse(const walk *w, const head *h, const char *name, err *e)
{
    return err_set(e, name, 0, "not whole, or damaged: element (%04x,%04x) claims %lu bytes, and %lu are left",
                   (unsigned)h->group, (unsigned)h->element, (unsigned long)h->length,
                   (unsigned long)(w->size - w->at - h->size));
}

/* The file's own head, always explicit and little-endian, which says how the rest is written. */
static int read_meta(walk *w, const char *name, err *e)
{
    static const char syntax[] = "1.2.840.10008.1.2";
    head h;
    w->at = HEAD;
    while (read_head(w, false, false, &h) && h.group == META) {
        const char *value = (const char *)w->bytes + w->at + h.size;
        size_t most = sizeof syntax - 1;
        if (h.length > w->size - w->at - h.size)
            return refuse(w, &h, name, e);
        if (h.element == 0x10 && h.length >= most && !memcmp(value, syntax, most)) {
            size_t rest = h.length - most;
            w->implicit = rest == 0 || !value[most] || value[most] == ' ';
            w->big = rest >= 2 && !memcmp(value + most, ".2", 2) &&
                     (rest == 2 || !value[most + 2] || value[most + 2] == ' ');
        }
        w->at += h.size + h.length;
    }
    return 0;
}

/* Whether an element of this head is gone into, rather than stepped over. */
static bool holds_items(const walk *w, const head *h)
{
    if (h->group == ITEMS)
        return h->element != ITEM || !w->packed;
    if (h->length == UNDEFINED || !strcmp(h->vr, "SQ"))
        return true;
    size_t at = w->at + h->size;
    return w->implicit && h->length >= 8 && w->size - at >= 8 && two(w, at, w->big) == ITEMS &&
           two(w, at + 2, w->big) == ITEM;
}

int dicom_lengths_check(const unsigned char *bytes, size_t size, const char *name, err *e)
{
    walk w = {.bytes = bytes, .size = size};
    head h;
    if (size < HEAD)
        return 0;
    if (read_meta(&w, name, e))
        return -1;
    while (read_head(&w, w.implicit, w.big, &h)) {
        if (h.length == UNDEFINED && !strcmp(h.vr, "UN")) /* what is in it is written in another way */
            return 0;
        if (holds_items(&w, &h)) {
            w.packed = h.group == ITEMS ? w.packed && h.element != SEQUENCE_END
                                        : ((uint32_t)h.group << 16 | h.element) == PIXELS && strcmp(h.vr, "SQ") != 0;
            w.at += h.size;
            continue;
        }
        if (h.length > w.size - w.at - h.size)
            return refuse(&w, &h, name, e);
        w.at += h.size + h.length;
    }
    return 0;
}

int64_t dicom_lengths_items(const unsigned char *bytes, size_t size)
{
    int64_t items = 0;
    const unsigned char *end = bytes + size;
    for (const unsigned char *p = bytes; p + 4 <= end; p++) {
        p = memchr(p, 0xFE, (size_t)(end - p));
        if (!p || p + 4 > end)
            break;
        bool little = p[1] == 0xFF && p[2] == 0 && p[3] == 0xE0;
        bool big = p > bytes && p[-1] == 0xFF && p[1] == 0xE0 && p[2] == 0;
        items += little || big;
    }
    return items;
}
