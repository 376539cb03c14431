/* American words of what is typed, made British. */
#include "cli/spelling.h"

#include "tap.h"

#include <string.h>

int main(void)
{
    static const struct {
        const char *typed, *british; /* NULL: nothing to change */
    } cases[] = {
        {"fiber", "fibre"},
        {"color", "colour"},
        {"element.fiber.x", "element.fibre.x"},
        {"element.mixfiber", "element.mixfibre"},
        {"quality.j.center", "quality.j.centre"},
        {"center_of_color", "centre_of_colour"},
        {"centers", "centres"},
        {"voxelize", "voxelise"},
        {"fibre", NULL},
        {"fibers", NULL},
        {"Color", NULL},
        {"colors", NULL},
        {"discolor", NULL},
        {"", NULL},
        {"...", NULL},
        {"\xc3\xa9"
         "center",
         "\xc3\xa9"
         "centre"},
    };
    char to[32];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const bool changed = spelling_british(cases[i].typed, strlen(cases[i].typed), to, sizeof to);
        ok(changed == (cases[i].british != NULL) && (!changed || !strcmp(to, cases[i].british)), "'%s'",
           cases[i].typed);
    }
    ok(spelling_british("fiber=field", 5, to, sizeof to) && !strcmp(to, "fibre"), "as many bytes as are given");
    ok(!spelling_british("color", 5, to, 6) && spelling_british("color", 5, to, 7), "no room, and just enough");
    ok(!spelling_british("color", 5, to, 0), "no room at all");
    ok(!strcmp(spelling_american("voxelise"), "voxelize") && !spelling_american("attach"), "and back");
    return done_testing();
}
