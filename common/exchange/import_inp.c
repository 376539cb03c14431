#include "exchange/import_inp.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/num.h"
#include "exchange/import_inp_parts.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { PARAMETERS = 32 };

/* A keyword line, cut: NAME, PARAMETER=VALUE... */
typedef struct keyword {
    char *name;
    char *key[PARAMETERS], *value[PARAMETERS]; /* value "" where it has none */
    int count;
} keyword;

static int wrong(const inp_reader *r, const char *text, const char *expected)
{
    return err_set(r->e, r->m->name, in_lines(r->s), "%.200s; expected %s", text, expected);
}

/* ---- words */

static char *trim(char *text)
{
    size_t n = strlen(text);
    while (n && isspace((unsigned char)text[n - 1]))
        text[--n] = '\0';
    while (isspace((unsigned char)*text))
        text++;
    return text;
}

/* The next field of a line of fields between commas, trimmed; NULL at its end, which a comma before it may be. */
static char *next_field(char **at)
{
    char *field = *at, *comma;
    if (!field)
        return NULL;
    comma = strchr(field, ',');
    *at = comma ? comma + 1 : NULL;
    if (comma)
        *comma = '\0';
    field = trim(field);
    return *field || *at ? field : NULL;
}

static bool same(const char *a, const char *b)
{
    return !strcasecmp(a, b);
}

/* Abaqus's names have no case: they are kept in lower case, without the quotes and the instance that they may have. */
char *import_inp_name(char *name)
{
    char *dot = strrchr(name, '.');
    name = dot && dot[1] ? dot + 1 : name;
    size_t n = strlen(name);
    if (n > 1 && name[0] == '"' && name[n - 1] == '"') {
        name[n - 1] = '\0';
        name++;
    }
    for (char *p = name; *p; p++)
        *p = *p >= 'A' && *p <= 'Z' ? (char)(*p - 'A' + 'a') : *p;
    return name;
}

static int take_id(const inp_reader *r, const char *field, int32_t *id)
{
    int64_t value;
    char text[64];
    if (num_int(field, 1, INT32_MAX, &value)) {
        snprintf(text, sizeof text, "'%.40s'", field);
        return wrong(r, *field ? text : "nothing between two commas", "a number from 1 up");
    }
    *id = (int32_t)value;
    return 0;
}

/* Fortran's D for an exponent is taken too. */
static int take_number(const inp_reader *r, char *field, const char *expected, double *value)
{
    char text[64] = "the line ends, or nothing stands between two commas";
    if (field && !num_double(field, value))
        return 0;
    if (field && *field)
        snprintf(text, sizeof text, "'%.40s'", field);
    for (char *p = field; p && *p; p++)
        *p = *p == 'D' || *p == 'd' ? 'e' : *p;
    return !field || num_double(field, value) ? wrong(r, text, expected) : 0;
}

/* ---- keywords */

static void cut_keyword(char *line, keyword *k)
{
    char *at = line + 1, *field;
    *k = (keyword){.name = next_field(&at)};
    k->name = k->name ? k->name : line;
    while (k->count < PARAMETERS && (field = next_field(&at))) {
        char *equals = strchr(field, '=');
        k->value[k->count] = equals ? trim(equals + 1) : field + strlen(field);
        if (equals)
            *equals = '\0';
        k->key[k->count++] = trim(field);
    }
}

/* NULL where it is not given. */
static char *parameter(const keyword *k, const char *key)
{
    for (int i = 0; i < k->count; i++)
        if (same(k->key[i], key))
            return k->value[i];
    return NULL;
}

static bool one_of(const char *name, const char *const *list)
{
    for (; *list; list++)
        if (same(name, *list))
            return true;
    return false;
}

/* The set that a parameter names, added where there is none; -1: not given. -2 with e filled. */
static int32_t set_of(inp_reader *r, import_sets *sets, const keyword *k, const char *key)
{
    char *name = parameter(k, key);
    if (!name)
        return -1;
    int32_t at = import_sets_open(sets, import_inp_name(name), r->e);
    return at < 0 ? -2 : at;
}

static int begin_element(inp_reader *r, const keyword *k)
{
    static const char *const hexahedra[] = {"C3D8", "C3D8R", "C3D8H", "C3D8RH", "C3D8I", "C3D8IH", NULL};
    static const char *const tetrahedra[] = {"C3D4", "C3D4H", NULL};
    static const char *const lower[] = {"T3D", "T2D", "B3",   "B2",     "CPS",     "CPE",  "CAX",
                                        "S3",  "S4",  "S6",   "S8",     "STRI",    "M3D",  "SFM3D",
                                        "R3D", "R2D", "MASS", "SPRING", "DASHPOT", "CONN", NULL};
    const char *type = parameter(k, "TYPE");
    char text[64] = "elements of no TYPE";
    if (type && *type)
        snprintf(text, sizeof text, "elements of type '%.30s'", type);
    r->now = INP_ELEMENTS;
    r->set = set_of(r, &r->elements, k, "ELSET");
    r->pending_count = 0;
    r->columns = -1;
    if (type && one_of(type, hexahedra))
        r->columns = 8;
    else if (type && one_of(type, tetrahedra))
        r->columns = 4;
    for (int i = 0; type && r->columns < 0 && lower[i]; i++) {
        if (!strncasecmp(type, lower[i], strlen(lower[i]))) {
            notes_add(r->warnings, "%s:%lld: elements of type %.30s are not solids, and are left out", r->m->name,
                      (long long)in_lines(r->s), type);
            r->columns = 0;
        }
    }
    if (r->columns < 0)
        return wrong(r, text,
                     "hexahedra C3D8 or C3D8R, or tetrahedra C3D4: wedges, pyramids and elements of higher "
                     "order are not read");
    return r->set < -1 ? -1 : 0;
}

static int begin_set(inp_reader *r, const keyword *k, bool of_nodes)
{
    const char *key = of_nodes ? "NSET" : "ELSET";
    r->now = of_nodes ? INP_NODE_SET : INP_ELEMENT_SET;
    if (of_nodes && parameter(k, "ELSET"))
        return wrong(r, "*NSET of an ELSET's nodes", "nodes by number");
    r->set = set_of(r, of_nodes ? &r->nodes : &r->elements, k, key);
    r->generates = parameter(k, "GENERATE") != NULL;
    if (r->set == -1)
        return wrong(r, "a set without a name", of_nodes ? "NSET=NAME" : "ELSET=NAME");
    return r->set < 0 ? -1 : 0;
}

/* The field becomes the name that it is found by. */
static int32_t add_material(inp_reader *r, char *field)
{
    char *written = mem_text(field, r->e);
    int32_t at = written ? import_add_material(r->m, import_inp_name(field), in_lines(r->s), r->e) : -1;
    if (at < 0 || r->m->material[at].written)
        free(written);
    else
        r->m->material[at].written = written;
    return at;
}

static int begin_material(inp_reader *r, const keyword *k)
{
    char *name = parameter(k, "NAME");
    if (!name || !*name)
        return wrong(r, "*MATERIAL without a name", "NAME=NAME");
    r->now = INP_NOTHING;
    r->material = add_material(r, name);
    return r->material < 0 ? -1 : 0;
}

/* The row that *HYPERELASTIC names, and where it has terms the N of them, 1 where it is not given; or NULL. */
static const inp_law *hyper_of(const keyword *k)
{
    const char *terms = parameter(k, "N");
    int64_t count = 1;
    if (terms && num_int(terms, 1, INT32_MAX, &count))
        count = 0;
    for (int i = 0; i < INP_LAWS; i++)
        if (parameter(k, inp_laws[i].name) && (!inp_laws[i].terms || inp_laws[i].terms == count))
            return &inp_laws[i];
    return NULL;
}

static int begin_law(inp_reader *r, const keyword *k)
{
    bool elastic = same(k->name, "ELASTIC"), density = same(k->name, "DENSITY");
    const char *type = parameter(k, "TYPE");
    if (r->material < 0)
        return wrong(r, "a property of no material", "*MATERIAL, NAME=NAME before it");
    r->now = INP_NOTHING;
    if (r->w->own_materials)
        return 0;
    if (elastic && type && !same(type, "ISO") && !same(type, "ISOTROPIC"))
        return wrong(r, "*ELASTIC that is not isotropic", "E and nu");
    r->hyper = hyper_of(k);
    if (!elastic && !density && !r->hyper)
        return wrong(r, "*HYPERELASTIC of another law", INP_LAW_NAMES);
    if (!elastic && !density && parameter(k, "TEST DATA INPUT"))
        return wrong(r, "*HYPERELASTIC from test data", r->hyper->words);
    r->now = elastic ? INP_ELASTIC : INP_HYPER;
    if (density)
        r->now = INP_DENSITY;
    return 0;
}

static int begin_section(inp_reader *r, const keyword *k)
{
    char *set = parameter(k, "ELSET"), *of = parameter(k, "MATERIAL");
    r->now = INP_NOTHING;
    if (!set || !of)
        return wrong(r, "*SOLID SECTION of nothing", "ELSET=NAME, MATERIAL=NAME");
    inp_section s = {.line = in_lines(r->s)};
    s.set = import_sets_open(&r->elements, import_inp_name(set), r->e);
    s.material = s.set < 0 ? -1 : add_material(r, of);
    if (s.material < 0 || MEM_ROOM(&r->sections, &r->section_room, r->section_count + 1, "sections", r->e))
        return -1;
    r->sections[r->section_count++] = s;
    return 0;
}

static void note_keyword(inp_reader *r, const char *name)
{
    char text[64];
    snprintf(text, sizeof text, "%.60s", name);
    for (int i = 0; i < r->noted_count; i++)
        if (!strcmp(r->noted[i], text))
            return;
    if (r->noted_count == 16)
        return;
    memcpy(r->noted[r->noted_count++], text, sizeof text);
    notes_add(r->warnings, "%s:%lld: *%s is not read", r->m->name, (long long)in_lines(r->s), text);
}

static int begin_other(inp_reader *r, const keyword *k)
{
    static const char *const refused[] = {"INCLUDE", "NGEN",   "NFILL",     "NCOPY",     "NMAP", "ELGEN",
                                          "ELCOPY",  "SYSTEM", "TRANSFORM", "PARAMETER", NULL};
    static const char *const quiet[] = {"HEADING",     "PREPRINT",     "RESTART",      "NODE PRINT",     "NODE FILE",
                                        "NODE OUTPUT", "EL PRINT",     "EL FILE",      "ELEMENT OUTPUT", "OUTPUT",
                                        "STEP",        "END STEP",     "STATIC",       "DYNAMIC",        "END PART",
                                        "ASSEMBLY",    "END ASSEMBLY", "END INSTANCE", "SURFACE",        NULL};
    char text[80];
    snprintf(text, sizeof text, "*%.60s", k->name);
    r->now = INP_NOTHING;
    if (one_of(k->name, refused))
        return wrong(r, text, same(k->name, "INCLUDE") ? "all in one file" : "nodes and elements written out");
    if (same(k->name, "PART") || same(k->name, "INSTANCE")) {
        r->parts += same(k->name, "PART") ? 1 : 16;
        r->now = same(k->name, "PART") ? INP_NOTHING : INP_MOVED;
        if (r->parts % 16 > 1 || r->parts > 17)
            return wrong(r, text, "one part, once");
        return 0;
    }
    if (!one_of(k->name, quiet))
        note_keyword(r, k->name);
    return 0;
}

static int begin(inp_reader *r, char *line)
{
    keyword k;
    if (r->pending_count)
        return err_set(r->e, r->m->name, r->pending_line,
                       "an element with %d numbers; expected its own number and those of %d nodes", r->pending_count,
                       r->columns);
    cut_keyword(line, &k);
    if (same(k.name, "NODE")) {
        if (parameter(&k, "SYSTEM") || parameter(&k, "INPUT"))
            return wrong(r, "*NODE with SYSTEM or INPUT", "x, y, z written out");
        r->now = INP_NODES;
        r->set = set_of(r, &r->nodes, &k, "NSET");
        return r->set < -1 ? -1 : 0;
    }
    if (same(k.name, "ELEMENT"))
        return parameter(&k, "INPUT") ? wrong(r, "*ELEMENT with INPUT", "all in one file") : begin_element(r, &k);
    if (same(k.name, "NSET") || same(k.name, "ELSET"))
        return begin_set(r, &k, same(k.name, "NSET"));
    if (same(k.name, "MATERIAL"))
        return begin_material(r, &k);
    if (same(k.name, "ELASTIC") || same(k.name, "HYPERELASTIC") || same(k.name, "DENSITY"))
        return begin_law(r, &k);
    if (same(k.name, "SOLID SECTION"))
        return begin_section(r, &k);
    if (same(k.name, "BOUNDARY")) {
        r->now = INP_HELD;
        return 0;
    }
    return begin_other(r, &k);
}

/* ---- data lines */

static int take_node(inp_reader *r, char *line)
{
    int32_t id = 0;
    double at[3];
    char *field = next_field(&line);
    if (!field || take_id(r, field, &id))
        return field ? -1 : 0;
    for (int a = 0; a < 3; a++)
        if (take_number(r, next_field(&line), "a node's number, x, y, z", &at[a]))
            return -1;
    if (r->m->node_id.count && id == r->m->node_id.id[r->m->node_id.count - 1])
        return wrong(r, "a node number for the second time", "a different number for each node");
    if (import_ids_add(&r->m->node_id, id, r->e) || import_add_node(r->m, at, r->e))
        return -1;
    return r->set >= 0 ? import_sets_range(&r->nodes, r->set, id, id, 1, r->e) : 0;
}

/* An element's numbers may go on for several lines. */
static int take_element(inp_reader *r, char *line)
{
    char *field;
    if (!r->columns)
        return 0;
    while ((field = next_field(&line))) {
        if (!*field)
            continue;
        if (!r->pending_count)
            r->pending_line = in_lines(r->s);
        if (r->pending_count > r->columns)
            return wrong(r, "an element with more nodes than its type has", r->columns == 8 ? "8" : "4");
        if (take_id(r, field, &r->pending[r->pending_count++]))
            return -1;
    }
    if (r->pending_count <= r->columns)
        return 0;
    int32_t id = r->pending[0];
    r->pending_count = 0;
    if (import_ids_add(&r->element_id, id, r->e) ||
        import_add_element(r->m, r->pending + 1, r->columns, -1, r->pending_line, r->e))
        return -1;
    return r->set >= 0 ? import_sets_range(&r->elements, r->set, id, id, 1, r->e) : 0;
}

static int take_range(inp_reader *r, import_sets *sets, char *line)
{
    int32_t n[3] = {1, 1, 1};
    int count = 0;
    char *field;
    while ((field = next_field(&line)) && count < 3)
        if (take_id(r, field, &n[count++]))
            return -1;
    if (count < 2 || field || n[1] < n[0])
        return wrong(r, "a set that is generated", "FIRST, LAST, STEP, the first not above the last");
    return import_sets_range(sets, r->set, n[0], n[1], n[2], r->e);
}

static int take_members(inp_reader *r, import_sets *sets, char *line)
{
    char *field, text[80];
    if (r->generates)
        return *trim(line) ? take_range(r, sets, line) : 0;
    while ((field = next_field(&line))) {
        int32_t id = 0, other;
        if (!*field)
            continue;
        if (*field >= '0' && *field <= '9') {
            if (take_id(r, field, &id) || import_sets_range(sets, r->set, id, id, 1, r->e))
                return -1;
            continue;
        }
        snprintf(text, sizeof text, "no set '%.50s'", field); /* as it is written: the next makes lower case of it */
        other = import_sets_find(sets, import_inp_name(field));
        if (other < 0)
            return wrong(r, text, "a number, or a set that is defined before");
        if (import_sets_include(sets, r->set, other, r->e))
            return -1;
    }
    return 0;
}

/* Where an instance is moved to: its part would have to be moved too. */
static int take_move(inp_reader *r, char *line)
{
    char *field;
    while ((field = next_field(&line))) {
        double value = 0;
        if (take_number(r, field, "an instance's place, numbers", &value))
            return -1;
        if (value != 0)
            return wrong(r, "an instance that is moved", "one where its part is");
    }
    return 0;
}

/* NODE-OR-SET, FIRST, LAST, VALUE; or NODE-OR-SET, ENCASTRE or PINNED. */
static int take_held(inp_reader *r, char *line)
{
    char *who = next_field(&line), *first = next_field(&line), *last = next_field(&line), *value = next_field(&line);
    char text[80];
    int64_t from, to;
    inp_held h = {-1, -1, 7};
    if (!who)
        return 0;
    snprintf(text, sizeof text, "no node set '%.50s'", who);
    if (*who >= '0' && *who <= '9' ? take_id(r, who, &h.node)
                                   : (h.set = import_sets_find(&r->nodes, import_inp_name(who))) < 0)
        return h.set < 0 && h.node < 0 ? wrong(r, text, "a node, or a set that is defined before") : -1;
    if (!first)
        return wrong(r, "*BOUNDARY of no component", "NODE-OR-SET, FIRST, LAST");
    if (!same(first, "ENCASTRE") && !same(first, "PINNED")) {
        double moved = 0;
        if (num_int(first, 1, 1000, &from) || (last && *last && num_int(last, from, 1000, &to)))
            return wrong(r, "*BOUNDARY of other than components", "1, 2, 3, or ENCASTRE or PINNED");
        to = last && *last ? to : from;
        if (value && *value && take_number(r, value, "a displacement", &moved))
            return -1;
        if (moved != 0)
            return wrong(r, "*BOUNDARY that moves nodes", "0: tled-run's script moves them");
        h.mask = 0;
        for (int a = 0; a < 3; a++)
            h.mask |= (uint8_t)((from <= a + 1 && a + 1 <= to) << a);
    }
    if (MEM_ROOM(&r->holds, &r->hold_room, r->hold_count + 1, "held nodes", r->e))
        return -1;
    r->holds[r->hold_count++] = h;
    return 0;
}

static int take_elastic(inp_reader *r, char *line, material *of)
{
    double young, poisson;
    if (take_number(r, next_field(&line), "E, nu", &young) || take_number(r, next_field(&line), "E, nu", &poisson))
        return -1;
    of->law = law_of_form(FORM_LINEAR);
    for (int k = 0; k < LAW_OWN_KEYS; k++)
        of->value[k] = NAN;
    of->value[LAW_E] = young;
    of->value[LAW_nu] = poisson;
    return 0;
}

/* Those after D1 need not be there; their terms are none. */
static int take_volumetric(inp_reader *r, char **line)
{
    const inp_law *of = r->hyper;
    const double least = inp_least_no_term * 2 / r->m->material[r->material].of.value[LAW_K];
    for (int i = 1; i < of->volumetric; i++) {
        char *field = next_field(line);
        double value = 0;
        if (field && *field && take_number(r, field, of->words, &value))
            return -1;
        if (value != 0 && !(value >= least))
            return wrong(r, "volumetric energy of (J - 1)^4 or on", "D2 and D3 of 0, or at least 1e9 times D1");
    }
    return 0;
}

/* The constants that are on a second line: of the volumetric energy. */
static int take_hyper_rest(inp_reader *r, char *line)
{
    r->now = INP_NOTHING;
    return take_volumetric(r, &line);
}

static int take_hyper(inp_reader *r, char *line, material *of)
{
    const inp_law *row = r->hyper;
    double constants[INP_CONSTANTS] = {0};
    char what[LAW_WORDS], expected[LAW_WORDS];
    for (int i = 0; i <= row->keys; i++)
        if (take_number(r, next_field(&line), row->words, &constants[i]))
            return -1;
    snprintf(what, sizeof what, "%s that is not above 0", row->positive);
    if (!(constants[0] > 0) || !(constants[row->keys] > 0))
        return wrong(r, what, "a material that can be compressed, K = 2/D1");
    if (row->other_press)
        notes_add(r->warnings, INP_OTHER_PRESS, r->m->material[r->material].name, row->name, row->other_press);
    inp_law_read(row, constants, of);
    if (law_refuses(of->law, of->value, what, expected))
        return wrong(r, what, expected);
    return take_volumetric(r, &line);
}

static int take_law(inp_reader *r, char *line)
{
    material *of = &r->m->material[r->material].of;
    const inp_block now = r->now;
    if (!*trim(line))
        return 0;
    r->now = now == INP_HYPER && r->hyper->keys + r->hyper->volumetric > INP_LINE
                 ? INP_HYPER_REST
                 : INP_NOTHING; /* further lines are for other temperatures */
    if (now == INP_DENSITY)
        return take_number(r, next_field(&line), "a density", &of->density);
    return now == INP_HYPER ? take_hyper(r, line, of) : take_elastic(r, line, of);
}

static int take(inp_reader *r, char *line)
{
    switch (r->now) {
    case INP_NODES:
        return take_node(r, line);
    case INP_ELEMENTS:
        return take_element(r, line);
    case INP_NODE_SET:
        return take_members(r, &r->nodes, line);
    case INP_ELEMENT_SET:
        return take_members(r, &r->elements, line);
    case INP_MOVED:
        return take_move(r, line);
    case INP_HELD:
        return take_held(r, line);
    case INP_ELASTIC:
    case INP_HYPER:
    case INP_DENSITY:
        return take_law(r, line);
    case INP_HYPER_REST:
        return take_hyper_rest(r, line);
    default:
        return 0;
    }
}

static int read_lines(inp_reader *r)
{
    char *line;
    int64_t n;
    while ((n = in_line(r->s, &line, NULL, r->e)) >= 0) {
        chars_mend(line);
        line = trim(line);
        if (line[0] == '*' && line[1] == '*')
            continue;
        if (line[0] != '*' ? take(r, line) : begin(r, line))
            return -1;
    }
    if (n < -1)
        return -1;
    return r->pending_count ? err_set(r->e, r->m->name, r->pending_line,
                                      "an element that the file ends in; expected its %d nodes", r->columns)
                            : 0;
}

int import_inp(import_mesh *m, in *s, const import_wishes *wishes, notes *warnings, err *e)
{
    inp_reader r = {.m = m, .s = s, .w = wishes, .warnings = warnings, .e = e, .set = -1, .material = -1};
    m->any_case = true;
    int result = read_lines(&r) || import_inp_finish(&r, wishes) ? -1 : 0;
    import_ids_free(&r.element_id);
    import_sets_free(&r.nodes);
    import_sets_free(&r.elements);
    free(r.sections);
    free(r.holds);
    return result;
}
