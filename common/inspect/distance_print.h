/* The report of sinew distance: tables for people, TSV for programs, and the distance of each vertex. Owns nothing.
 */
#ifndef SINEW_DISTANCE_PRINT_H
#define SINEW_DISTANCE_PRINT_H

#include "inspect/distance_rows.h"

/* One direction, or both: to[1].count is 0 without the way back. */
typedef struct distance_report {
    const distance_surface *surface[2]; /* A and B */
    distance_rows rows[2];              /* of A to B and of B to A */
    int64_t *back;                      /* rows[0].count: the row of B that has the same region, or -1; owned */
} distance_report;

/* Finds the rows of the way back that belong together. by_name: but for the first ones, which are the whole; else by
 * their order. */
int distance_report_join(distance_report *r, bool by_name, err *e);

int distance_print_tables(const distance_report *r, out *to, err *e);
void distance_print_tsv(const distance_report *r, out *to);

/* A line for each vertex of a polygon. */
void distance_print_points(const distance_surface *s, const distance_field *f, out *to);

#endif
