/* The table of known arrays in sinew-model(5) is the one in model/known.h. After a change there, put what
 * `test_model_known print` prints between the two marked lines of the page. Run from the top of the checkout.
 */
#include "base/in.h"
#include "base/out.h"
#include "model/known.h"
#include "model/model.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>

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

/* Whether the page holds the table; the first line that differs is told. */
static bool page_has(const char *page, const char *table)
{
    const char *at = page ? strstr(page, begin) : NULL;
    while (at && *table && *at == *table)
        at++, table++;
    if (at && *table)
        printf("# the page has '%.*s', the table '%.*s'\n", (int)strcspn(at, "\n"), at, (int)strcspn(table, "\n"),
               table);
    return at && !*table;
}

int main(int argc, char **argv)
{
    err e = {0};
    char *page = NULL;
    size_t size;
    bool printing = argc > 1 && !strcmp(argv[1], "print");
    out *o = printing ? out_open(NULL, false, &e) : out_memory(&e);
    print(o);
    if (printing)
        return out_close(o, &e);
    out_write(o, "", 1);
    in *s = in_open("man/sinew-model.5", &e);
    ok(s && in_all(s, &page, &e) > 0, "the manual page is there %s", e.text);
    ok(page_has(page, (const char *)out_bytes(o, &size)), "its table of arrays is model/known.h's");
    ok(known_find("s/face.group") && !known_find("x-my/face.group") && !known_find("x-node.position"),
       "nothing is known of the user's names, whatever follows x-");
    free(page);
    in_close(s);
    out_discard(o);
    return done_testing();
}
