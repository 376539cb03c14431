#include "inspect/distance_print.h"

#include "base/lookup.h"
#include "base/mem.h"
#include "cli/text_table.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

int distance_report_join(distance_report *r, bool by_name, err *e)
{
    const distance_rows *rows = r->rows;
    lookup names = {0};
    r->back = mem_array(rows[0].count, sizeof *r->back, "regions", e);
    if (!r->back)
        return -1;
    /* The first ones belong together by their order, the others by their names. */
    const int64_t first = by_name ? 1 : rows[0].count;
    for (int64_t i = 0; i < first; i++)
        r->back[i] = rows[1].count ? i : -1;
    if (rows[1].count && lookup_add(&names, rows[1].row + 1, sizeof *rows[1].row, (int32_t)(rows[1].count - 1), e)) {
        lookup_free(&names);
        return -1;
    }
    for (int64_t i = first; i < rows[0].count; i++) {
        const int32_t place = lookup_find(&names, rows[1].row + 1, sizeof *rows[1].row, rows[0].row[i].name);
        r->back[i] = place < 0 ? -1 : 1 + place;
    }
    lookup_free(&names);
    return 0;
}

/* The symmetric Hausdorff distance of a region. */
static double hausdorff(const distance_report *r, int64_t row)
{
    const int64_t back = r->back[row];
    return back >= 0 ? fmax(r->rows[0].row[row].furthest, r->rows[1].row[back].furthest) : NAN;
}

/* ---- For people */

static int put_rows(const distance_rows *rows, const char *title, out *to, err *e)
{
    const char *const heads[] = {"<region", ">vertices", ">at\nborder", ">mean",         ">rms",
                                 ">median", ">95 %",     ">largest",    ">mean\nsigned", NULL};
    text_table *t = text_table_create(heads, e);
    double largest = 0;
    for (int64_t i = 0; i < rows->count; i++)
        largest = fmax(largest, rows->row[i].largest);
    const int decimals = text_table_decimals(largest, 5);
    for (int64_t i = 0; t && i < rows->count; i++) {
        const distance_row *row = &rows->row[i];
        const double figure[] = {row->mean, row->rms, row->median, row->most_of, row->largest, row->signed_mean};
        text_table_cell(t, "%s", row->name);
        text_table_count(t, row->vertices);
        text_table_count(t, row->border);
        for (int k = 0; k < 6; k++)
            text_table_number(t, figure[k], decimals);
    }
    out_format(to, "%s, mm:\n", title);
    return text_table_put(t, to, e);
}

static int put_hausdorff(const distance_report *r, out *to, err *e)
{
    const char *const heads[] = {"<region", ">distance", NULL};
    text_table *t = text_table_create(heads, e);
    double largest = 0;
    for (int64_t i = 0; i < r->rows[0].count; i++)
        largest = fmax(largest, hausdorff(r, i));
    for (int64_t i = 0; t && i < r->rows[0].count; i++)
        if (r->back[i] >= 0) {
            text_table_cell(t, "%s", r->rows[0].row[i].name);
            text_table_number(t, hausdorff(r, i), text_table_decimals(largest, 5));
        }
    out_text(to, "Symmetric Hausdorff distance, mm:\n");
    return text_table_put(t, to, e);
}

int distance_print_tables(const distance_report *r, out *to, err *e)
{
    out_format(to, "A: %s\nB: %s\n", r->surface[0]->file.name, r->surface[1]->file.name);
    if (put_rows(&r->rows[0], "From A to B", to, e))
        return -1;
    if (!r->rows[1].count)
        return 0;
    return put_rows(&r->rows[1], "From B to A", to, e) || put_hausdorff(r, to, e) ? -1 : 0;
}

/* ---- For programs */

static void put_number(double value, out *to)
{
    char text[NUM_TEXT];
    num_text(value, false, text);
    out_format(to, "\t%s", text);
}

void distance_print_tsv(const distance_report *r, out *to)
{
    out_text(to, "from\tregion\tvertices\tborder\tmean/mm\trms/mm\tmedian/mm\tp95/mm\tlargest/mm\tsigned/mm");
    out_text(to, r->rows[1].count ? "\thausdorff/mm\n" : "\n");
    for (int way = 0; way < 2; way++)
        for (int64_t i = 0; i < r->rows[way].count; i++) {
            const distance_row *row = &r->rows[way].row[i];
            const double figure[] = {row->mean, row->rms, row->median, row->most_of, row->largest, row->signed_mean};
            out_format(to, "%c\t%s\t%" PRId64 "\t%" PRId64, "AB"[way], row -> name, row -> vertices, row -> border);
            for (int k = 0; k < 6; k++)
                put_number(figure[k], to);
            if (r->rows[1].count)
                put_number(way ? NAN : hausdorff(r, i), to);
            out_text(to, "\n");
        }
}

void distance_print_points(const distance_surface *s, const distance_field *f, out *to)
{
    out_text(to, "vertex\tx/mm\ty/mm\tz/mm\tdistance/mm\tsigned/mm\tnearest.x/mm\tnearest.y/mm\tnearest.z/mm\n");
    for (int64_t v = 0; v < s->mesh.vertices; v++) {
        if (!s->used[v])
            continue;
        out_format(to, "%" PRId64, v + 1);
        for (int a = 0; a < 3; a++)
            put_number(s->mesh.position[3 * v + a], to);
        put_number(f->distance[v], to);
        put_number(f->side[v] == 0 ? NAN : f->side[v] * f->distance[v], to);
        for (int a = 0; a < 3; a++)
            put_number(f->nearest[3 * v + a], to);
        out_text(to, "\n");
    }
}
