/* A mesh as another program's file has it, on its way to a model: what the readers of sinew-import fill, the checks
 * that all meshes go through, and the model that they become. Lengths are in the file's unit until then. The creator
 * owns the mesh, zeroed to begin with but for `name`; readers add to it and leave what they added also where they fail.
 */
#ifndef SINEW_IMPORT_MESH_H
#define SINEW_IMPORT_MESH_H

#include "base/in.h"
#include "exchange/import_ids.h"
#include "model/materials.h"
#include "model/model.h"
#include "surface/names.h"

/* A material as far as the file has it. */
typedef struct import_material {
    char *name;
    material of; /* in the file's units; law NULL: not given, density nan: likewise */
    int64_t line;
    char *written; /* the name as the file writes it, for messages; NULL: as `name` is */
} import_material;

typedef struct import_volume {
    char *name;
    int32_t material; /* in `material`, or -1: the file does not say */
} import_volume;

typedef struct import_mesh {
    const char *name; /* the file's: borrowed */
    double *position; /* nodes x 3 */
    int64_t nodes, position_room;
    import_ids node_id; /* of files that number their nodes */
    int32_t columns;    /* corners of an element: 8 or 4; 0: none yet */
    int32_t *corner;    /* elements x columns, VTK order: the file's numbers, until import_resolve */
    int64_t elements, corner_room;
    int32_t *volume; /* elements: in `volumes`, or -1 */
    int64_t volume_room;
    int64_t *line; /* elements: where it stands in the file; 0: it has no lines */
    int64_t line_room;
    float *fibre, *normal; /* elements x 3, or NULL */
    import_volume *volumes;
    int64_t volume_count, volumes_room;
    bool any_case; /* the file's names have no case: they came in lower case */
    import_material *material;
    int64_t materials, material_room;
    names volume_names, material_names; /* of the first of them, so that they are found; free them where names change */
    uint8_t *rigid;                     /* nodes, or NULL: the file holds none */
} import_mesh;

/* What is asked for on the command line. */
typedef struct import_wishes {
    double scale; /* m in the file's unit */
    double stress,
        density;        /* Pa and kg/m3 in the file's units; 0: nobody has said, and a file with materials is refused */
    const char *volume; /* name of the volume of elements that the file puts in none */
    const char *material; /* name of the material of volumes for which the file has none; NULL: see import_materials */
    const char *const *rigid; /* names of node sets, surfaces or groups to hold */
    int rigids;
    bool own_materials; /* the model has its table of materials already: those of the file do not matter */
} import_wishes;

/* Reads a format: fills the mesh. -1 with e filled, at file:line where the format has lines. */
typedef int import_reader(import_mesh *m, in *s, const import_wishes *wishes, notes *warnings, err *e);

/* The kinds of cells that a file may have, whatever numbers it gives them. */
typedef enum import_kind { IMPORT_HEX, IMPORT_TET, IMPORT_LOWER, IMPORT_REFUSED } import_kind;

int import_add_node(import_mesh *m, const double *position, err *e);

/* volume: or -1. All elements of a mesh have as many corners: another is refused. */
int import_add_element(import_mesh *m, const int32_t *corner, int32_t columns, int32_t volume, int64_t line, err *e);

/* The index of the volume or material so named, which is added where there is none; -1 with e filled. */
int32_t import_add_volume(import_mesh *m, const char *name, err *e);
int32_t import_add_material(import_mesh *m, const char *name, int64_t line, err *e);

/* Room for m->rigid. */
int import_need_rigid(import_mesh *m, err *e);

/* The file's numbers at the corners become indices. */
int import_resolve(import_mesh *m, err *e);

/* Checks every element, drops nodes that no element has, and makes the model: its unit of length is wishes->scale. */
int import_build(import_mesh *mesh, const import_wishes *wishes, model *m, notes *warnings, err *e);

void import_free(import_mesh *m);

#endif
