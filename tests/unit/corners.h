/* The corners of a hexahedron, and numbers at random by which tests move them. */
#ifndef SINEW_CORNERS_H
#define SINEW_CORNERS_H

/* In the order of an element's nodes: whether each lies at the upper end of x, y and z. */
static const int corner_of[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                    {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

/* From -1 to 1; the same ones in each run. */
static double chance(void)
{
    static unsigned seed = 11;
    seed = seed * 1664525 + 1013904223;
    return 2 * (double)(seed >> 8) / (1 << 24) - 1;
}

#endif
