/* Wavefront OBJ: what the geometry needs, and what it takes to write the file again with other positions and every
 * other byte as it was. The caller owns an obj. Source: the Wavefront OBJ specification, appendix B1.
 */
#ifndef SINEW_OBJ_H
#define SINEW_OBJ_H

#include "base/in.h"
#include "base/out.h"

typedef struct obj_line { /* a logical line (continuations joined) of the text, without its line end */
    int64_t from, to;
} obj_line;

typedef struct obj {
    char *name; /* as given: for messages */
    char *text; /* the whole file, gunzipped */
    int64_t size;
    double *position; /* vertices x 3, in the file's unit */
    obj_line *v;      /* the line of each vertex */
    int64_t vertices;
    double *normal; /* normals x 3 */
    obj_line *vn;
    int64_t normals;
    int64_t *face_start;    /* faces + 1: corners of face f are face_start[f] to face_start[f + 1] - 1 */
    int32_t *face_group;    /* faces */
    int64_t faces;          /* points (1 corner), lines (2; an `l` of n vertices gives n - 1) and polygons */
    int32_t *corner_vertex; /* corners: 0-based */
    int32_t *corner_normal; /* corners: 0-based, -1 = none */
    int64_t corners;
    char **group; /* names between spaces, as chars_escape() writes them; groups in order of first mention */
    int32_t groups;
    int64_t free_form, free_form_line; /* lines of curves and surfaces that were skipped, and the first of them */
} obj;

/* Reads all of s. Every index form, negative indices, `g`, `o`, continuation lines. A face is in the groups of the last
 * `g`; where no `g` was seen since the last `o`, in the object (its blanks as '_'); else in "default". A word that
 * begins with '#' begins a comment, in every statement. Names are of any bytes. Lines of free-form geometry are
 * skipped. Errors name the line. */
int obj_read(obj *o, in *s, err *e);
void obj_free(obj *o);

/* Notes what was skipped. */
void obj_notes(const obj *o, notes *warnings);

/* The box about the vertices that something uses; where nothing uses any, about all. Without vertices it is the wrong
 * way round. */
void obj_box(const obj *o, double low[3], double high[3]);

/* The number of the line that the byte at `offset` of the text is on. */
int64_t obj_line_number(const obj *o, int64_t offset);

/* Writes the text again with these positions (and normals; NULL: as they were). A vertex whose position equals the
 * one read keeps its line to the byte; otherwise its three numbers are written anew and what follows them on
 * the line (weight, colour) stays. A position gets 9 + ceil(log10(largest |coordinate| / extent)) significant
 * digits, at least 9 and at most 17, of the surface as it was read (its longest side): nine of its extent
 * however far away it lies. A normal gets 9. */
void obj_write(const obj *o, const double *position, const double *normal, out *to);

#endif
