#include "tests/bench/flops.h"

extern "C" {
#include "physics/forms.h"
#include "physics/hourglass_numbers.h"
}

#include <math.h>
#include <stdlib.h>
#include <string.h>

namespace
{

enum { MOST = 1000 };

flops tally; // of the one thread that asks; all here is its

// As a double. id: which of all results it is; 0: known when the source is compiled, and then nothing is left to do.
struct number {
    double x;
    int id;
    number() = default;
    number(double value) : x(value), id(0)
    {
    }
    number(double value, int which) : x(value), id(which)
    {
    }
    explicit operator float() const
    {
        return (float)x;
    }
};

struct operation {
    int64_t *kind;
    number a, b;
};

operation done[MOST]; // since what is written twice counts once
int operations;
int numbers; // that came from outside

// A changed sign makes no other result, but is seen: of zeros too.
bool same(number a, number b)
{
    return a.id == b.id && a.x == b.x && signbit(a.x) == signbit(b.x);
}

number unknown(double x)
{
    return number(x, ++numbers);
}

// Its id is its place among those done, apart from those of numbers that come from outside.
number counted(int64_t *kind, double value, number a, number b)
{
    if (!a.id && !b.id)
        return number(value);
    for (int i = 0; i < operations; i++) {
        const operation &o = done[i];
        const bool turns = kind == &tally.add || kind == &tally.multiply;
        if (o.kind == kind && ((same(o.a, a) && same(o.b, b)) || (turns && same(o.a, b) && same(o.b, a))))
            return number(value, MOST + i);
    }
    if (operations == MOST)
        abort();
    done[operations] = {kind, a, b};
    ++*kind;
    return number(value, MOST + operations++);
}

void begin()
{
    tally = {0, 0, 0, 0};
    operations = numbers = 0;
}

number operator-(number a)
{
    return number(-a.x, a.id);
}

number operator+(number a, number b)
{
    return counted(&tally.add, a.x + b.x, a, b);
}

number operator-(number a, number b)
{
    return a + -b;
}

number operator*(number a, number b)
{
    return counted(&tally.multiply, a.x * b.x, a, b);
}

number operator/(number a, number b)
{
    return counted(&tally.divide, a.x / b.x, a, b);
}

number &operator+=(number &a, number b)
{
    return a = a + b;
}

number sqrt(number a)
{
    return counted(&tally.root, ::sqrt(a.x), a, a);
}

bool operator<(number a, number b)
{
    return a.x < b.x;
}

bool operator<=(number a, number b)
{
    return a.x <= b.x;
}

bool operator>(number a, number b)
{
    return a.x > b.x;
}

// As a float, of a float's size, since its bits are looked at: what comes of a guess is never known before.
struct guess {
    float x;
    guess() = default;
    explicit guess(number from) : x((float)from.x)
    {
    }
    explicit guess(int32_t from) : x((float)from)
    {
    }
    explicit guess(float from) : x(from)
    {
    }
    explicit operator int32_t() const
    {
        return (int32_t)x;
    }
    explicit operator number() const
    {
        return unknown(x);
    }
};

guess operator*(guess a, float b)
{
    tally.multiply++;
    return guess(a.x * b);
}

guess operator-(float a, guess b)
{
    tally.add++;
    return guess(a - b.x);
}

// What the headers include has been included above.
#define ELEMENT_FORCES_ALONE
#define double number
#define float guess
#include "tled/problem/node.h"
#undef double
#undef float

} // namespace

flops flops_of_element(hourglass_kind kind, int is_active, const double u[24], double result[24])
{
    begin();
    element_field at, force;
    element_corners *const from[3] = {&at.x, &at.y, &at.z}, *const to[3] = {&force.x, &force.y, &force.z};
    const element_shape shape = {{unknown(.25 / .002), unknown(.25 / .003), unknown(.25 / .004)},
                                 {unknown(3e-6), unknown(2e-6), unknown(1.5e-6)},
                                 unknown(1 / 2.4e-8)};
    const element_law law = {{unknown(1000), unknown(50000)}, {unknown(.01), unknown(.02), unknown(.03), unknown(.04)}};
    const element_fibre fibre = {{unknown(.6), unknown(0), unknown(.8)}, unknown(3000), {0, 0, 0, 0}, {0, 0}};
    for (int i = 0; i < 24; i++)
        from[i / 8]->at[i % 8] = unknown(u[i]);
    force = element_force(FORM_NEO_HOOKEAN, kind, at, shape, law, fibre, is_active);
    for (int i = 0; i < 24; i++) {
        number sum = unknown(0);
        sum += to[i / 8]->at[i % 8];
        if (result)
            result[i] = sum.x;
    }
    return tally;
}

flops flops_of_node(void)
{
    begin();
    const node_factors k = {unknown(1e-4), unknown(5e-5), unknown(.999), unknown(.999)};
    for (int a = 0; a < 3; a++) {
        const number sum = unknown(.1), mass_inverse = unknown(1000), gravity = unknown(-9.81);
        const number acceleration = gravity + -sum * mass_inverse;
        number u = unknown(0), v = node_begin(node_finish(unknown(.1), acceleration, k), acceleration, k);
        u += k.dt * v;
    }
    return tally;
}
