#include "render/placed.h"

#include "base/mem.h"
#include "base/num.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int bad(const in *s, err *e, const char *expected)
{
    return err_set(e, in_name(s), in_lines(s), "no image that says where it lies; expected %s, as us-slice writes them",
                   expected);
}

/* Finite numbers between blanks, exactly so many. */
static int take_numbers(char *text, double *to, int count)
{
    char *rest = NULL;
    int got = 0;
    for (char *word = strtok_r(text, " ", &rest); word; word = strtok_r(NULL, " ", &rest))
        if (got == count || num_double(word, &to[got++]))
            return -1;
    return got == count ? 0 : -1;
}

/* What is after the mark: nine numbers, and four more where there is a fan. */
static int take_place(placed *p, char *text)
{
    static const char word[] = " fan ";
    double place[9], fan[4] = {0};
    char *more = strstr(text, word);
    p->fan = more != NULL;
    if (more)
        *more = '\0';
    if (take_numbers(text, place, 9) || (more && take_numbers(more + sizeof word - 1, fan, 4)))
        return -1;
    memcpy(p->origin, place, sizeof p->origin);
    memcpy(p->column, place + 3, sizeof p->column);
    memcpy(p->row, place + 6, sizeof p->row);
    p->tip = fan[0];
    p->radius[0] = fan[1];
    p->radius[1] = fan[2];
    p->angle = fan[3];
    return !more || (fan[1] >= 0 && fan[2] > fan[1] && fan[3] > 0 && fan[3] <= 180) ? 0 : -1;
}

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

bool placed_shows(const placed *p, int column, int row)
{
    const double x = length(p->column) * (column - .5 * (p->columns - 1)), z = p->tip + length(p->row) * row;
    const double away = sqrt(x * x + z * z);
    return !p->fan || (away >= p->radius[0] && away <= p->radius[1] && fabs(atan2(x, z)) <= .5 * p->angle * M_PI / 180);
}

/* The next line, of which `want` says what is expected of it. */
static int next_line(in *s, char **line, const char *want, err *e)
{
    const int64_t got = in_line(s, line, NULL, e);
    if (got == -1)
        return bad(s, e, want);
    return got < 0 ? -1 : 0;
}

static int read_head(placed *p, in *s, err *e)
{
    static const char mark[] = "# us-slice:", place[] = "'# us-slice:' and nine numbers, or those of a fan";
    char *line;
    double side[2];
    if (next_line(s, &line, "P5 or P6", e))
        return -1;
    if (strcmp(line, "P5") != 0 && strcmp(line, "P6") != 0)
        return bad(s, e, "P5 or P6");
    p->channels = line[1] == '5' ? 1 : 3;
    if (next_line(s, &line, place, e))
        return -1;
    if (strncmp(line, mark, sizeof mark - 1) != 0 || take_place(p, line + sizeof mark - 1))
        return bad(s, e, place);
    if (next_line(s, &line, "columns and rows", e))
        return -1;
    if (take_numbers(line, side, 2))
        return bad(s, e, "columns and rows");
    for (int i = 0; i < 2; i++)
        if (!(side[i] >= 1 && side[i] <= PLACED_SIDE_MOST && side[i] == (int)side[i]))
            return bad(s, e, "columns and rows of 1 to 16384");
    p->columns = (int)side[0];
    p->rows = (int)side[1];
    if (next_line(s, &line, "255", e))
        return -1;
    return strcmp(line, "255") != 0 ? bad(s, e, "255") : 0;
}

/* Piece by piece: a head may say more than there is. */
static int read_pixels(placed *p, in *s, err *e)
{
    int64_t capacity = 0, size = 0;
    const int64_t all = (int64_t)p->columns * p->rows * p->channels;
    while (size < all) {
        const int64_t part = all - size < 1 << 20 ? all - size : 1 << 20;
        if (MEM_ROOM(&p->pixel, &capacity, size + part, "an image", e))
            return -1;
        const int64_t got = in_read(s, p->pixel + size, (size_t)part, e);
        if (got < 0)
            return -1;
        size += got;
        if (got < part)
            return err_set(e, in_name(s), 0, "ends after %lld of %lld bytes of pixels", (long long)size,
                           (long long)all);
    }
    return 0;
}

int placed_read(placed *p, in *s, err *e)
{
    *p = (placed){0};
    if (read_head(p, s, e))
        return -1;
    if (!read_pixels(p, s, e))
        return 0;
    placed_free(p);
    return -1;
}

void placed_free(placed *p)
{
    free(p->pixel);
    *p = (placed){0};
}
