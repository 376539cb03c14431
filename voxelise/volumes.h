/* The plan: which surfaces of an OBJ bound which volume, and each volume's level, priority and material (W&M section
 * 3). It is made from the surfaces' names or read from a file, and owned by whoever declares it.
 */
#ifndef SINEW_VOLUMES_H
#define SINEW_VOLUMES_H

#include "base/in.h"
#include "model/model.h"
#include "surface/obj.h"

/* A surface: the polygons that have one name among their groups. Names that differ only in case are one. */
typedef struct volumes_surface {
    char *name;       /* owned */
    int64_t polygons; /* faces of 3 corners and more */
    int64_t own;      /* of them, those that it bounds something with by default: see volumes_by_name */
    bool used;        /* by a volume */
} volumes_surface;

typedef struct volumes_volume {
    char *name;     /* owned */
    char *surfaces; /* its surfaces' names between spaces, for people; owned */
    int32_t level, priority, material;
    bool muscle;
} volumes_volume;

/* The faces of a group belong to a volume, by way of a surface. */
typedef struct volumes_member {
    int32_t group, volume, surface;
} volumes_member;

typedef struct volumes {
    volumes_volume *volume; /* by level, then by priority */
    int32_t volumes;
    volumes_surface *surface; /* in file order */
    int32_t surfaces;
    volumes_member *member; /* by group; a pair of group and volume once */
    int64_t members, capacity;
    int64_t *group_start; /* groups + 1: a group's first member */
    int32_t groups;
    int32_t *token; /* the surfaces that each group names, group after group */
    int64_t *token_start;
    bool rigid; /* a surface begins skull, bone or rigid */
} volumes;

/* By names, in any case: surfaces that begin skin, skull, bone and rigid make `skin`; each that begins muscle makes its
 * own volume, on level 1; all others make one, on level 0. A face that has a rigid name beside another name bounds
 * what that other name says only: the rigid name marks it. Where there is nothing for level 0, muscles stand on it. A
 * volume takes the material of its own name; else, a muscle, the material `muscle`; else the first. */
int volumes_by_name(volumes *v, const obj *o, const model *materials, err *e);

/* From a file of lines `NAME level=0 priority=0 material=MATERIAL surfaces=skin,skull* muscle=no`. Notes say which
 * surfaces are in no volume. */
int volumes_read(volumes *v, in *file, const obj *o, const model *materials, notes *warnings, err *e);

/* Notes on surfaces that have no polygon. by_name: and on names that are all but one that says what a surface is. */
void volumes_notes(const volumes *v, bool by_name, notes *warnings);

void volumes_free(volumes *v);

/* ---- for those that make plans: volumes.c and volumes_file.c, and for voxelise.c */

/* Fills surface, token and token_start. */
int volumes_surfaces(volumes *v, const obj *o, err *e);

/* The error of an OBJ that has none. Returns -1. */
int volumes_no_polygons(const obj *o, err *e);

/* A surface bounds a volume. */
typedef struct volumes_link {
    int32_t surface, volume;
} volumes_link;

/* Fills member, group_start, what surfaces are used and each volume's list of names, from links. marks: a rigid name
 * beside another only marks. */
int volumes_join(volumes *v, const volumes_link *link, int64_t links, bool marks, err *e);

/* The first length characters of a name, in lower case; the caller frees it. NULL with e filled on no memory. */
char *volumes_lower(const char *name, size_t length, err *e);

/* Whether a group's polygons are of a surface, and whether they bound a volume. */
bool volumes_is_of_surface(const volumes *v, int32_t group, int32_t surface);
bool volumes_is_of_volume(const volumes *v, int32_t group, int32_t volume);

bool volumes_begins(const char *name, const char *with);
bool volumes_is_rigid(const char *name);

#endif
