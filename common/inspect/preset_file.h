/* A file of materials as somebody looks for one: what it is of, and what each material in it is, in the words of its
 * comments: its first line, and what stands behind each material. Whoever reads it owns it.
 */
#ifndef SINEW_PRESET_FILE_H
#define SINEW_PRESET_FILE_H

#include "model/materials.h"

typedef struct preset_file {
    char *path, *title; /* title: "" where the first line is no comment */
    model materials;    /* the table of materials, as in a model */
    char **what;        /* of each material; "" where there is no comment */
} preset_file;

/* Reads it, "-" being standard input, and checks it as the tools do that take it. On failure -1 with e filled, and
 * nothing to free. */
int preset_file_read(preset_file *to, const char *path, err *e);
int preset_file_take(preset_file *to, in *s, err *e);
void preset_file_free(preset_file *of);

/* Their paths, by name: all files NAME.materials that were installed, or those of the checkout. The caller frees them.
 * -1 with e filled. */
typedef struct preset_paths {
    int count;
    char **path;
} preset_paths;
int preset_paths_installed(preset_paths *to, err *e);
void preset_paths_free(preset_paths *of);

#endif
