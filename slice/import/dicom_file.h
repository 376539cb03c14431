/* A DICOM file while it is read: its elements by tag, and its pixels. The one user of DCMTK, which is C++:
 * dicom_file.cc. (DCMTK rather than GDCM, which knows nothing of Enhanced US Volume's functional groups.) All that
 * these return lasts while dicom_file_take runs, and is not the caller's.
 */
#ifndef SINEW_DICOM_FILE_H
#define SINEW_DICOM_FILE_H

#ifdef __cplusplus
extern "C" {
#endif

#include "slice/import/dicom_elements.h"

#include <stddef.h>

typedef struct dicom_file dicom_file;
typedef struct dicom_item dicom_item; /* of a sequence, or the data set */

typedef enum dicom_packing { DICOM_PLAIN, DICOM_DCMTK, DICOM_JPEG2000 } dicom_packing;

/* Reads a file that is in memory, and gives it to dicom_file_take, whose result this returns; or -1 with e filled. seen
 * (may be NULL) gets its elements, those of nested items too; and which of them are used. */
int dicom_file_read(const unsigned char *bytes, size_t size, const char *name, dicom_elements *seen, void *to, err *e);

/* What is done with the file while it is open: dicom_image.c. (By name: sanitizers
 * cannot follow a pointer to it from C++.) */
int dicom_file_take(dicom_file *f, void *to, err *e);

/* What DCMTK allocated once. */
void dicom_file_end(void);

const char *dicom_file_name(const dicom_file *f);
size_t dicom_file_size(const dicom_file *f);
dicom_item *dicom_file_set(dicom_file *f);

/* ---- elements: tag is the group and the number, as 0x00280010 */

bool dicom_has(dicom_file *f, uint32_t tag);

/* Up to `most` numbers: how many there are, 0 where there is no such element, or no item. */
int dicom_numbers(dicom_file *f, dicom_item *item, uint32_t tag, double *to, int most);

/* The first value as text, cut to size; "" where there is none. */
void dicom_text(dicom_file *f, dicom_item *item, uint32_t tag, char *to, size_t size);

/* An item of a sequence, from 0; NULL where there is none. */
dicom_item *dicom_inner(dicom_file *f, dicom_item *item, uint32_t tag, int64_t at);

/* 16-bit words: how many, 0 where there are none. */
int64_t dicom_words(dicom_file *f, uint32_t tag, const uint16_t **words);

/* ---- pixels */

/* How they are compressed; *name (may be NULL): the transfer syntax, in words. */
dicom_packing dicom_file_packing(dicom_file *f, const char **name);

/* Whether those that DCMTK unpacks are JPEG or JPEG-LS, not RLE. */
bool dicom_file_is_jpeg(dicom_file *f);

/* The bytes that they take, in the file, or unpacked; -1: there are none. */
int64_t dicom_pixels_size(dicom_file *f);

/* Decompresses those that DCMTK can, after which elements may say other things. most: the bytes that it may take for
 * it, beside what the file's size allows. False: it cannot. */
bool dicom_pixels_unpack(dicom_file *f, int64_t most);

/* Little-endian, of samples of 1 or 2 bytes; NULL where they cannot be had. */
const unsigned char *dicom_pixels(dicom_file *f, int bytes);

/* Pieces that compressed pixels are in, and one of them, from 0; NULL. */
int64_t dicom_pieces(dicom_file *f);
const unsigned char *dicom_piece(dicom_file *f, int64_t at, size_t *size);

#ifdef __cplusplus
}
#endif

#endif
