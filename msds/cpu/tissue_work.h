/* What takes the time of the method tissue, in chunks that threads take: passes over groups of elements and over slices
 * of nodes (lanes.h), and fields of nodes. Owns nothing.
 */
#ifndef SINEW_TISSUE_WORK_H
#define SINEW_TISSUE_WORK_H

#include "msds/cpu/tissue.h"

/* Works on all groups, or on all slices of nodes. */
void tissue_groups(tissue *t, pool_work *work);
void tissue_nodes(tissue *t, pool_work *work);

/* The same; returns the sum of what the chunks leave in t->sum. */
double tissue_nodes_sum(tissue *t, pool_work *work);

/* Volumes and pressures at u. */
void tissue_measure(tissue *t);

/* to: what the elements pull with at u, N, with the pressures and the tangents there. */
void tissue_pull(tissue *t, lanes_field *to);

/* t->pulled: what that changes by along a way from there. Returns way . pulled. */
double tissue_change(tissue *t, const lanes_field *way);

/* The same to another field, with the bulk modulus in full, which a pressure that is held takes frames to come to. */
double tissue_tangent(tissue *t, const lanes_field *way, lanes_field *to);

/* The same where no point's pressure changes. */
double tissue_stiffness(tissue *t, const lanes_field *way);

/* step += alpha way; left -= alpha pulled. Returns left . left inverse. */
double tissue_advance(tissue *t, double alpha);

/* way = inverse left + beta way. */
void tissue_turn(tissue *t, double beta);

/* The sum of f . with over all nodes. */
double tissue_dot(tissue *t, const lanes_field *f, const lanes_field *with);

void tissue_clear(const tissue *t, lanes_field *f);
void tissue_copy(const tissue *t, lanes_field *to, const lanes_field *from);

#endif
