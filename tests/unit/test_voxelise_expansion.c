// needs: voxelise/surfaces/expansion.c
/* Expansions against 128-bit integers: sums, products and signs of numbers that doubles would round. */
#include "tap.h"

#include "voxelise/surfaces/expansion.h"

#include <stdint.h>

__extension__ typedef __int128 wide;

static uint64_t seed = 1;

/* A whole number of up to `bits` bits, often with few of them set. */
static int64_t draw(int bits)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    uint64_t x = seed >> (64 - bits);
    if (seed & 1024)
        x &= x << 3;
    return seed & 2048 ? -(int64_t)x : (int64_t)x;
}

/* The expansion's value: exact, since its components are whole and their sum fits. */
static wide value(int n, const double *e)
{
    wide sum = 0;
    for (int i = 0; i < n; i++)
        sum += (wide)e[i];
    return sum;
}

static bool ordered(int n, const double *e)
{
    for (int i = 0; i < n; i++)
        if (e[i] == 0 || (i > 0 && fabs(e[i - 1]) >= fabs(e[i])))
            return false;
    return true;
}

static int sign(wide x)
{
    return (x > 0) - (x < 0);
}

int main(void)
{
    int sums = 0, products = 0, signs = 0, order = 0, tries = 200000;
    for (int t = 0; t < tries; t++) {
        double a[4], b[4], h[64], p[64];
        wide x = 0, y = 0;
        int n = 0, m = 0;
        for (int i = 0; i < 3; i++) {
            int64_t u = draw(50) * ((int64_t)1 << (i % 3)), v = draw(50);
            n = expansion_add(n, a, (double)u, h);
            for (int k = 0; k < n; k++)
                a[k] = h[k];
            m = expansion_add(m, b, (double)v, h);
            for (int k = 0; k < m; k++)
                b[k] = h[k];
            x += u, y += v;
        }
        int s = expansion_sum(n, a, m, b, h), q = expansion_product(n, a, m, b, p);
        sums += value(s, h) == x + y;
        products += value(q, p) == x * y;
        signs += expansion_sign(s, h) == sign(x + y) && expansion_sign(q, p) == sign(x * y);
        order += ordered(s, h) && ordered(q, p);
    }
    ok(sums == tries, "%d of %d sums are exact", sums, tries);
    ok(products == tries, "%d of %d products are exact", products, tries);
    ok(signs == tries, "%d of %d signs are right", signs, tries);
    ok(order == tries, "%d of %d results are in order and without zeros", order, tries);

    double big[2], small[2], h[4];
    int n = expansion_of_sum(1e16, 1, big), m = expansion_of_product(-1e8, 1e8, small);
    n = expansion_sum(n, big, m, small, h);
    ok(n == 1 && h[0] == 1, "1e16 + 1 - 1e8 1e8 is 1");
    n = expansion_of_product(0.1, 10, h);
    ok(n == 2 && h[0] > 0 && h[1] == 1, "10 times the double nearest to 0.1 is a little over 1");
    expansion_negate(n, h);
    ok(expansion_sign(n, h) == -1 && expansion_sign(0, h) == 0, "signs of a negative and of none");
    return done_testing();
}
