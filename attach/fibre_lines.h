/* Fibres of skin from lines that were drawn on it: --fibre-lines. Keeps nothing.
 */
#ifndef SINEW_FIBRE_LINES_H
#define SINEW_FIBRE_LINES_H

#include "base/pool.h"
#include "cli/opt.h"
#include "model/model.h"

/* Sets element.fibre, and element.mixfibre, of volumes that are no muscles from the lines of an OBJ file, whose
 * coordinates are in the model's source.unit. volumes: their names between commas, a '*' at the end for any rest, in
 * any case; no names: the layers of the skin, which are the volumes of elements that have an element.normal. Where
 * there is a normal, fibres are in the plane across it. muscle_fibres comes first. -1 with e filled. */
int fibre_lines_apply(model *m, const char *file, const opt_list *volumes, pool *threads, err *e);

#endif
