/* Which laws an input file for Abaqus can have: each law of the table, or a refusal that names those that it can. */
// needs: common/exchange/export_inp.c common/exchange/export_shape.c
#include "exchange/export_inp.h"

#include "tap.h"

#include <string.h>

int main(void)
{
    const char *const known[] = {"neo-hookean", "mooney-rivlin", "yeoh", "arruda-boyce", "ogden", "linear"};
    const law_row other = {.name = "quadratic", .form = FORM_COUNT};
    err e = {0};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        ok(!export_inp_has_law(law_find(known[i]), "tissue", &e), "%s: %s", known[i], e.text);
    ok(export_inp_has_law(&other, "tissue", &e) == -1 &&
           strstr(e.text, "material 'tissue' has the law 'quadratic', which Abaqus's files do not have here; expected "
                          "linear, neo-hookean, mooney-rivlin, yeoh, arruda-boyce or ogden"),
       "a law of another form: %s", e.text);
    return done_testing();
}
