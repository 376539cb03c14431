#include "msds/cpu/factor.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

enum {
    PANEL = 32,    /* columns that are eliminated before the rest of a front is updated */
    TRIANGLE = 16, /* columns of a triangle that is solved plainly */
    FAIL_MEMORY = -2
};

static int64_t size_of(const front *t)
{
    return 3 * (t->columns + t->rows);
}

/* Where a node's place stands in a front, in nodes. */
static int64_t local_of(const front *t, int32_t place)
{
    int64_t low = 0, high = t->rows - 1;
    if (place < t->first + t->columns)
        return place - t->first;
    while (low < high) {
        int64_t middle = (low + high) / 2;
        if (t->row[middle] < place)
            low = middle + 1;
        else
            high = middle;
    }
    return t->columns + low;
}

/* Adds a block (row by row, or its transpose) at local nodes row, column. */
static void add_block(double *a, int64_t size, int64_t row, int64_t column, const double *b, bool transposed)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            a[(3 * column + j) * size + 3 * row + i] += transposed ? b[3 * j + i] : b[3 * i + j];
}

static void assemble(const factor *f, const front *t, double *a)
{
    const dissection *d = &f->tree;
    const int64_t size = size_of(t);
    for (int64_t c = 0; c < t->columns; c++) {
        int32_t node = d->order[t->first + c];
        add_block(a, size, c, c, f->k->diagonal + 9 * (int64_t)node, false);
        for (int64_t i = d->start[node]; i < d->start[node + 1]; i++) {
            const int32_t spring = d->link[i], *ends = f->p->spring[spring].node;
            int32_t place = d->place[ends[0] == node ? ends[1] : ends[0]];
            if (place > t->first + c) /* rows: the other's; the block's rows are those of ends[0] */
                add_block(a, size, local_of(t, place), c, f->k->block + 9 * (int64_t)spring, ends[0] == node);
        }
    }
}

/* What a child left, added where its rows stand. */
static void extend(const factor *f, int64_t child, double *a, int64_t size)
{
    const front *t = &f->tree.front[child];
    const double *left = f->of[child].left;
    const int64_t rows = 3 * t->rows;
    for (int64_t j = 0; j < rows; j++) {
        double *to = a + (3 * (int64_t)t->above[j / 3] + j % 3) * size;
        for (int64_t i = j; i < rows; i++)
            to[3 * (int64_t)t->above[i / 3] + i % 3] += left[j * rows + i];
    }
}

/* Columns [from, to) of the lower triangle. Returns the column whose pivot is not above 0, or -1. */
static int64_t eliminate_panel(double *a, int64_t size, int64_t from, int64_t to)
{
    for (int64_t k = from; k < to; k++) {
        double *column = a + k * size;
        if (!(column[k] > 0))
            return k;
        column[k] = sqrt(column[k]);
        double inverse = 1 / column[k];
        for (int64_t i = k + 1; i < size; i++)
            column[i] *= inverse;
        for (int64_t j = k + 1; j < to; j++)
            for (int64_t i = j; i < size; i++)
                a[j * size + i] -= column[j] * column[i];
    }
    return -1;
}

/* A pivot this much smaller than it was before elimination is rounding: nothing holds that part. */
static const double lost = 1e-11;

static int64_t eliminate(const factor *f, double *a, int64_t size, int64_t columns, const double *before)
{
    for (int64_t from = 0; from < columns; from += PANEL) {
        int64_t to = from + PANEL < columns ? from + PANEL : columns;
        if (f->stop && atomic_load(f->stop))
            return from;
        int64_t bad = eliminate_panel(a, size, from, to);
        if (bad >= 0)
            return bad;
        for (int64_t k = from; k < to; k++)
            if (a[k * size + k] * a[k * size + k] < lost * before[k])
                return k;
        for (int64_t j = to; j < size; j += 4)
            f->loops->update(a + j * size + j, size, a + from * size + j, a + from * size + j, size - j,
                             size - j < 4 ? size - j : 4, to - from);
    }
    return -1;
}

/* The panel as float, and what is left to the parent. */
static int take(factor_front *o, const front *t, const double *a)
{
    const int64_t size = size_of(t), columns = 3 * t->columns, rows = 3 * t->rows;
    for (int64_t i = 0; i < size * columns; i++)
        o->panel[i] = (float)a[i];
    o->left = rows ? malloc((size_t)rows * (size_t)rows * sizeof *o->left) : NULL;
    if (rows && !o->left)
        return -1;
    for (int64_t j = 0; j < rows; j++)
        memcpy(o->left + j * rows + j, a + (columns + j) * size + columns + j, (size_t)(rows - j) * sizeof *a);
    return 0;
}

static int32_t factor_front_of(factor *f, int64_t number)
{
    const front *t = &f->tree.front[number];
    factor_front *o = &f->of[number];
    const int64_t size = size_of(t);
    double *a = calloc((size_t)(size * size) + 1, sizeof *a);
    double *before = malloc((size_t)(3 * t->columns + 1) * sizeof *before);
    int32_t result = FAIL_MEMORY;
    if (!a || !before)
        goto out;
    assemble(f, t, a);
    for (int64_t k = 0; k < 3 * t->columns; k++)
        before[k] = f->k->diagonal[9 * (int64_t)f->tree.order[t->first + k / 3] + 4 * (k % 3)];
    for (int c = 0; c < 2; c++)
        if (o->child[c] >= 0) {
            extend(f, o->child[c], a, size);
            free(f->of[o->child[c]].left);
            f->of[o->child[c]].left = NULL;
        }
    int64_t bad = eliminate(f, a, size, 3 * t->columns, before);
    if (bad >= 0)
        result = f->tree.order[t->first + bad / 3];
    else if (!take(o, t, a))
        result = -1;
out:
    free(a);
    free(before);
    return result;
}

static void factor_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    factor *f = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        int64_t number = f->level[f->begin[f->at] + i];
        bool sound = true;
        for (int c = 0; c < 2; c++)
            sound = sound && (f->of[number].child[c] < 0 || f->failed[f->of[number].child[c]] == -1);
        const int64_t *child = f->of[number].child;
        if (sound)
            f->failed[number] = factor_front_of(f, number);
        else
            f->failed[number] = f->failed[f->failed[child[0]] != -1 ? child[0] : child[1]];
    }
}

static void run_level(factor *f, int64_t level, pool_work *work)
{
    f->at = level;
    pool_run(f->threads, f->begin[level + 1] - f->begin[level], 1, work, f);
}

/* The lower triangle, y = L^-1 y, and the rows below. */
static void forward_front(const lanes *loops, const float *panel, int64_t size, int64_t columns, double *y)
{
    for (int64_t from = 0; from < columns; from += TRIANGLE) {
        int64_t to = from + TRIANGLE < columns ? from + TRIANGLE : columns;
        for (int64_t k = from; k < to; k++) {
            const float *column = panel + k * size;
            y[k] /= (double)column[k];
            for (int64_t i = k + 1; i < to; i++)
                y[i] -= y[k] * (double)column[i];
        }
        loops->forward(y + to, panel + from * size + to, size, size - to, to - from, y + from);
    }
}

static void backward_front(const lanes *loops, const float *panel, int64_t size, int64_t columns, double *x)
{
    for (int64_t from = (columns - 1) / TRIANGLE * TRIANGLE; from >= 0; from -= TRIANGLE) {
        int64_t to = from + TRIANGLE < columns ? from + TRIANGLE : columns;
        loops->backward(x + from, panel + from * size + to, size, size - to, to - from, x + to);
        for (int64_t k = to - 1; k >= from; k--) {
            const float *column = panel + k * size;
            for (int64_t i = k + 1; i < to; i++)
                x[k] -= (double)column[i] * x[i];
            x[k] /= (double)column[k];
        }
    }
}

static void forward_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    factor *f = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        int64_t number = f->level[f->begin[f->at] + i];
        const front *t = &f->tree.front[number];
        factor_front *o = &f->of[number];
        for (int64_t c = 0; c < t->columns; c++)
            memcpy(o->value + 3 * c, f->load + 3 * (int64_t)f->tree.order[t->first + c], 3 * sizeof *o->value);
        memset(o->value + 3 * t->columns, 0, 3 * (size_t)t->rows * sizeof *o->value);
        for (int c = 0; c < 2; c++) {
            const front *below = o->child[c] < 0 ? NULL : &f->tree.front[o->child[c]];
            const double *share = below ? f->of[o->child[c]].value + 3 * below->columns : NULL;
            for (int64_t r = 0; below && r < below->rows; r++)
                for (int a = 0; a < 3; a++)
                    o->value[3 * (int64_t)below->above[r] + a] += share[3 * r + a];
        }
        forward_front(f->loops, o->panel, size_of(t), 3 * t->columns, o->value);
    }
}

static void backward_work(void *context, int64_t chunk, int64_t from, int64_t to)
{
    factor *f = context;
    (void)chunk;
    for (int64_t i = from; i < to; i++) {
        int64_t number = f->level[f->begin[f->at] + i];
        const front *t = &f->tree.front[number];
        factor_front *o = &f->of[number];
        const double *up = t->parent < 0 ? o->value : f->of[t->parent].value; /* the root has no rows */
        for (int64_t r = 0; r < t->rows; r++)
            memcpy(o->value + 3 * (t->columns + r), up + 3 * (int64_t)t->above[r], 3 * sizeof *up);
        backward_front(f->loops, o->panel, size_of(t), 3 * t->columns, o->value);
        for (int64_t c = 0; c < t->columns; c++)
            memcpy(f->result + 3 * (int64_t)f->tree.order[t->first + c], o->value + 3 * c, 3 * sizeof *o->value);
    }
}

void factor_forward(factor *f, const double *load)
{
    f->load = load;
    for (int64_t level = 0; level < f->levels; level++)
        run_level(f, level, forward_work);
}

void factor_backward(factor *f, double *result)
{
    f->result = result;
    for (int64_t n = 0; n < f->p->nodes; n++)
        if (f->tree.place[n] < 0)
            result[3 * n] = result[3 * n + 1] = result[3 * n + 2] = 0;
    for (int64_t level = f->levels - 1; level >= 0; level--)
        run_level(f, level, backward_work);
}

/* The front that eliminates a free node. */
static int64_t front_of(const factor *f, int64_t node)
{
    const dissection *d = &f->tree;
    int64_t low = 0, high = d->fronts - 1;
    while (low < high) { /* the first that ends past the node */
        int64_t middle = (low + high) / 2;
        if (d->front[middle].first + d->front[middle].columns <= d->place[node])
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

int64_t factor_path_length(const factor *f, int64_t node)
{
    int64_t number = front_of(f, node);
    return 3 * (f->of[number].above + f->tree.front[number].columns);
}

void factor_path(const factor *f, int64_t node, double *work, float *to, int64_t stride)
{
    int64_t number = front_of(f, node);
    for (int a = 0; a < 3; a++) {
        double *y = work, *next = work + f->largest;
        memset(y, 0, (size_t)size_of(&f->tree.front[number]) * sizeof *y);
        y[3 * (f->tree.place[node] - f->tree.front[number].first) + a] = 1;
        for (int64_t at = number; at >= 0;) {
            const front *t = &f->tree.front[at];
            const int64_t columns = 3 * t->columns, up = t->parent;
            forward_front(f->loops, f->of[at].panel, size_of(t), columns, y);
            for (int64_t i = 0; i < columns; i++)
                to[a * stride + 3 * f->of[at].above + i] = (float)y[i];
            if (up >= 0)
                memset(next, 0, (size_t)size_of(&f->tree.front[up]) * sizeof *next);
            for (int64_t r = 0; r < 3 * t->rows; r++)
                next[3 * (int64_t)t->above[r / 3] + r % 3] = y[columns + r];
            double *spare = y;
            y = next;
            next = spare;
            at = up;
        }
    }
}

int64_t factor_shared(const factor *f, int64_t a, int64_t b)
{
    const front *t = f->tree.front;
    int64_t x = front_of(f, a), y = front_of(f, b);
    while (x != y)
        if (t[x].depth >= t[y].depth)
            x = t[x].parent;
        else
            y = t[y].parent;
    return 3 * (f->of[x].above + t[x].columns);
}

double factor_dot(const factor *f, int64_t node, const float *path)
{
    double sum = 0;
    for (int64_t at = front_of(f, node); at >= 0; at = f->tree.front[at].parent) {
        const float *y = path + 3 * f->of[at].above;
        double part = 0;
        for (int64_t i = 0; i < 3 * f->tree.front[at].columns; i++)
            part += (double)y[i] * f->of[at].value[i];
        sum += part;
    }
    return sum;
}

void factor_add(factor *f, int64_t node, const float *path, double scale)
{
    for (int64_t at = front_of(f, node); at >= 0; at = f->tree.front[at].parent) {
        const float *y = path + 3 * f->of[at].above;
        for (int64_t i = 0; i < 3 * f->tree.front[at].columns; i++)
            f->of[at].value[i] += scale * (double)y[i];
    }
}

/* Fronts by depth, the deepest first, and their children. */
static int order_levels(factor *f, err *e)
{
    const dissection *d = &f->tree;
    f->of = mem_array(d->fronts, sizeof *f->of, "the factor", e);
    f->level = mem_array(d->fronts, sizeof *f->level, "the factor", e);
    f->failed = mem_array(d->fronts, sizeof *f->failed, "the factor", e);
    for (int64_t i = 0; i < d->fronts; i++)
        f->levels = d->front[i].depth >= f->levels ? d->front[i].depth + 1 : f->levels;
    f->begin = mem_array(f->levels + 1, sizeof *f->begin, "the factor", e);
    if (!f->of || !f->level || !f->failed || !f->begin)
        return -1;
    int64_t at = 0;
    for (int64_t level = 0; level < f->levels; level++) {
        for (int64_t i = 0; i < d->fronts; i++)
            if (d->front[i].depth == f->levels - 1 - level)
                f->level[at++] = i;
        f->begin[level + 1] = at;
    }
    for (int64_t i = 0; i < d->fronts; i++)
        f->of[i].child[0] = f->of[i].child[1] = -1;
    for (int64_t i = d->fronts - 1; i >= 0; i--) { /* parents before children */
        int64_t up = d->front[i].parent;
        f->of[i].above = up < 0 ? 0 : f->of[up].above + d->front[up].columns;
        int64_t length = 3 * (f->of[i].above + d->front[i].columns);
        f->path = length > f->path ? length : f->path;
        f->largest = size_of(&d->front[i]) > f->largest ? size_of(&d->front[i]) : f->largest;
    }
    for (int64_t i = 0; i < d->fronts; i++)
        if (d->front[i].parent >= 0) {
            int64_t *child = f->of[d->front[i].parent].child;
            child[child[0] >= 0] = i;
        }
    return 0;
}

static int allocate(factor *f, err *e)
{
    const dissection *d = &f->tree;
    for (int64_t i = 0; i < d->fronts; i++)
        f->numbers += size_of(&d->front[i]) * 3 * d->front[i].columns;
    double need = 1.3 * 4 * (double)f->numbers + 24 * (double)f->largest * (double)f->largest;
    if (need > (double)mem_available())
        return err_set(
            e, NULL, 0,
            "the factor that --exact needs would take some %.3g GB, and %.3g are free; expected a smaller mesh, or the "
            "conjugate gradients of --method fem",
            1e-9 * need, 1e-9 * (double)mem_available());
    for (int64_t i = 0; i < d->fronts; i++) {
        const front *t = &d->front[i];
        f->of[i].panel = mem_array(size_of(t) * 3 * t->columns, sizeof *f->of[i].panel, "the factor", e);
        f->of[i].value = mem_array(size_of(t), sizeof *f->of[i].value, "the factor", e);
        if (!f->of[i].panel || !f->of[i].value)
            return -1;
    }
    return 0;
}

int factor_make(factor *f, const msds_problem *p, const stiffness *k, const lanes *loops, pool *threads, err *e)
{
    f->p = p;
    f->k = k;
    f->loops = loops;
    f->threads = threads;
    return dissect(&f->tree, p, e) || order_levels(f, e) || allocate(f, e) ? -1 : factor_again(f, e);
}

/* About how many multiplications the fronts of a level take. */
static double work_of(const factor *f, int64_t level)
{
    double work = 0;
    for (int64_t i = f->begin[level]; i < f->begin[level + 1]; i++) {
        const front *t = &f->tree.front[f->level[i]];
        work += (double)t->columns * (double)size_of(t) * (double)size_of(t);
    }
    return work;
}

static void tell(const factor *f, double done, double all)
{
    const msds_progress now = {.what = "factoring the stiffness matrix", .share = done / all, .residual = NAN};
    if (f->listener)
        f->listener->at(f->listener->context, &now);
}

int factor_again(factor *f, err *e)
{
    double done = 0, all = 0;
    for (int64_t level = 0; level < f->levels; level++)
        all += work_of(f, level);
    for (int64_t level = 0; level < f->levels; level++) {
        tell(f, done, all);
        run_level(f, level, factor_work);
        done += work_of(f, level);
    }
    int32_t failed = f->failed[f->tree.fronts - 1];
    if (failed == FAIL_MEMORY)
        return err_memory(e, "the factor");
    if (failed >= 0)
        return err_set(
            e, NULL, 0,
            "nothing holds node %d's part of the model, so that the FEM has no unique solution; expected rigid nodes",
            (int)failed);
    return 0;
}

void factor_free(factor *f)
{
    for (int64_t i = 0; f->of && i < f->tree.fronts; i++) {
        free(f->of[i].panel);
        free(f->of[i].value);
        free(f->of[i].left);
    }
    free(f->of);
    free(f->level);
    free(f->begin);
    free(f->failed);
    dissect_free(&f->tree);
    *f = (factor){0};
}
