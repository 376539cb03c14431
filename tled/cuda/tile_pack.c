#include "tled/cuda/tile_pack.h"

#include "mesh/lattice.h"

#include <string.h>

void tile_pack_begin(tile_pack *k, const int grid[3])
{
    memcpy(k->grid, grid, sizeof k->grid);
    memset(k->node, 0xff, sizeof k->node);
    memset(k->cell, 0, sizeof k->cell);
    k->places = 0;
}

/* Where corner c of a cell is, from its low corner. */
static int32_t step_to(const tile_pack *k, int c)
{
    const int32_t *way = lattice_vtk[c];
    return way[0] + k->grid[0] * (way[1] + k->grid[1] * way[2]);
}

/* How many corners of a cell are where a place wants them; -1: others are there. */
static int count_alike(const tile_pack *k, int32_t place, const int32_t node[8])
{
    int count = 0;
    if (k->cell[place])
        return -1;
    for (int c = 0; c < 8; c++) {
        const int32_t there = k->node[place + step_to(k, c)];
        if (there >= 0 && there != node[c])
            return -1;
        count += there >= 0;
    }
    return count;
}

int32_t tile_pack_add(tile_pack *k, const int32_t node[8])
{
    const int *g = k->grid;
    int32_t best = -1;
    int most = -1;
    for (int32_t z = 0; z + 1 < g[2]; z++)
        for (int32_t y = 0; y + 1 < g[1]; y++)
            for (int32_t x = 0; x + 1 < g[0]; x++) {
                const int32_t place = x + g[0] * (y + g[1] * z);
                const int count = count_alike(k, place, node);
                if (count > most) {
                    most = count;
                    best = place;
                }
            }
    if (best < 0)
        return -1;
    for (int c = 0; c < 8; c++)
        k->node[best + step_to(k, c)] = node[c];
    k->cell[best] = true;
    k->places += 8 - most;
    return best;
}
