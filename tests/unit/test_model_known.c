/* The table of known arrays in sinew-model(5) is the one in model/known.h. After a change there, put what
 * `test_model_known print` prints between the two marked lines of the page. Run from the top of the checkout.
 */
#include "model/known.h"
#include "model/model.h"

#include "page_table.h"

static const char begin[] = ".\\\" known arrays\n", end[] = ".\\\" end known arrays\n";

static void print_part(out *o, bool in_frames)
{
    out_text(o, ".Bl -tag -width 4n\n");
    const known *k;
    char words[KNOWN_WORDS];
    for (int i = 0; (k = known_row(i)); i++) {
        if (!!(k->flags & KNOWN_FRAME) != in_frames)
            continue;
        out_format(o, ".It Li %s %s \\&%s %s ", k->name, model_type_name(k->type), k->unit, k->axis);
        if (k->columns_min < k->columns_max)
            out_format(o, "%d|", k->columns_min);
        out_format(o, "%d\n", k->columns_max);
        known_words(k, words);
        bool told = *words && k->rule != KNOWN_FINITE;
        out_format(o, "%s%s%s%s%s%s: %s.\n", k->maker ? "By " : "Reserved", k->maker ? k->maker : "",
                   k->flags & KNOWN_EVERY ? "; never \\-1" : "", told ? "; " : "", told ? words : "",
                   told && k->flags & KNOWN_NAN ? ", or nan" : "", k->meaning);
    }
    out_text(o, ".El\n");
}

static void print(out *o)
{
    out_text(o, begin);
    out_text(o, ".Ss Of the body\n");
    print_part(o, false);
    out_text(o, ".Ss Of frames\n");
    print_part(o, true);
    out_text(o, end);
}

int main(int argc, char **argv)
{
    if (argc > 1 && !strcmp(argv[1], "print"))
        return page_print(print);
    page_test("man/sinew-model.5", begin, print, "its table of arrays is model/known.h's");
    ok(known_find("s/face.group") && !known_find("x-my/face.group") && !known_find("x-node.position"),
       "nothing is known of the user's names, whatever follows x-");
    return done_testing();
}
