/* The report of voxelise --check on surfaces and volumes: a row each in tables, and with -v one property a line; and
 * what every run says about sizes and gaps. Keeps nothing.
 */
#ifndef SINEW_REPORT_H
#define SINEW_REPORT_H

#include "base/num.h"
#include "base/out.h"
#include "cli/listing.h"
#include "cli/text_table.h"
#include "cli/tool.h"
#include "voxelise/gaps.h"
#include "voxelise/layers.h"
#include "voxelise/slits.h"
#include "voxelise/surfaces/check_surfaces.h"
#include "voxelise/volumes.h"

/* unit: the name of the OBJ's. */
void report_surface(out *o, const volumes *plan, int32_t surface, const check_result *r, const char *unit);

/* A volume: open is the count of its open edges, the first of them at a place. r (NULL: not asked): of all its
 * surfaces together. */
void report_volume(out *o, const volumes_volume *v, const check_result *r, int64_t open, const double at[3],
                   const char *unit);

/* Tables of what is wrong, a row for each: empty ones, which the caller frees, and their rows. sized: with the share
 * that is thinner than a voxel. */
text_table *report_surfaces(bool sized, err *e);
void report_surface_row(text_table *t, const char *name, const check_result *r, bool sized);
text_table *report_volumes(err *e);
void report_volume_row(text_table *t, const volumes_volume *v, int64_t open);

/* Writes the tables, and with -v the detail. -1 with e filled. */
int report_write(const tool *t, const text_table *of_surfaces, const text_table *of_volumes, out *detail, err *e);

/* Warns where it crosses itself, and adds it to those that are thin. what: "surface" or "volume". */
void report_warn(notes *n, listing *thin, const char *what, const char *name, const check_result *r);

/* Warns of those that are thin, in one line. */
void report_thin(notes *n, listing *thin);

/* The sides of the box about all, in the OBJ's unit. */
void report_sides(const obj *o, double side[3]);

/* The error of a run without --unit. Returns -1. */
int report_ask_for_unit(const obj *o, err *e);

/* Notes gaps that elements fill. least: of a voxel, the share from which on it is an element; NAN: by centres. */
void report_gaps(notes *n, const gaps *found, const grid *g, double least, num_unit unit);

/* Notes a layer that is thinner than a voxel, by centres: the volume of that number. */
void report_layer(notes *n, const layers *l, int64_t layer, int32_t volume, const voxels *x, const grid *g,
                  num_unit unit);

/* Notes what is not right with a layer by shares, of any thickness. count: of its volume; laminates: with these;
 * samples: of a voxel, along a side. Whether something is. */
bool report_layer_share(notes *n, const layers *l, int64_t layer, const climb_count *count, bool laminates,
                        int64_t samples, const grid *g, num_unit unit);

/* Says how many nodes and elements slits have added; nothing where they have added none. */
void report_slits(const tool *t, const slits *s);

#endif
