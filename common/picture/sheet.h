/* The layout of panels on a sheet: columns and rows, each panel with room for a caption above its picture and for a
 * legend below it. Measures are in pixels. It owns nothing.
 */
#ifndef SINEW_SHEET_H
#define SINEW_SHEET_H

typedef struct sheet {
    int width, height, panels;
    int columns, rows;
    int head, foot; /* of each panel: room above and below its picture */
} sheet;

typedef struct sheet_cell {
    int x, y, width, height;
} sheet_cell;

/* Chooses the columns so that pictures come out as large as can be. */
void sheet_make(sheet *s, int width, int height, int panels, int head, int foot);

/* The i-th panel, and the picture in it. A last row that is not full is centred. */
sheet_cell sheet_panel(const sheet *s, int i);
sheet_cell sheet_picture(const sheet *s, int i);

#endif
