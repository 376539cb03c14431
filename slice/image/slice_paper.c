#include "slice/image/slice_paper.h"

#include <math.h>

/* The barycentric coordinates of a tetrahedron as affine functions of column and row, by Cramer's rule. A flat
 * tetrahedron contains no pixel. */
static void make_shares(double at[4][3], double share[4][3])
{
    double e[3][3], n[3][3], six = 0;
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++)
            e[k][a] = at[k + 1][a] - at[0][a];
    for (int k = 0; k < 3; k++) {
        const double *p = e[(k + 1) % 3], *q = e[(k + 2) % 3];
        for (int a = 0; a < 3; a++)
            n[k][a] = p[(a + 1) % 3] * q[(a + 2) % 3] - p[(a + 2) % 3] * q[(a + 1) % 3];
    }
    for (int a = 0; a < 3; a++)
        six += e[0][a] * n[0][a];
    share[0][0] = 1;
    share[0][1] = share[0][2] = 0;
    for (int k = 1; k < 4; k++) {
        share[k][1] = n[k - 1][0] / six;
        share[k][2] = n[k - 1][1] / six;
        share[k][0] = -(n[k - 1][0] * at[0][0] + n[k - 1][1] * at[0][1] + n[k - 1][2] * at[0][2]) / six;
        for (int i = 0; i < 3; i++)
            share[0][i] -= share[k][i];
    }
    if (six == 0)
        share[0][0] = (double)NAN;
}

static int32_t whole(double x, double most)
{
    return x > 0 ? (int32_t)fmin(ceil(x), most) : 0;
}

static void make_piece(slice_paper_tet *to, const slice_tets *t, const slice_cells *c, int32_t tet,
                       const double last[2])
{
    double at[4][3], low[2] = {(double)INFINITY, (double)INFINITY}, high[2] = {-(double)INFINITY, -(double)INFINITY};
    slice_piece *p = &to->piece;
    *p = (slice_piece){.tet = tet, .inside = true};
    for (int k = 0; k < 4; k++)
        for (int a = 0; a < 3; a++) {
            at[k][a] = t->at[t->node[4 * (int64_t)tet + k]].at[a];
            if (a < 2) {
                low[a] = fmin(low[a], at[k][a]);
                high[a] = fmax(high[a], at[k][a]);
            }
        }
    make_shares(at, to->share);
    for (int k = 0; k < 4; k++) {
        const double *place = t->place + 3 * (int64_t)t->node[4 * (int64_t)tet + k];
        for (int a = 0; a < 3; a++) {
            p->place[a] += SLICE_ONE * to->share[k][0] * place[a];
            p->across[a] += SLICE_ONE * to->share[k][1] * place[a];
            p->down[a] += SLICE_ONE * to->share[k][2] * place[a];
            p->inside &= place[a] >= .5 && place[a] <= c->size[a] + .5;
        }
    }
    /* A pixel more than it covers: what is on a face may be past its corners by a rounding. */
    to->low = whole(low[0] - 1, last[0] + 1);
    to->high = whole(high[0] + 2, last[0] + 1);
    p->first = whole(low[1] - 1, last[1] + 1);
    p->end = whole(high[1] + 2, last[1] + 1);
}

void slice_paper_make(const slice_tets *t, const slice_cells *c, const int32_t *list, int64_t count,
                      const double last[2], slice_paper_tet *to)
{
    for (int64_t i = 0; i < count; i++)
        make_piece(&to[i], t, c, list[i], last);
}

typedef struct search {
    const slice_lanes *l;
    const slice_fill *f;
    const slice_paper_tet *tet;
    const int32_t *list;
    int64_t count;
    slice_places *to;
    int32_t row;
    int64_t offset;
} search;

static bool holds(const slice_paper_tet *t, int32_t column, int32_t row)
{
    if (column < t->low || column >= t->high || row < t->piece.first || row >= t->piece.end)
        return false;
    for (int k = 0; k < 4; k++)
        if (!(t->share[k][0] + t->share[k][1] * column + t->share[k][2] * row >= -SLICE_PAPER_ON))
            return false;
    return true;
}

/* The first tetrahedron in the list that contains the pixel, or NULL. */
static const slice_paper_tet *find(const search *s, int32_t column)
{
    for (int64_t i = 0; i < s->count; i++)
        if (holds(&s->tet[s->list[i]], column, s->row))
            return &s->tet[s->list[i]];
    return NULL;
}

static void sample_line(const search *s, const slice_paper_tet *t, int32_t from, int32_t end)
{
    if (t)
        s->l->line(s->f, &t->piece, s->row, from, end, s->offset, s->to);
}

/* An interval of a row, whose ends are in the tetrahedra p and q. */
typedef struct interval {
    int32_t a, z;
    const slice_paper_tet *p, *q;
} interval;

/* Samples an interval, or puts its halves on the stack. Where both ends are outside the mesh, pixels between them may
 * still be inside. */
static int divide(const search *s, interval i, interval half[2])
{
    if (i.p == i.q && (i.p || i.a == i.z)) {
        sample_line(s, i.p, i.a, i.z + 1);
        return 0;
    }
    if (i.z - i.a < 2) {
        sample_line(s, i.p, i.a, i.a + 1);
        sample_line(s, i.q, i.z, i.z + 1);
        return 0;
    }
    const int32_t m = i.a + (i.z - i.a + 1) / 2;
    half[0] = (interval){m, i.z, m < i.z ? find(s, m) : i.q, i.q};
    half[1] = (interval){i.a, m - 1, i.p, m - 1 > i.a ? find(s, m - 1) : i.p};
    return 2;
}

/* The paper's recursion, with a stack of intervals: one for each time that a row of SLICE_SIDE_MOST pixels can be
 * halved, and the two of the last time. */
static void fill_row(const search *s, int32_t a, int32_t z)
{
    interval stack[20] = {{a, z, find(s, a), find(s, z)}};
    int count = 1;
    while (count > 0) {
        count--;
        count += divide(s, stack[count], stack + count);
    }
}

void slice_paper_fill(const slice_lanes *l, const slice_fill *f, const slice_paper_tet *tet, const int32_t *list,
                      int64_t count, int32_t first, int32_t end, slice_places *to)
{
    search s = {l, f, tet, list, count, to, 0, 0};
    l->clear(f->black, (int64_t)(end - first) * to->stride, to);
    for (s.row = first; s.row < end; s.row++, s.offset += to->stride)
        for (int k = 0; k < 2; k++) {
            int32_t a = f->shown[s.row].from[k], z = f->shown[s.row].to[k] - 1;
            if (a <= z)
                fill_row(&s, a, z);
        }
}
