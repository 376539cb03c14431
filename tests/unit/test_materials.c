/* The table of materials: defaults, files, overrides, assignments, and nonsense. */
#include "model/materials.h"

#include "tap.h"

#include <math.h>
#include <string.h>

typedef int reading(model *m, in *s, err *e);

static int set(model *m, const char *assignment, err *e)
{
    return materials_set(m, &assignment, 1, e);
}

static int read_text(reading *reads, model *m, const char *text, err *e)
{
    in *s = in_memory(text, strlen(text), "m.txt", e);
    int status = s ? reads(m, s, e) : -1;
    if (s)
        in_close(s);
    return status;
}

static bool same(const material *a, double E, double nu, double density, double peak)
{
    return a->law == law_find("neo-hookean") && a->value[LAW_E] == E && a->value[LAW_nu] == nu &&
           a->density == density && a->peak == peak;
}

static void defaults(void)
{
    model m = {0};
    err e = {0};
    material a;
    ok(!materials_default(&m, &e) && model_count(&m, "material") == 1, "one material");
    ok(materials_find(&m, "tissue") == 0 && materials_find(&m, "Tissue") == -1, "tissue");
    ok(!materials_of(&m, 0, &a, &e) && same(&a, 3000, .49, 1000, 30000), "W&M's values");
    near_(material_mu(&a), 3000 / 2.98, 1e-9, "mu");
    near_(material_bulk(&a), 50000, 1e-7, "K");
    model_free(&m);
}

static void files(void)
{
    model m = {0};
    err e = {0};
    material a;
    ok(!read_text(materials_read, &m, "skin law=neo-hookean E=5e3 # c\nmuscle peak=0 nu=0.45 density=1060\n", &e),
       "a file is read: %s", e.text);
    ok(model_count(&m, "material") == 2 && materials_find(&m, "muscle") == 1, "its two materials, in order");
    ok(!materials_of(&m, 0, &a, &e) && same(&a, 5000, .49, 1000, 30000), "skin: what is not given is the default");
    ok(!materials_of(&m, 1, &a, &e) && same(&a, 3000, .45, 1060, 0), "muscle");
    ok(!read_text(materials_override, &m, "skin nu=.3\n", &e), "an override: %s", e.text);
    ok(!materials_of(&m, 0, &a, &e) && same(&a, 5000, .3, 1000, 30000), "changes what it gives only");
    ok(!read_text(materials_override, &m, "\n", &e), "an override without lines changes nothing");
    ok(!set(&m, "muscle.E=1e4", &e) && !set(&m, "muscle.law=neo-hookean", &e), "assignments");
    ok(!materials_of(&m, 1, &a, &e) && same(&a, 1e4, .45, 1060, 0), "change one value each");
    model_free(&m);
}

static void dots(void)
{
    model m = {0};
    err e = {0};
    material a;
    read_text(materials_read, &m, "left.cheek\nleft\n", &e);
    ok(!set(&m, "left.cheek.E=0.25", &e) && !materials_of(&m, 0, &a, &e) && a.value[LAW_E] == .25,
       "a name may hold dots: %s", e.text);
    model_free(&m);
}

static void refuse_file(const char *text, const char *want)
{
    model m = {0};
    err e = {0};
    ok(read_text(materials_read, &m, text, &e) == -1 && strstr(e.text, want), "refused: %s", e.text);
    model_free(&m);
}

static void refuse_override(const char *text, const char *want)
{
    model m = {0};
    err e = {0};
    materials_default(&m, &e);
    ok(read_text(materials_override, &m, text, &e) == -1 && strstr(e.text, want), "refused: %s", e.text);
    model_free(&m);
}

static void refuse_set(const char *text, const char *want)
{
    model m = {0};
    err e = {0};
    material a;
    materials_default(&m, &e);
    ok(set(&m, text, &e) == -1 && strstr(e.text, want), "%s is refused: %s", text, e.text);
    e = (err){0};
    ok(!materials_of(&m, 0, &a, &e) && same(&a, 3000, .49, 1000, 30000), "and changes nothing");
    model_free(&m);
}

/* Nonsense that stands in a model, not in a file. */
static void refuse_model(const char *array, double value, const char *want)
{
    model m = {0};
    err e = {0};
    material a;
    materials_default(&m, &e);
    model_find(&m, array)->f64[0] = value;
    ok(materials_of(&m, 0, &a, &e) == -1 && strstr(e.text, want), "%s = %g: %s", array, value, e.text);
    model_free(&m);
}

static void incomplete_models(void)
{
    model m = {0};
    err e = {0};
    material a;
    ok(set(&m, "tissue.E=1", &e) == -1 && strstr(e.text, "material.name"), "no table: %s", e.text);
    e = (err){0};
    materials_default(&m, &e);
    model_find(&m, "material.peak")->f64[0] = NAN;
    ok(!materials_of(&m, 0, &a, &e) && a.peak == 0, "a peak of nan is none");
    model_remove(&m, "material.peak");
    ok(!materials_of(&m, 0, &a, &e) && a.peak == 0, "so is a peak that is missing");
    ok(set(&m, "tissue.peak=5", &e) == -1 && strstr(e.text, "material.peak"), "%s", e.text);
    e = (err){0};
    model_set_text(model_find(&m, "material.law"), 0, "neo-hokean", &e);
    ok(materials_of(&m, 0, &a, &e) == -1 && strstr(e.text, "did you mean 'neo-hookean'?"), "%s", e.text);
    e = (err){0};
    model_remove(&m, "material.nu");
    model_set_text(model_find(&m, "material.law"), 0, "neo-hookean", &e);
    ok(materials_of(&m, 0, &a, &e) == -1 && strstr(e.text, "material.nu"), "a missing nu: %s", e.text);
    model_free(&m);
}

/* Between two materials: their own where the share is 0 or 1, within the bounds of side by side and across, and the
 * same whichever comes first. */
static void mixtures(void)
{
    const material a = {.law = law_at(0), .value = {3000, .45}, .density = 1000, .peak = 10};
    const material b = {.law = law_at(0), .value = {48000, .3}, .density = 1800, .peak = 30};
    const material_numbers one = material_numbers_of(&a), two = material_numbers_of(&b);
    const material_numbers none = material_mixed(&one, &two, 0), all = material_mixed(&one, &two, 1),
                           same = material_mixed(&one, &one, .3);
    near_(law_young(none.at_rest), 3000, 1e-9, "share 0: E of the first");
    near_(law_poisson(none.at_rest), .45, 1e-12, "and nu");
    near_(law_young(all.at_rest), 48000, 1e-7, "share 1: E of the second");
    near_(law_poisson(all.at_rest), .3, 1e-12, "and nu");
    near_(law_young(same.at_rest), 3000, 1e-9, "one material twice");
    for (int i = 1; i < 4; i++) {
        const double s = i / 4.;
        const material_numbers m = material_mixed(&one, &two, s), turned = material_mixed(&two, &one, 1 - s);
        double mu = m.at_rest.mu, beside = (1 - s) * material_mu(&a) + s * material_mu(&b);
        double across = 1 / ((1 - s) / material_mu(&a) + s / material_mu(&b));
        ok(mu > across && mu < beside, "share %g: mu %g is between %g and %g", s, mu, across, beside);
        ok(m.form == FORM_NEO_HOOKEAN && m.c[0] == mu && m.c[1] == m.at_rest.bulk, "and is the form's");
        near_(law_young(turned.at_rest), law_young(m.at_rest), 1e-8, "the other way round");
        near_(m.density, 1000 + 800 * s, 1e-9, "density by shares");
        near_(m.peak, 10 + 20 * s, 1e-12, "peak too");
    }
    const material_numbers half = material_mixed(&one, &two, .5);
    near_(half.at_rest.bulk, sqrt(material_bulk(&a) * material_bulk(&b)), 1e-8, "half and half: the geometric mean");
}

/* Of fung, whose shear its fibres have, and of another: the energy of the other goes by its share, as that of fibres
 * does. */
static void mixed_with_fibres(void)
{
    const char *const laws[] = {"neo-hookean", "mooney-rivlin", "yeoh", "veronda-westmann", "ogden"};
    material a = {.law = law_find("fung"), .density = 1000};
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        a.value[k] = NAN;
    material b = a;
    a.value[LAW_c] = 2000, a.value[LAW_bf] = 8, a.value[LAW_bt] = 2, a.value[LAW_bfs] = 4, a.value[LAW_nu] = .45;
    b.value[LAW_E] = 5000, b.value[LAW_nu] = .4, b.value[LAW_c10] = 700, b.value[LAW_c01] = 70;
    b.value[LAW_c20] = 90, b.value[LAW_c1] = 100, b.value[LAW_c2] = 2, b.value[LAW_mu1] = 800, b.value[LAW_a1] = -4;
    const material_numbers one = material_numbers_of(&a), itself = material_mixed(&one, &one, .3);
    ok(itself.c[0] == 0 && fabs(itself.c[1] / one.c[1] - 1) < 1e-12, "fung and fung: K alone");
    for (size_t i = 0; i < sizeof laws / sizeof *laws; i++) {
        b.law = law_find(laws[i]);
        const material_numbers two = material_numbers_of(&b), m = material_mixed(&one, &two, .25),
                               turned = material_mixed(&two, &one, .75);
        bool right = m.form == two.form;
        for (int k = 0; k < FORM_NUMBERS; k++) {
            const bool bulk = one.form == two.form ? k == 1 : two.c[k] == two.at_rest.bulk;
            const double of_share = k < form_moduli(two.form) ? two.c[k] / 4 : two.c[k];
            const double want = bulk ? m.at_rest.bulk : of_share;
            right =
                right && fabs(m.c[k] - want) <= 1e-12 * fabs(want) && fabs(turned.c[k] - want) <= 1e-12 * fabs(want);
        }
        ok(right, "fung, and %s by a share of a quarter", laws[i]);
    }
}

/* Material i: of mooney-rivlin, and its values, nan where none. */
static bool is_mooney(const model *m, int64_t i, double c10, double c01, double bulk, double nu)
{
    err e = {0};
    material a;
    if (materials_of(m, i, &a, &e)) {
        printf("# %s\n", e.text);
        return false;
    }
    double want[LAW_OWN_KEYS];
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        want[k] = NAN;
    want[LAW_nu] = nu, want[LAW_c10] = c10, want[LAW_c01] = c01, want[LAW_K] = bulk;
    bool same = !strcmp(a.law->name, "mooney-rivlin");
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        same = same && (isnan(want[k]) ? isnan(a.value[k]) : a.value[k] == want[k]);
    return same;
}

static void two_laws(void)
{
    model m = {0};
    err e = {0};
    material a;
    ok(!read_text(materials_read, &m, "skin\nfat law=mooney-rivlin c10=2500 K=1e5 c01=500 density=900\n", &e), "%s",
       e.text);
    ok(is_mooney(&m, 1, 2500, 500, 1e5, NAN), "a file of two laws");
    ok(!materials_of(&m, 0, &a, &e) && same(&a, 3000, .49, 1000, 30000), "the other has its own");
    ok(isnan(model_find(&m, "material.c10")->f64[0]) && isnan(model_find(&m, "material.E")->f64[1]),
       "nan where a law has no such key");
    const char *const change[] = {"skin.K=2e4", "skin.c01=0", "skin.c10=400", "skin.law=mooney-rivlin", "fat.nu=.4"};
    ok(!materials_set(&m, change, 5, &e), "another law, in any order: %s", e.text);
    ok(is_mooney(&m, 0, 400, 0, 2e4, NAN), "has its keys, and none of the old law's");
    ok(is_mooney(&m, 1, 2500, 500, NAN, .4), "nu drops K");
    ok(!model_find(&m, "material.E"), "E is gone with the last that had it");
    const char *const back[] = {"skin.law=linear", "skin.nu=.3", "skin.E=5"};
    ok(!materials_set(&m, back, 3, &e) && !materials_of(&m, 0, &a, &e) && a.value[LAW_E] == 5 && a.peak == 30000,
       "and back; density and peak stay: %s", e.text);
    ok(isnan(model_find(&m, "material.E")->f64[1]), "nan in the other's row");
    ok(!set(&m, "skin.law=neo-hookean", &e) && !materials_of(&m, 0, &a, &e) && same(&a, 5, .3, 1000, 30000),
       "laws of the same keys keep their values: %s", e.text);
    ok(!read_text(materials_override, &m, "skin law=mooney-rivlin c10=1 c01=1 nu=.1\n", &e) &&
           is_mooney(&m, 0, 1, 1, NAN, .1),
       "an override: %s", e.text);
    ok(!set(&m, "skin.c01=2", &e) && is_mooney(&m, 0, 1, 2, NAN, .1), "one key: %s", e.text);
    ok(!set(&m, "fat.K=7", &e) && is_mooney(&m, 1, 2500, 500, 7, NAN), "K drops nu: %s", e.text);
    model_find(&m, "material.K")->f64[0] = 5;
    ok(materials_of(&m, 0, &a, &e) == -1 && strstr(e.text, "material.K, row 0: 5 is not allowed"), "%s", e.text);
    model_free(&m);
}

static void refuse_two_laws(void)
{
    refuse_file("fat law=mooney-rivlin c10=1 c01=-1 K=9", "m.txt:1: 'c01=-1' is not allowed; expected 0 to 1e12 Pa");
    refuse_file("fat law=mooney-rivlin c10=1 c01=1 K=0", "m.txt:1: 'K=0' is not allowed; expected 0.001 to 1e12 Pa");
    refuse_file("\nfat law=mooney-rivlin c10=1 c01=1 K=9 nu=.3",
                "m.txt:2: the law mooney-rivlin with both nu and K; expected nu or K");
    refuse_file("fat law=mooney-rivlin c10=1 c01=1",
                "m.txt:1: the law mooney-rivlin without nu or K; expected c10, c01, nu or K");
    refuse_file("fat c01=1 K=9 law=mooney-rivlin",
                "m.txt:1: the law mooney-rivlin without c10; expected c10, c01, nu or K");
    refuse_file("fat law=mooney-rivlin c10=1 c01=1 K=9 E=3",
                "m.txt:1: 'E' is not a key of the law mooney-rivlin; expected c10, c01, nu or K, density, peak");
    refuse_file("fat c10=5", "m.txt:1: 'c10' is not a key of the law neo-hookean; expected E, nu, density, peak");
    refuse_override("tissue law=mooney-rivlin c10=1 c01=1", "m.txt:1: the law mooney-rivlin without nu or K");
    refuse_override("tissue K=1", "m.txt:1: 'K' is not a key of the law neo-hookean");
    refuse_set("tissue.K=1", "-m tissue: 'K' is not a key of the law neo-hookean; expected E, nu, density, peak");
    refuse_set("tissue.law=mooney-rivlin", "-m tissue: the law mooney-rivlin without c10; expected c10, c01, nu or K");
    refuse_set("tissue.law=moony-rivlin", "did you mean 'mooney-rivlin'?");
    refuse_set("tissue.c11=1", "unknown key 'c11'; did you mean 'c10'?");
}

/* With all laws of the table, in order. */
static void refuse_unknown_law(void)
{
    const char *names[LAW_MOST];
    char expected[400] = "m.txt:1: unknown law 'hookean'; expected one of: ";
    for (int i = 0, count = law_names(names); i < count; i++) {
        const size_t at = strlen(expected);
        snprintf(expected + at, sizeof expected - at, "%s%s", i ? ", " : "", names[i]);
    }
    refuse_file("skin law=hookean", expected);
}

int main(void)
{
    two_laws();
    refuse_two_laws();
    defaults();
    mixtures();
    mixed_with_fibres();
    files();
    dots();
    refuse_file("", "m.txt: no material");
    refuse_file("# nothing\n\n", "m.txt: no material");
    refuse_file("skin E=0", "m.txt:1: 'E=0' is not allowed; expected 0.001 to 1e12 Pa");
    refuse_file("\nskin E=-3", "m.txt:2: 'E=-3'");
    refuse_file("skin E=nan", "m.txt:1: 'E=nan'");
    refuse_file("skin E=1e999", "m.txt:1: 'E=1e999'");
    refuse_file("skin E=3kPa", "m.txt:1: 'E=3kPa'");
    refuse_file("skin E=3,000", "m.txt:1: 'E=3,000'");
    refuse_file("skin nu=0.5", "m.txt:1: 'nu=0.5' is not allowed; expected -0.99 to 0.4999");
    refuse_file("skin nu=-1", "m.txt:1: 'nu=-1'");
    refuse_file("skin density=0", "m.txt:1: 'density=0'");
    refuse_file("skin peak=-1", "m.txt:1: 'peak=-1'");
    refuse_unknown_law();
    refuse_file("skin law=neohookean", "did you mean 'neo-hookean'?");
    refuse_file("skin e=3", "m.txt:1: unknown key 'e'; did you mean 'E'?");
    refuse_file("skin E=3 E=3", "m.txt:1: 'E' is given twice");
    refuse_file("skin E=3\nbone\nskin", "m.txt:3: material 'skin' is given twice");
    refuse_file("E=3000", "m.txt:1: 'E=3000' comes first; expected NAME");
    refuse_file("skin soft", "m.txt:1: 'soft'; expected KEY=VALUE");
    refuse_file("sk\xffin E=3", "m.txt:1: word 1 is not UTF-8");
    refuse_override("tisue E=3", "m.txt:1: unknown material 'tisue'; did you mean 'tissue'?");
    refuse_override("tissue E=3\ntissue nu=0.3", "m.txt:2: material 'tissue' is given twice");
    refuse_override("tissue nu=2", "m.txt:1: 'nu=2'");
    refuse_set("tissue.E=-1", "0.001 to 1e12 Pa");
    refuse_set("tissue.young=1", "unknown key 'young'; expected one of: law, E, nu, ");
    refuse_set("tisue.E=1", "did you mean 'tissue'?");
    refuse_set("tissue.E", "expected MATERIAL.KEY=VALUE");
    refuse_set("tissue=1", "expected MATERIAL.KEY=VALUE");
    refuse_set(".E=1", "expected MATERIAL.KEY=VALUE");
    refuse_set("tissue.=1", "expected MATERIAL.KEY=VALUE");
    refuse_set("tissue.E=", "expected MATERIAL.KEY=VALUE");
    refuse_set("", "expected MATERIAL.KEY=VALUE");
    refuse_set("tissue.law=mooney", "unknown law 'mooney'");
    refuse_model("material.E", NAN, "material.E, row 0: nan");
    refuse_model("material.E", 0, "material.E, row 0: 0");
    refuse_model("material.E", INFINITY, "material.E, row 0: inf");
    refuse_model("material.E", 1e308, "");
    refuse_model("material.nu", .5, "material.nu, row 0: 0.5");
    refuse_model("material.density", -1, "material.density, row 0: -1");
    refuse_model("material.peak", -1, "material.peak, row 0: -1");
    incomplete_models();
    return done_testing();
}
