#include "msds/problem/cavity.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* A face of an element, for a while: its nodes as they turn outward, and in ascending order. */
typedef struct face {
    int32_t sorted[3], node[3];
    int32_t cavity; /* -1: of tissue */
} face;

int cavity_of(const msds_cavity *list, int cavities, int32_t volume)
{
    for (int i = 0; i < cavities; i++)
        if (list[i].volume == volume)
            return i;
    return -1;
}

static void swap_if(int32_t *a, int32_t *b)
{
    const int32_t spare = *a;
    if (*a > *b) {
        *a = *b;
        *b = spare;
    }
}

static void sort_nodes(face *f)
{
    memcpy(f->sorted, f->node, sizeof f->sorted);
    swap_if(&f->sorted[0], &f->sorted[1]);
    swap_if(&f->sorted[1], &f->sorted[2]);
    swap_if(&f->sorted[0], &f->sorted[1]);
}

static int by_nodes(const void *a, const void *b)
{
    const face *x = a, *y = b;
    for (int c = 0; c < 3; c++)
        if (x->sorted[c] != y->sorted[c])
            return x->sorted[c] < y->sorted[c] ? -1 : 1;
    return (x->cavity > y->cavity) - (x->cavity < y->cavity);
}

/* The faces of cavities, and those of tissue that may lie on them. */
typedef struct faces {
    face *list;
    int64_t count, room;
} faces;

static int add_faces(faces *f, const int32_t n[4], int32_t of, const uint8_t *on, err *e)
{
    static const int corner[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (int i = 0; i < 4; i++) {
        face to = {.node = {n[corner[i][0]], n[corner[i][1]], n[corner[i][2]]}, .cavity = of};
        if (of < 0 && !(on[to.node[0]] && on[to.node[1]] && on[to.node[2]]))
            continue;
        if (MEM_ROOM(&f->list, &f->room, f->count + 1, "walls of cavities", e))
            return -1;
        sort_nodes(&to);
        f->list[f->count++] = to;
    }
    return 0;
}

static int64_t largest_node(const int32_t *element_node, int64_t elements)
{
    int64_t largest = 0;
    for (int64_t i = 0; i < 4 * elements; i++)
        largest = element_node[i] > largest ? element_node[i] : largest;
    return largest;
}

/* A face that two elements of different volumes have is a wall of each that is a cavity. */
static int64_t pair_faces(const faces *f, cavity_wall *to)
{
    int64_t count = 0;
    for (int64_t i = 0; i + 1 < f->count; i++) {
        const face *pair[2] = {&f->list[i], &f->list[i + 1]};
        if (memcmp(pair[0]->sorted, pair[1]->sorted, sizeof pair[0]->sorted) != 0)
            continue;
        for (int k = 0; k < 2 && pair[0]->cavity != pair[1]->cavity; k++)
            if (pair[k]->cavity >= 0) {
                memcpy(to[count].node, pair[k]->node, sizeof to->node);
                to[count++].cavity = pair[k]->cavity;
            }
        i++;
    }
    return count;
}

static int find_faces(faces *f, const msds_cavity *list, int cavities, const int32_t *element_node,
                      const int32_t *volume, int64_t elements, err *e)
{
    uint8_t *on = mem_array(largest_node(element_node, elements) + 1, 1, "walls of cavities", e);
    int failed = !on;
    for (int64_t t = 0; !failed && t < elements; t++)
        for (int c = 0; c < 4 && cavity_of(list, cavities, volume[t]) >= 0; c++)
            on[element_node[4 * t + c]] = 1;
    for (int64_t t = 0; !failed && t < elements; t++)
        failed = add_faces(f, element_node + 4 * t, cavity_of(list, cavities, volume[t]), on, e);
    free(on);
    return failed ? -1 : 0;
}

int64_t cavity_walls(const msds_cavity *list, int cavities, const int32_t *element_node, const int32_t *volume,
                     int64_t elements, cavity_wall **walls, err *e)
{
    faces f = {.count = 0};
    int64_t count = -1;
    *walls = NULL;
    if (!find_faces(&f, list, cavities, element_node, volume, elements, e) &&
        (*walls = mem_array(f.count + 1, sizeof **walls, "walls of cavities", e))) {
        if (f.count)
            qsort(f.list, (size_t)f.count, sizeof *f.list, by_nodes);
        count = pair_faces(&f, *walls);
    }
    free(f.list);
    return count;
}
