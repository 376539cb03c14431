/* The elements that DICOM files held, by tag: for reports. Names are the standard's; values are not kept. The caller
 * owns the list; begin with a zeroed one.
 */
#ifndef SINEW_DICOM_ELEMENTS_H
#define SINEW_DICOM_ELEMENTS_H

#include "base/err.h"

typedef struct dicom_element {
    uint16_t group, element;
    bool used;     /* for geometry or pixels */
    char name[64]; /* "private" where it is a maker's */
    int64_t files;
} dicom_element;

typedef struct dicom_elements {
    dicom_element *one; /* owned; by tag */
    int64_t count, capacity;
} dicom_elements;

/* Adds an element, or a file to those that have it. */
int dicom_elements_note(dicom_elements *list, const dicom_element *what, err *e);

/* It is used, if it is in the list. */
void dicom_elements_use(dicom_elements *list, uint16_t group, uint16_t element);

void dicom_elements_free(dicom_elements *list);

#endif
