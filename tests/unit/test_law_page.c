/* The laws in sinew-laws(7) are those of physics/law.c, and the figures there are what the code of their forms gives.
 * After a change of a law, put what `test_law_page print` prints between the two marked lines of the page. Run from
 * the top of the checkout.
 */
#include "model/known.h"
#include "physics/element.h"
#include "physics/fibre.h"
#include "physics/fibre_kind.h"
#include "physics/law.h"

#include "page_table.h"

#include <math.h>

static const char begin[] = ".\\\" laws\n", end[] = ".\\\" end laws\n";

/* The values that the figures are for: of every key that is the last of its group in a law. 0: there is none. */
static const double example[LAW_OWN_KEYS] = {
    [LAW_E] = 3000,  [LAW_nu] = .45,   [LAW_c10] = 2500, [LAW_c01] = 500, [LAW_K] = 1e5,    [LAW_c20] = 1175,
    [LAW_mu] = 3000, [LAW_lock] = 1.4, [LAW_c1] = 1000,  [LAW_c2] = 3,    [LAW_mu1] = 1000, [LAW_a1] = -4,
    [LAW_c] = 2000,  [LAW_bf] = 8,     [LAW_bt] = 2,     [LAW_bfs] = 4};

/* Along the bar, which fibres go along too, and in *across beside it, with a lateral stretch. */
static double stresses(const law_row *of, const double *c, const double *value, double stretch, double lateral,
                       double *across)
{
    const law_moduli at = of->moduli(value);
    fibre_local fibres = {.along = {1, 0, 0}};
    const element_tensor h = {.xx = stretch - 1, .yy = lateral - 1, .zz = lateral - 1};
    if (of->form == FORM_LINEAR) {
        const double trace = h.xx + 2 * h.yy, lambda = at.bulk - 2. / 3 * at.mu;
        *across = lambda * trace + 2 * at.mu * h.yy;
        return lambda * trace + 2 * at.mu * h.xx;
    }
    if (of->fibres)
        of->fibres(value, &fibres.of);
    const fibre_set set = fibre_set_of(&fibres, 1);
    const element_tensor p = element_sum(form_stress(of->form, h, c), fibre_stress(h, &set, 1));
    *across = p.yy;
    return p.xx;
}

/* Force by area at rest of a bar with free sides, Pa: the lateral stretch is found by bisection. */
static double pulled(const law_row *of, const double *value, double stretch)
{
    double c[FORM_NUMBERS] = {0}, low = .5, high = 2, across, stress = NAN;
    of->fill(value, c);
    for (int i = 0; i < 100; i++) {
        const double lateral = (low + high) / 2;
        stress = stresses(of, c, value, stretch, lateral, &across);
        *(across < 0 ? &low : &high) = lateral;
    }
    return stress;
}

static int last_of(unsigned group)
{
    int key = law_next_key(group, 0);
    for (int next = key; next >= 0; next = law_next_key(group, next + 1))
        key = next;
    return key;
}

/* In small letters, and no symbol, such as c01. */
static bool begins_with_word(const char *text)
{
    const size_t letters = strspn(text, "abcdefghijklmnopqrstuvwxyz");
    return letters > 1 && (!text[letters] || strchr(" ,'", text[letters]));
}

static void print_key(out *o, int key, const char *also)
{
    char name[64], words[KNOWN_WORDS];
    snprintf(name, sizeof name, "material.%s", law_key_name((law_key)key));
    const known *k = known_find(name);
    const bool word = begins_with_word(k->meaning);
    known_words(k, words);
    out_format(o, ".It Cm %s\n%c%s: %s%s.\n", law_key_name((law_key)key), k->meaning[0] - (word ? 'a' - 'A' : 0),
               k->meaning + 1, words, also);
}

/* "One of nu and K is given." */
static void print_choices(out *o, const law_row *of)
{
    for (int g = 0; g < LAW_GROUPS; g++) {
        const int first = law_next_key(of->group[g], 0), last = first < 0 ? first : last_of(of->group[g]);
        if (first != last)
            out_format(o, ".Pp\nOne of\n.Cm %s\nand\n.Cm %s\nmust be given, and not both.\n",
                       law_key_name((law_key)first), law_key_name((law_key)last));
    }
}

static void print_figures(out *o, const law_row *of)
{
    double value[LAW_OWN_KEYS];
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        value[k] = NAN;
    out_format(o, ".Pp\nA bar%s with free sides has, with", of->fibres ? " along the fibres" : "");
    for (int g = 0; g < LAW_GROUPS && of->group[g]; g++) {
        const int key = last_of(of->group[g]);
        value[key] = example[key];
        out_format(o, "%s %s %g", g ? "," : "", law_key_name((law_key)key), value[key]);
    }
    out_format(o, ",\na stress (force by area at rest) of %.2f Pa at 1.2 of its length and %.2f Pa at 0.8.\n",
               pulled(of, value, 1.2), pulled(of, value, .8));
}

static void print_law(out *o, const law_row *of)
{
    out_format(o, ".Ss %s\n%s\n.Bd -literal -offset indent\nW = %s\n.Ed\n.Bl -tag -width 4n -compact\n", of->name,
               of->meaning, of->energy);
    for (int g = 0; g < LAW_GROUPS; g++)
        for (int k = law_next_key(of->group[g], 0); k >= 0; k = law_next_key(of->group[g], k + 1))
            print_key(o, k, "");
    for (int k = law_next_key(of->optional, 0); k >= 0; k = law_next_key(of->optional, k + 1))
        print_key(o, k, "; without it the term is left out");
    out_text(o, ".El\n");
    print_choices(o, of);
    print_figures(o, of);
    out_format(o, ".Pp\nComputed by\n.Xr %s 1 .\nSource: %s.\n", of->form < FORM_STEPPED ? "tled-run" : "msds-run",
               of->source);
}

static void print_kind(out *o, const fibre_kind *of)
{
    char needs[LAW_WORDS];
    fibre_kind_words(of->needs, needs);
    out_format(o, ".Ss fibre=%s\n%s\n.Bd -literal -offset indent\nW = %s\n.Ed\n.Bl -tag -width 4n -compact\n", of->name,
               of->meaning, of->energy);
    for (int k = LAW_FIBRE_KEYS_FIRST; k < LAW_ALL_KEYS; k++)
        if (fibre_kind_takes(of, k))
            print_key(o, k, "");
    out_format(o, ".El\n.Pp\nMust be given: %s; the others are 0 where they are not.\nSource: %s.\n", needs,
               of->source);
}

static void print(out *o)
{
    out_text(o, begin);
    for (int i = 0; law_at(i); i++)
        print_law(o, law_at(i));
    out_text(o, ".Ss Keys of every law\n.Bl -tag -width density -compact\n");
    for (int k = LAW_OWN_KEYS; k < LAW_FIBRE_KEYS_FIRST; k++)
        print_key(o, k, "");
    out_text(o, ".El\n");
    for (int i = 0; fibre_kind_at(i); i++)
        print_kind(o, fibre_kind_at(i));
    out_text(o, end);
}

/* Without them the page would have figures of values that nobody chose. */
static void has_examples(const law_row *of)
{
    bool given = true;
    for (int g = 0; g < LAW_GROUPS && of->group[g]; g++) {
        const int key = last_of(of->group[g]);
        if (example[key] == 0) {
            printf("# example[] has no %s\n", law_key_name((law_key)key));
            given = false;
        }
    }
    ok(given, "%s: each of its keys has an example", of->name);
}

int main(int argc, char **argv)
{
    if (argc > 1 && !strcmp(argv[1], "print"))
        return page_print(print);
    page_test("man/sinew-laws.7", begin, print, "its laws are physics/law.c's");
    const double neo[] = {[LAW_E] = 3000, [LAW_nu] = .45};
    const double mooney[] = {[LAW_nu] = NAN, [LAW_c10] = 2500, [LAW_c01] = 500, [LAW_K] = 1e5};
    for (int i = 0; law_at(i); i++)
        has_examples(law_at(i));
    near_(pulled(law_find("neo-hookean"), neo, 1.2), 502.2590, 1e-4, "neo-hookean, 1.2");
    near_(pulled(law_find("mooney-rivlin"), mooney, 1.2), 2882.59, 1e-2, "mooney-rivlin, 1.2");
    near_(pulled(law_find("mooney-rivlin"), mooney, .8), -4677.80, 1e-2, "mooney-rivlin, 0.8");
    near_(pulled(law_find("linear"), neo, 1.2), 600, 1e-9, "linear, 1.2: E / 5");
    return done_testing();
}
