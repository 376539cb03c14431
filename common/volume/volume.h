/* A volume image in memory: voxels of one number each, and where they lie in the patient. Its geometry is as on disk,
 * LPS millimetres (x to the left, y to the back, z to the head), so that it is written as it was read; places that are
 * asked for or given are metres. A volume owns its voxels and labels; a zeroed one is empty.
 */
#ifndef SINEW_VOLUME_H
#define SINEW_VOLUME_H

#include "base/in.h"
#include "base/out.h"

#include <stddef.h>

/* X(name, C type, NRRD's type, MetaImage's type, low, high): whole numbers' ranges, as text. */
#define VOLUME_TYPES(X)                                                                                                \
    X(I8, int8_t, "int8", "MET_CHAR", INT8_MIN, INT8_MAX)                                                              \
    X(U8, uint8_t, "uint8", "MET_UCHAR", 0, UINT8_MAX)                                                                 \
    X(I16, int16_t, "int16", "MET_SHORT", INT16_MIN, INT16_MAX)                                                        \
    X(U16, uint16_t, "uint16", "MET_USHORT", 0, UINT16_MAX)                                                            \
    X(I32, int32_t, "int32", "MET_INT", INT32_MIN, INT32_MAX)                                                          \
    X(U32, uint32_t, "uint32", "MET_UINT", 0, UINT32_MAX)                                                              \
    X(I64, int64_t, "int64", "MET_LONG_LONG", INT64_MIN, INT64_MAX)                                                    \
    X(U64, uint64_t, "uint64", "MET_ULONG_LONG", 0, INT64_MAX)                                                         \
    X(F32, float, "float", "MET_FLOAT", 0, 0)                                                                          \
    X(F64, double, "double", "MET_DOUBLE", 0, 0)

#define VOLUME_ENUM(name, of, nrrd, meta, low, high) VOLUME_##name,
typedef enum volume_type { VOLUME_TYPES(VOLUME_ENUM) VOLUME_TYPE_COUNT } volume_type;

typedef struct volume_label {
    int64_t value;
    char *name; /* owned */
} volume_label;

typedef struct volume {
    volume_type type;
    int64_t size[3];     /* voxels along i, j, k; i is fastest in memory */
    double origin[3];    /* mm: the centre of voxel 0 0 0 */
    double axis[3][3];   /* mm: from a voxel to the next along i, j, k; not in one plane */
    void *data;          /* size[0] x size[1] x size[2] */
    volume_label *label; /* names of labels, in ascending order of their values */
    int labels;
} volume;

/* How much memory a volume may take: asked once its type and size are known, before there is any for its voxels. */
typedef struct volume_budget {
    int64_t most; /* bytes; 0: no limit but what memory there is */
    double (*peak)(const volume *v,
                   const void *context); /* what is taken at once on its account, bytes; NULL: its voxels */
    const void *context;
    int (*check)(const volume *v, const char *place, err *e); /* refuses sizes that are not for this tool; NULL: none */
} volume_budget;

/* Refuses what is beyond a budget (which may be NULL): -1 with e filled. place: the file; NULL: none. */
int volume_afford(const volume_budget *b, const volume *v, const char *place, err *e);

/* The bytes of its voxels. */
double volume_memory(const volume *v);

/* Reads all of a NRRD or MetaImage file; which, its first bytes say. path: where it is, so that data in a file of their
 * own are found in the same folder; NULL: nowhere, and such data are refused. b: may be NULL. -1 with e filled: file,
 * line and reason. */
int volume_read(volume *v, in *s, const char *path, const volume_budget *b, err *e);

/* The same from a path; NULL or "-": standard input. */
int volume_load(volume *v, const char *path, const volume_budget *b, err *e);
void volume_free(volume *v);

size_t volume_type_size(volume_type t);

/* A zeroed volume's voxels, all 0, for the type and size that are set. */
int volume_make(volume *v, err *e);

static inline int64_t volume_count(const volume *v)
{
    return v->size[0] * v->size[1] * v->size[2];
}

/* One voxel as a number; `at`: (k size[1] + j) size[0] + i. */
static inline double volume_value(const volume *v, int64_t at)
{
    switch (v->type) {
#define VOLUME_CASE(name, of, nrrd, meta, low, high)                                                                   \
    case VOLUME_##name:                                                                                                \
        return (double)((const of *)v->data)[at];
        VOLUME_TYPES(VOLUME_CASE)
    default:
        return 0;
    }
}

/* The distance from a voxel to the next along an axis, mm. */
double volume_spacing(const volume *v, int axis);

/* Six times the volume of the axes, mm3: below 0, they are left-handed. */
double volume_handed(const volume *v);

/* Refuses a geometry that is none: sizes below 1, numbers that are not finite, axes that lie (almost) in a plane. */
int volume_check(const volume *v, const char *place, int64_t line, err *e);

/* A place in units of voxels (the centre of 0 0 0 is 0 0 0) in metres. */
void volume_place(const volume *v, const double voxel[3], double place[3]);

/* The way back, made once for many places. */
typedef struct volume_finder {
    double origin[3], row[3][3];
} volume_finder;

volume_finder volume_finder_of(const volume *v);

static inline void volume_voxel(const volume_finder *f, const double place[3], double voxel[3])
{
    for (int a = 0; a < 3; a++) {
        voxel[a] = 0;
        for (int b = 0; b < 3; b++)
            voxel[a] += f->row[a][b] * (place[b] - f->origin[b]);
    }
}

/* The voxel that holds a place, as an index into data; -1: it is outside. */
int64_t volume_nearest(const volume *v, const volume_finder *f, const double place[3]);

/* The name of a label, or NULL. volume_name: gives it one, whose last one counts. */
const char *volume_label_of(const volume *v, int64_t value);
int volume_name(volume *v, int64_t value, const char *name, err *e);

#endif
