#include "exchange/export_inp.h"

#include "base/mem.h"
#include "base/num.h"
#include "exchange/inp_law.h"
#include "model/material_elements.h"
#include "model/materials.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FIELD = 20, NAME = 80 }; /* Abaqus's limits on a number and a name */

/* What is written and the tables that it takes. */
typedef struct writer {
    export_shape x;
    const model_array *volume;   /* element.volume */
    const model_array *material; /* volume.material */
    const model_array *rigid;    /* node.rigid, or NULL */
    int64_t volumes, materials;
    int64_t *count;  /* elements of each volume */
    material *laws;  /* materials */
    char *set, *law; /* names: volumes x NAME, materials x NAME */
    out *to;
} writer;

void export_inp_number(double value, char *text)
{
    int n = num_text(value, false, text);
    for (int digits = 16; n > FIELD; digits--)
        n = snprintf(text, NUM_TEXT, "%.*g", digits, value);
}

/* Whether one of the first `count` names is this one. */
static bool taken(const char *names, int64_t count, size_t size, const char *name)
{
    for (int64_t i = 0; i < count; i++)
        if (!strcmp(names + i * (int64_t)size, name))
            return true;
    return false;
}

void export_inp_names(char *const *name, int64_t count, const char *prefix, char *to, size_t size)
{
    for (int64_t i = 0; i < count; i++) {
        char plain[NAME], *own = to + i * (int64_t)size;
        snprintf(plain, sizeof plain, "%s%.60s", prefix, name[i]);
        for (char *p = plain; *p; p++)
            *p = isalnum((unsigned char)*p) && !((unsigned char)*p & 0x80) ? (char)toupper((unsigned char)*p) : '_';
        snprintf(own, size, "%s", plain);
        for (int64_t n = 2; taken(to, i, size, own); n++)
            snprintf(own, size, "%.50s_%" PRId64, plain, n);
    }
}

static void put_numbers(const double *value, int count, out *to)
{
    char text[NUM_TEXT];
    for (int i = 0; i < count; i++) {
        export_inp_number(value[i], text);
        out_format(to, "%s%s", i ? ", " : "", text);
    }
    out_text(to, "\n");
}

typedef bool belongs(const writer *w, int64_t i, int64_t key);

/* The numbers of those that belong, 12 on a line. */
static void put_set(const writer *w, int64_t count, belongs *one, int64_t key)
{
    int on_line = 0;
    for (int64_t i = 0; i < count; i++) {
        if (!one(w, i, key))
            continue;
        out_format(w->to, "%s%" PRId64, on_line ? ", " : "", i + 1);
        if (++on_line == 12) {
            out_text(w->to, "\n");
            on_line = 0;
        }
    }
    out_text(w->to, on_line ? "\n" : "");
}

static bool is_of_volume(const writer *w, int64_t element, int64_t volume)
{
    return w->volume->i32[element] == volume;
}

static bool is_rigid(const writer *w, int64_t node, int64_t key)
{
    (void)key;
    return w->rigid->u8[node] != 0;
}

static void put_nodes(const writer *w)
{
    out_text(w->to, "*NODE, NSET=NALL\n");
    for (int64_t i = 0; i < w->x.points; i++) {
        out_format(w->to, "%" PRId64 ", ", i + 1);
        put_numbers(&w->x.rest[3 * i], 3, w->to);
    }
}

static void put_elements(const writer *w, const char *hexahedron)
{
    int64_t corners;
    out_format(w->to, "*ELEMENT, TYPE=%s, ELSET=EALL\n", w->x.node->columns == 8 ? hexahedron : "C3D4");
    for (int64_t i = 0; i < w->x.cells; i++) {
        const int32_t *node = export_shape_cell(&w->x, i, &corners);
        out_format(w->to, "%" PRId64, i + 1);
        for (int64_t c = 0; c < corners; c++)
            out_format(w->to, ", %" PRId64, (int64_t)node[c] + 1);
        out_text(w->to, "\n");
    }
}

static void put_sets(const writer *w)
{
    for (int64_t v = 0; v < w->volumes; v++) {
        if (!w->count[v])
            continue;
        out_format(w->to, "*ELSET, ELSET=%s\n", w->set + v * NAME);
        put_set(w, w->x.cells, is_of_volume, v);
    }
    bool any = false;
    for (int64_t i = 0; w->rigid && i < w->x.points && !any; i++)
        any = w->rigid->u8[i];
    if (any) {
        out_text(w->to, "*NSET, NSET=RIGID\n");
        put_set(w, w->x.points, is_rigid, 0);
        out_text(w->to, "*BOUNDARY\nRIGID, 1, 3\n");
    }
}

int export_inp_has_law(const law_row *law, const char *name, err *e)
{
    char words[INP_LAWS * 40] = "";
    if (law->form == FORM_LINEAR || inp_law_of(law, 0))
        return 0;
    for (int i = 0; i < INP_LAWS; i++) {
        const size_t at = strlen(words);
        const bool more = i + 1 < INP_LAWS && inp_laws[i + 1].terms <= 1; /* and not the same law with more terms */
        if (inp_laws[i].terms <= 1)
            snprintf(words + at, sizeof words - at, "%s%s", more ? ", " : " or ", inp_laws[i].law);
    }
    return err_set(e, NULL, 0,
                   "material '%.200s' has the law '%s', which Abaqus's files do not have here; expected %s%s", name,
                   law->name, law_of_form(FORM_LINEAR)->name, words);
}

/* "*ELASTIC" or "*HYPERELASTIC, NEO HOOKE" or another, and its constants. */
static void put_law(const writer *w, const material *of)
{
    const double moduli[] = {material_young(of), material_poisson(of)};
    const inp_law *law = inp_law_of(of->law, material_edit_keys(of));
    double constants[INP_CONSTANTS];
    if (!law) { /* FORM_LINEAR: open_tables refuses others */
        out_text(w->to, "*ELASTIC\n");
        put_numbers(moduli, 2, w->to);
        return;
    }
    out_format(w->to, "*HYPERELASTIC, %s", law->name);
    if (law->terms)
        out_format(w->to, ", N=%d", law->terms);
    out_text(w->to, "\n");
    const int count = inp_law_write(law, of, constants), first = count < INP_LINE ? count : INP_LINE;
    put_numbers(constants, first, w->to);
    if (count > first)
        put_numbers(constants + first, count - first, w->to);
}

static void put_materials(const writer *w)
{
    for (int64_t i = 0; i < w->materials; i++) {
        out_format(w->to, "*MATERIAL, NAME=%s\n", w->law + i * NAME);
        put_law(w, &w->laws[i]);
        out_text(w->to, "*DENSITY\n");
        put_numbers(&w->laws[i].density, 1, w->to);
    }
    for (int64_t v = 0; v < w->volumes; v++)
        if (w->count[v])
            out_format(w->to, "*SOLID SECTION, ELSET=%s, MATERIAL=%s\n", w->set + v * NAME,
                       w->law + (int64_t)w->material->i32[v] * NAME);
}

/* Whether every volume is of the linear law: then its equations are solved in one step. */
static bool is_linear(const writer *w)
{
    for (int64_t v = 0; v < w->volumes; v++)
        if (w->count[v] && w->laws[w->material->i32[v]].law->form != FORM_LINEAR)
            return false;
    return true;
}

static void put_step(const writer *w, const double *gravity)
{
    double size = sqrt(gravity[0] * gravity[0] + gravity[1] * gravity[1] + gravity[2] * gravity[2]);
    out_text(w->to, is_linear(w) ? "*STEP\n*STATIC\n" : "*STEP, NLGEOM, INC=1000\n*STATIC\n0.1, 1, 1e-06, 1\n");
    if (size > 0) {
        double load[4] = {size, gravity[0] / size, gravity[1] / size, gravity[2] / size};
        out_text(w->to, "*DLOAD\nEALL, GRAV, ");
        put_numbers(load, 4, w->to);
    }
    out_text(w->to, "*NODE PRINT, NSET=NALL, FREQUENCY=1000\nU\n*NODE FILE, FREQUENCY=1000\nU\n*END STEP\n");
}

static int check_material(const material *of, const char *name, err *e)
{
    if (export_inp_has_law(of->law, name, e))
        return -1;
    if (!material_is_directed(of))
        return 0;
    return err_set(e, NULL, 0,
                   "material '%.200s' has fibres that resist being stretched, which Abaqus's files do not have here; "
                   "expected none",
                   name);
}

static int open_tables(writer *w, const model *m, err *e)
{
    const model_array *name = model_need(m, "volume.name", e);
    const model_array *law = name ? model_need(m, "material.name", e) : NULL;
    w->volume = law ? model_need(m, "element.volume", e) : NULL;
    w->material = w->volume ? model_need(m, "volume.material", e) : NULL;
    if (!w->material)
        return -1;
    w->rigid = model_find(m, "node.rigid");
    w->volumes = name->rows;
    w->materials = law->rows;
    w->count = mem_array(w->volumes, sizeof *w->count, "volumes", e);
    w->set = w->count ? mem_array(w->volumes, NAME, "set names", e) : NULL;
    w->law = w->set ? mem_array(w->materials, NAME, "material names", e) : NULL;
    w->laws = w->law ? mem_array(w->materials, sizeof *w->laws, "materials", e) : NULL;
    if (!w->laws)
        return -1;
    for (int64_t i = 0; i < w->materials; i++)
        if (materials_of(m, i, &w->laws[i], e) || check_material(&w->laws[i], law->str[i], e))
            return -1;
    for (int64_t i = 0; i < w->volume->rows; i++)
        w->count[w->volume->i32[i]]++;
    export_inp_names(name->str, w->volumes, "V_", w->set, NAME);
    export_inp_names(law->str, w->materials, "M_", w->law, NAME);
    return 0;
}

static void note_laws(const writer *w, const model *m, notes *warnings)
{
    for (int64_t i = 0; i < w->materials; i++) {
        const inp_law *law = inp_law_of(w->laws[i].law, 0);
        if (law && law->other_press)
            notes_add(warnings, INP_OTHER_PRESS, model_find(m, "material.name")->str[i], law->name, law->other_press);
    }
}

static void note_omissions(const writer *w, const model *m, notes *warnings)
{
    const model_array *name = model_find(m, "volume.name");
    for (int64_t v = 0; v < w->volumes; v++)
        if (!w->count[v])
            notes_add(warnings, "volume %.200s has no elements: it has no set in the file", name->str[v]);
    if (model_find(m, "element.fraction"))
        notes_add(warnings,
                  "element.fraction is not in the file, which has no place for it: all elements are whole there");
    if (model_find(m, "element.mix"))
        notes_add(warnings,
                  "element.mix is not in the file, which has no place for it: elements are of one volume there");
    if (model_find(m, "slide.node"))
        notes_add(warnings, "slide.node is not in the file: nodes that slide on bone are free there");
    if (model_find(m, "contact.element"))
        notes_add(warnings, "contact.element is not in the file: skin does not touch itself there");
    for (int k = 0; k < MATERIAL_ELEMENT_KEYS; k++)
        if (model_find(m, material_elements_arrays[k]))
            notes_add(warnings,
                      "%s is not in the file, which has no place for it: elements have their material's there",
                      material_elements_arrays[k]);
    for (int64_t i = 0; w->rigid && i < w->rigid->rows; i++)
        if (w->rigid->u8[i])
            return;
    notes_add(warnings, "no node is rigid: nothing in the file holds the model");
}

static void put_all(const writer *w, const export_inp_options *options)
{
    out_text(w->to, "*HEADING\nSinew; SI units\n");
    put_nodes(w);
    put_elements(w, options->element);
    put_sets(w);
    put_materials(w);
    put_step(w, options->gravity);
}

int export_inp(const model *m, const export_inp_options *options, out *to, notes *warnings, err *e)
{
    writer w = {.to = to};
    int bad = export_shape_of(&w.x, m, NULL, e) || open_tables(&w, m, e) ? -1 : 0;
    if (!bad && !w.x.cells)
        bad = err_set(e, NULL, 0, "the model has no elements; expected some");
    if (!bad) {
        note_laws(&w, m, warnings);
        note_omissions(&w, m, warnings);
        put_all(&w, options);
    }
    free(w.count);
    free(w.laws);
    free(w.set);
    free(w.law);
    export_shape_free(&w.x);
    return bad;
}
