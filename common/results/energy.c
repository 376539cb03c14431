#include "results/energy.h"

#include "base/mem.h"
#include "mesh/bone_films.h"
#include "mesh/element_fibres.h"
#include "mesh/element_motion.h"
#include "mesh/fibre_sets.h"
#include "model/hourglass_text.h"
#include "model/materials.h"
#include "physics/stability.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A frame's elements. */
typedef struct view {
    element_mesh mesh;
    const double *u;
    hourglass_control control;
    element_fibres muscles;
    fibres_view fibres; /* owned, as is what follows */
    bone_films films;
    film_rest rest; /* what films leave of elements */
    bool is_old;    /* of a release whose stiffness was kappa min(lambda + 2 mu, 11 mu) V sum(B^2) / 8 */
} view;

/* By volume at rest, J/m3. What is linear in its strains is taken for neo-Hookean, which has the same coefficients, mu
 * and K; every other form has its own energy. */
static double material_energy(const material_numbers *of, element_tensor h)
{
    return form_energy(of->form == FORM_LINEAR ? FORM_NEO_HOOKEAN : of->form, h, of->c);
}

/* What passive muscles hold; likewise. */
static double muscles_energy(const element_fibres *of, int64_t element, element_tensor h)
{
    return element_fibre_energy(h, element_fibres_first(of, element, NULL)) +
           element_fibre_energy(h, element_fibres_second(of, element, NULL));
}

/* The numbers by which modes are held. */
static void hold_of(const view *v, double mu, double bulk, double volume, double squares, double to[HOURGLASS_NUMBERS])
{
    const double wave = bulk + 4. / 3 * mu;
    memset(to, 0, HOURGLASS_NUMBERS * sizeof *to);
    if (v->control.kind == HOURGLASS_PHYSICAL)
        hourglass_moduli(mu, bulk, to);
    else
        to[HOURGLASS_K] = hourglass_stiffness(v->control.kappa, mu, volume, squares);
    if (v->is_old && wave < 11 * mu)
        to[HOURGLASS_K] *= wave / (11 * mu);
}

/* Its parts' energies, in place of its law's, and its modes'. */
static void add_laminate(const laminate_motion *l, double fraction, double volume, energy *to)
{
    to->strain += fraction * volume * (laminates_energy(l, 0) + laminates_energy(l, 1));
    to->hourglass += fraction * hourglass_dot(&l->is.held.f, &l->is.modes) / 2;
}

static void add_element(const view *v, const materials_map *map, int64_t element, double fraction, energy *to)
{
    const element_motion is = element_motion_of(&v->mesh, element, v->u);
    const material_numbers own = materials_of_element(map, element), *of = &own;
    laminate_motion l;
    const bool laminate = laminates_at(&v->mesh, map, v->control, element, &is, &l);
    const fibre_sets fibres = fibre_sets_at(&v->fibres, element);
    const double *side = v->mesh.side, mu = of->at_rest.mu;
    double hold[HOURGLASS_NUMBERS];
    hold_of(v, mu, of->at_rest.bulk, is.volume, is.squares, hold);
    const double stiffer = stability_stiffening_of(of->form, v->control.kind, is.h, of->c).now;
    const hourglass_force force =
        v->mesh.is_lattice ? hourglass_of(v->control.kind, is.modes, is.h, element_box(side[0], side[1], side[2]), hold)
                           : element_any_hourglass(v->control.kind, is.modes, is.h, &is.any, hold);
    to->scale += fraction * is.volume * mu;
    to->strain += fraction * is.volume *
                  ((laminate ? 0 : material_energy(of, is.h)) + muscles_energy(&v->muscles, element, is.h) +
                   fibre_sets_energy(&fibres, is.h));
    if (laminate)
        add_laminate(&l, fraction, is.volume, to);
    else
        to->hourglass += fraction * stiffer * hourglass_dot(&force.f, &is.modes) / 2;
}

/* A film has no modes. */
static int add_films(const view *v, const materials_map *map, const frame *f, energy *to, err *e)
{
    film_bone *bone = v->films.count ? mem_array(v->films.count, sizeof *bone, "the films", e) : NULL;
    if (v->films.count && !bone)
        return -1;
    bone_films_moved(&v->films, f, bone);
    for (int64_t i = 0; i < v->films.count; i++) {
        const int64_t element = v->films.element[i];
        const material_numbers of = materials_of_element(map, element);
        const fibre_sets fibres = fibre_sets_at(&v->fibres, element);
        double rows[9];
        bone_films_gradient(&v->films, i, &bone[i], v->u, v->mesh.node + 8 * element, rows);
        const element_tensor h = element_tensor_of(rows);
        to->strain +=
            v->films.area[i] * v->films.depth[i] *
            (material_energy(&of, h) + muscles_energy(&v->muscles, element, h) + fibre_sets_energy(&fibres, h));
    }
    free(bone);
    return 0;
}

/* How the run that wrote the frames held hourglass modes: hourglass.control, or hourglass.kappa of older releases. */
static int control_of(view *v, const model *m, err *e)
{
    const char *control = model_meta_of(m, "hourglass.control");
    if (control && hourglass_read(control, &v->control))
        return err_set(e, NULL, 0, "hourglass.control holds '%.60s'; expected physical or isotropic:KAPPA", control);
    if (control)
        return 0;
    if (!model_meta_of(m, "hourglass.kappa"))
        return err_set(e, NULL, 0,
                       "hourglass energy is not known: the model has no metadata hourglass.control; it comes from "
                       "tled-run");
    v->is_old = true;
    v->control.kind = HOURGLASS_ISOTROPIC;
    if (model_meta_numbers(m, "hourglass.kappa", &v->control.kappa, 1, e))
        return -1;
    if (!(v->control.kappa >= 0 && isfinite(v->control.kappa)))
        return err_set(e, NULL, 0, "hourglass.kappa holds %g; expected a finite number, at least 0", v->control.kappa);
    return 0;
}

static int view_of(view *v, const model *m, const frame *f, err *e)
{
    const model_array *u = frame_find(f, "node.displacement");
    *v = (view){.u = u ? u->f64 : NULL};
    if (!u)
        return err_set(e, NULL, 0, "frame %lld has no node.displacement; it comes from tled-run", (long long)f->index);
    if (element_mesh_of(&v->mesh, m, e))
        return -1;
    if (v->mesh.corners != 8)
        return err_set(e, NULL, 0,
                       "hourglass energy is for hexahedra only, and these elements have %d nodes; expected 8",
                       v->mesh.corners);
    return control_of(v, m, e);
}

static void view_free(view *v)
{
    fibres_free(&v->fibres);
    bone_films_free(&v->films);
    film_rest_free(&v->rest);
}

/* Reads what is the same in all frames. *fraction: the elements' shares. */
static int open_model(view *v, const model *m, const material *law, const float **fraction, err *e)
{
    *fraction = v->mesh.fraction;
    if (fibres_make(&v->fibres, m, law, e) || bone_films_make(&v->films, &v->mesh, m, e))
        return -1;
    if (!v->films.count)
        return 0;
    if (film_rest_make(&v->rest, m, v->mesh.elements, *fraction, &v->mesh.borders, &v->mesh.cut, e))
        return -1;
    *fraction = v->rest.fraction;
    return 0;
}

int energy_of(energy *to, const model *m, const frame *f, err *e)
{
    view v;
    const float *fraction = NULL;
    *to = (energy){0};
    if (view_of(&v, m, f, e) || !model_need(m, "element.volume", e))
        return -1;
    material *law = materials_of_volumes(m, e);
    int failed = !law || open_model(&v, m, law, &fraction, e);
    if (!failed) {
        const materials_map map = materials_map_of(m, law);
        v.muscles = element_fibres_of(m, &map);
        for (int64_t i = 0; i < v.mesh.elements; i++)
            add_element(&v, &map, i, fraction ? (double)fraction[i] : 1, to);
        failed = add_films(&v, &map, f, to, e);
    }
    view_free(&v);
    free(law);
    return failed ? -1 : 0;
}
