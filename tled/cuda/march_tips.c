#include "tled/cuda/march_tips.h"

#include "base/mem.h"
#include "mesh/lattice.h"
#include "tled/cuda/march_cells.h"
#include "tled/tiles/lattice_sheet.h"

#include <stdlib.h>
#include <string.h>

/* Which corner of a tip's element corner c of VTK's order is. */
static int corner_of(const march *m, int c)
{
    const int32_t *at = lattice_vtk[c];
    return at[m->axis[0]] + 2 * at[m->axis[1]] + 4 * at[m->axis[2]];
}

/* to: of the tip; its elements' directions go where those of tips stand. */
static void put_tip(const march *m, const tled_problem *p, int32_t node, const int32_t *special, march_tip *to)
{
    const int64_t along = march_along_tips(m) + (to - m->tip);
    for (int i = 0; i < 8; i++) {
        const int32_t corner = p->corner[8 * (int64_t)node + i], element = corner / 8;
        to[i] = (march_tip){.corner = -1};
        if (corner >= 8 * p->elements)
            continue;
        to[i].corner = corner_of(m, corner % 8);
        to[i].special = special[element];
        if (m->families)
            march_along_put(m, p, element, along + i);
        for (int c = 0; c < 8; c++)
            to[i].node[corner_of(m, c)] = m->order[p->element_node[8 * (int64_t)element + c]];
    }
}

int march_tips_list(march *m, const tled_problem *p, const int32_t *sheet, const int32_t *special, err *e)
{
    if (!m->tips)
        return 0;
    m->tip = mem_array(m->tips, 8 * sizeof *m->tip, "the march", e);
    if (!m->tip)
        return -1;
    for (int32_t n = 0; n < p->nodes; n++)
        if (sheet[n] == SHEET_TIP)
            put_tip(m, p, n, special, m->tip + 8 * (int64_t)(m->order[n] - m->tip_first));
    return 0;
}

int march_tips_add(march *m, err *e)
{
    const int64_t more = (m->tips + MARCH_TIPS - 1) / MARCH_TIPS;
    if (!m->tips)
        return 0;
    march_unit *unit = mem_array(m->units + more, sizeof *unit, "the march", e);
    if (!unit)
        return -1;
    memcpy(unit, m->unit, (size_t)m->units * sizeof *unit);
    for (int64_t base = 0; base < m->tips; base += MARCH_TIPS) {
        const int64_t left = m->tips - base;
        unit[m->units++] = (march_unit){.base = (int32_t)base, .tips = left < MARCH_TIPS ? (int32_t)left : MARCH_TIPS};
    }
    free(m->unit);
    m->unit = unit;
    return 0;
}
