#include "slice/import/dicom_elements.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

static uint32_t tag_of(uint16_t group, uint16_t element)
{
    return (uint32_t)group << 16 | element;
}

/* The place of a tag, by halving; *there: whether it is in the list. */
static int64_t place_of(const dicom_elements *list, uint32_t tag, bool *there)
{
    int64_t low = 0, high = list->count;
    while (low < high) {
        int64_t middle = (low + high) / 2;
        if (tag_of(list->one[middle].group, list->one[middle].element) < tag)
            low = middle + 1;
        else
            high = middle;
    }
    *there = low < list->count && tag_of(list->one[low].group, list->one[low].element) == tag;
    return low;
}

int dicom_elements_note(dicom_elements *list, const dicom_element *what, err *e)
{
    bool there;
    int64_t at = place_of(list, tag_of(what->group, what->element), &there);
    if (there) {
        list->one[at].files++;
        return 0;
    }
    if (MEM_ROOM(&list->one, &list->capacity, list->count + 1, "a list of elements", e))
        return -1;
    memmove(list->one + at + 1, list->one + at, (size_t)(list->count++ - at) * sizeof *list->one);
    list->one[at] = *what;
    list->one[at].files = 1;
    return 0;
}

void dicom_elements_use(dicom_elements *list, uint16_t group, uint16_t element)
{
    bool there;
    int64_t at = place_of(list, tag_of(group, element), &there);
    if (there)
        list->one[at].used = true;
}

void dicom_elements_free(dicom_elements *list)
{
    free(list->one);
    *list = (dicom_elements){0};
}
