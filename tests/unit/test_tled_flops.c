/* That tests/bench/flops.h counts what element.h and node.h do: its numbers give the very forces that doubles give, and
 * the counts are those of the formulas, added up here by hand.
 */
// needs: tests/bench/flops.cc
#include "tests/bench/flops.h"

#include "physics/element.h"

#include "tap.h"

static void displacements(double u[24])
{
    for (int i = 0; i < 24; i++)
        u[i] = 1e-4 * ((i * 7 % 11) - 5);
}

/* The same box, law and fibre as flops.cc's. */
static void forces(hourglass_kind kind, const double u[24], int is_active, double f[24])
{
    const element_shape shape = {{.25 / .002, .25 / .003, .25 / .004}, {3e-6, 2e-6, 1.5e-6}, 1 / 2.4e-8};
    const element_law law = {{1000, 50000}, {.01, .02, .03, .04}};
    const element_fibre fibre = {{.6, 0, .8}, 3000, {0, 0, 0, 0}, {0, 0}};
    element_field at;
    memcpy(&at, u, sizeof at);
    const element_field force = element_force(FORM_NEO_HOOKEAN, kind, at, shape, law, fibre, is_active);
    memcpy(f, &force, sizeof force);
}

static void same_forces(hourglass_kind kind, int is_active)
{
    double u[24], want[24], got[24];
    int differ = 0;
    displacements(u);
    forces(kind, u, is_active, want);
    flops_of_element(kind, is_active, u, got);
    for (int i = 0; i < 24; i++)
        differ += got[i] != want[i];
    ok(!differ, "numbers that count give the forces of doubles, %s: %d of 24 differ",
       is_active ? "a muscle contracts" : "none contracts", differ);
}

static void counts(void)
{
    double u[24];
    displacements(u);
    const flops rest = flops_of_element(HOURGLASS_ISOTROPIC, 0, u, NULL),
                active = flops_of_element(HOURGLASS_ISOTROPIC, 1, u, NULL),
                held = flops_of_element(HOURGLASS_PHYSICAL, 0, u, NULL), node = flops_of_node();
    /* modes: 8 + 8 + 7 additions a component, back 6 + 8 + 8; C - I: 3 x 3 + 3 x 4; J - 1: 2, then 5, then 4 as one
     * minor of H stands in both; 1 + J'; J^-1/3; pressure; stress; cofactor; P; sums at the nodes. */
    const int modes = 3 * (8 + 8 + 7), back = 3 * (6 + 8 + 8), strain = 9 + 12, dilation = 2 + 5 + 4 + 2,
              root = 1 + 2 * 4;
    const int pressure = 3, stress = 3, cofactor = 3 + 9, first = 9 * 2, nodes = 24;
    const int adds = modes + back + strain + dilation + 1 + root + pressure + stress + cofactor + first + nodes;
    ok(rest.add == adds, "%d additions an element, by hand %d", (int)rest.add, adds);
    /* The cofactor has five of J - 1's products. */
    const int gradient = 9, squares = 3 * 4 + 3 * 3, dilations = 6 + 7, roots = 1 + 2 * (3 + 4), scale = 1 + 3 + 3;
    const int times = gradient + squares + dilations + roots + scale + 6 + (18 - 5) + 27 + 3 * (3 + 4);
    ok(rest.multiply == times, "%d multiplications an element, by hand %d", (int)rest.multiply, times);
    ok(rest.divide == 0 && rest.root == 0, "no division, no root");
    ok(active.divide == 1 && active.root == 1, "a contraction: one division, one root");
    /* By physical control: w and f of four modes; six strains, their stresses, three shears and what they give, xyz;
     * the products f (x) w, added to P; 1/J and its powers, a law's four numbers; less k m. */
    const int turns = 2 * 4, stresses = 6 + 3 + 3, outer = 9 * 3;
    ok(held.add - rest.add == 6 * turns + stresses + outer + 9, "physical control: %d more additions",
       (int)(held.add - rest.add));
    ok(held.multiply - rest.multiply == 9 * turns + (6 + 18) + (6 + 3 + 6) + 9 + (36 + 9) + (1 + 1 + 4) - 12,
       "physical control: %d more multiplications", (int)(held.multiply - rest.multiply));
    ok(held.divide == 1, "and one division");
    /* F a0: 3 x 3 products and sums; its length: 3, 2; f(l), the operations of all
     * three branches; t; t m (x) a0; added. */
    ok(active.add - rest.add == 9 + 2 + 4 + 9, "a contraction: %d more additions", (int)(active.add - rest.add));
    ok(active.multiply - rest.multiply == 9 + 3 + 6 + 1 + 3 + 9, "a contraction: %d more multiplications",
       (int)(active.multiply - rest.multiply));
    /* dt/2 a stands in the step's end and in the next one's beginning. */
    ok(node.add == 3 * 4 && node.multiply == 3 * 5 && flops_sum(node) == 27, "a node: %d additions, %d multiplications",
       (int)node.add, (int)node.multiply);
}

int main(void)
{
    for (int is_active = 0; is_active < 2; is_active++) {
        same_forces(HOURGLASS_ISOTROPIC, is_active);
        same_forces(HOURGLASS_PHYSICAL, is_active);
    }
    counts();
    return done_testing();
}
