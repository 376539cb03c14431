#include "mesh/energy.h"

#include "mesh/hexahedron.h"
#include "mesh/lattice.h"
#include "model/hourglass_text.h"
#include "model/materials.h"
#include "physics/element_any.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A frame's elements; arrays are the model's and the frame's. */
typedef struct view {
    const int32_t *node;
    const double *rest, *u;
    bool is_lattice; /* all are boxes of `side` */
    double side[3];
    hourglass_control control;
    bool is_old; /* of a release whose stiffness was kappa min(lambda + 2 mu, 11 mu) V sum(B^2) / 8 */
} view;

static element_modes modes_of(const view *v, int64_t element, int axis)
{
    element_corners c;
    for (int i = 0; i < 8; i++)
        c.at[i] = v->u[3 * (int64_t)v->node[8 * element + i] + axis];
    return element_modes_of(c);
}

/* Of an element that is no box: its shape, and sum(B^2), 1/m2. */
static element_any shape_of(const view *v, int64_t element, double *squares)
{
    double at[24], b[24], slope[21], twist[12], basis[9];
    for (int i = 0; i < 24; i++)
        at[i] = v->rest[3 * (int64_t)v->node[8 * element + i / 3] + i % 3] -
                v->rest[3 * (int64_t)v->node[8 * element] + i % 3];
    const double volume = hexahedron_mean(at, b);
    hexahedron_modes(at, b, slope, twist);
    hexahedron_basis(at, basis);
    *squares = 0;
    for (int i = 0; i < 24; i++)
        *squares += b[i] * b[i];
    return element_any_of(slope, twist, volume, basis);
}

/* By volume at rest, J/m3. What is linear in its strains is taken for neo-Hookean, which has the same coefficients, mu
 * and K; every other form has its own energy. */
static double material_energy(const material_numbers *of, element_tensor h)
{
    return form_energy(of->form == FORM_LINEAR ? FORM_NEO_HOOKEAN : of->form, h, of->c);
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

static void add_element(const view *v, int64_t element, const material_numbers *of, double fraction, energy *to)
{
    element_modes x = modes_of(v, element, 0), y = modes_of(v, element, 1), z = modes_of(v, element, 2);
    const double *side = v->side;
    const double mu = of->at_rest.mu, bulk = of->at_rest.bulk;
    double volume = side[0] * side[1] * side[2], hold[HOURGLASS_NUMBERS], squares;
    element_tensor h;
    hourglass_force force;
    hourglass_modes m;
    if (v->is_lattice) {
        const element_shape box = element_box(side[0], side[1], side[2]);
        hold_of(v, mu, bulk, volume, hourglass_squares(side), hold);
        h = element_gradient(x, y, z, box.slope);
        m = element_hourglass_modes(x, y, z);
        force = hourglass_of(v->control.kind, m, h, box, hold);
    } else {
        const element_any any = shape_of(v, element, &squares);
        volume = any.volume;
        hold_of(v, mu, bulk, volume, squares, hold);
        h = element_any_twist(&any, &x, &y, &z);
        m = element_hourglass_modes(x, y, z);
        force = element_any_hourglass(v->control.kind, m, h, &any, hold);
    }
    to->scale += fraction * volume * mu;
    to->strain += fraction * volume * material_energy(of, h);
    to->hourglass += fraction * hourglass_dot(&force.f, &m) / 2;
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
    const model_array *node = model_need(m, "element.node", e), *rest = model_need(m, "node.position", e);
    const model_array *u = frame_find(f, "node.displacement");
    lattice l = {0};
    if (!u)
        err_set(e, NULL, 0, "frame %lld has no node.displacement; it comes from tled-run", (long long)f->index);
    if (!node || !rest || !u)
        return -1;
    *v = (view){.node = node->i32, .rest = rest->f64, .u = u->f64};
    v->is_lattice = model_meta_of(m, "lattice.spacing") != NULL;
    if (node->columns != 8)
        return err_set(e, NULL, 0,
                       "hourglass energy is for hexahedra only, and these elements have %d nodes; expected 8",
                       (int)node->columns);
    if (control_of(v, m, e) || (v->is_lattice && lattice_of(m, &l, e)))
        return -1;
    memcpy(v->side, l.spacing, sizeof v->side);
    return 0;
}

int energy_of(energy *to, const model *m, const frame *f, err *e)
{
    view v;
    const model_array *fraction = model_find(m, "element.fraction");
    *to = (energy){0};
    if (view_of(&v, m, f, e) || !model_need(m, "element.volume", e))
        return -1;
    material *law = materials_of_volumes(m, e);
    if (!law)
        return -1;
    const materials_map map = materials_map_of(m, law);
    const int64_t elements = model_count(m, "element");
    for (int64_t i = 0; i < elements; i++) {
        const material_numbers own = materials_of_element(&map, i);
        add_element(&v, i, &own, fraction ? (double)fraction->f32[i] : 1, to);
    }
    free(law);
    return 0;
}
