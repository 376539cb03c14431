#include "picture/sheet.h"

/* The shorter side of the pictures with so many columns. */
static int shorter(const sheet *s, int columns)
{
    int rows = (s->panels + columns - 1) / columns;
    int width = s->width / columns, height = s->height / rows - s->head - s->foot;
    return width < height ? width : height;
}

void sheet_make(sheet *s, int width, int height, int panels, int head, int foot)
{
    *s = (sheet){.width = width, .height = height, .panels = panels, .head = head, .foot = foot};
    s->columns = panels;
    for (int columns = panels - 1; columns > 0; columns--)
        if (shorter(s, columns) > shorter(s, s->columns))
            s->columns = columns;
    s->rows = (panels + s->columns - 1) / s->columns;
}

sheet_cell sheet_panel(const sheet *s, int i)
{
    int row = i / s->columns, column = i % s->columns;
    int width = s->width / s->columns, height = s->height / s->rows;
    int in_row = row == s->rows - 1 ? s->panels - row * s->columns : s->columns;
    return (sheet_cell){(s->width - in_row * width) / 2 + column * width, row * height, width, height};
}

sheet_cell sheet_picture(const sheet *s, int i)
{
    sheet_cell c = sheet_panel(s, i);
    return (sheet_cell){c.x, c.y + s->head, c.width, c.height - s->head - s->foot};
}
