/* The one table of arrays that Sinew knows. Checks on reading, sinew info, sinew diff and the manual come from
 * it. A name that begins "*" + "/" is for every surface: the * stands for its name, in the axis and unit too.
 */
#ifndef SINEW_KNOWN_H
#define SINEW_KNOWN_H

#include "model/model.h"

enum {
    KNOWN_EVERY = 1, /* index arrays: -1 (none) is not allowed */
    KNOWN_FRAME = 2, /* lives in frames */
    KNOWN_NAN = 4    /* rows that are nan in every column say that there is none */
};

/* What the values must be, besides what their type and unit say. */
typedef enum known_rule {
    KNOWN_ANY,
    KNOWN_FINITE,
    KNOWN_FROM,      /* from `low` to `high`, both included */
    KNOWN_DIRECTION, /* each row has length 1, to KNOWN_LENGTH, or is 0 */
    KNOWN_POSE,      /* finite; the last four columns are a quaternion of length 1, to KNOWN_LENGTH */
    KNOWN_WEIGHTS,   /* finite; where there are four columns they add to 1, to KNOWN_SUM of the largest */
    KNOWN_STARTS     /* 0 first, then each more than the one before */
} known_rule;

#define KNOWN_LENGTH 1e-3 /* so that three digits written by hand pass */
#define KNOWN_SUM    1e-6

typedef struct known {
    const char *name;
    model_type type;
    const char *unit, *axis;
    int columns_min, columns_max; /* a new array gets columns_max unless the caller says otherwise */
    int flags;
    known_rule rule;
    double low, high;    /* of KNOWN_FROM */
    const char *maker;   /* the tool that adds it; NULL: none yet, the name is reserved */
    const char *meaning; /* one line, for the manual */
} known;

/* X(name, type, unit, axis, columns_min, columns_max, flags, rule, low, high, maker, meaning). KEY_ARRAYS: where the
 * arrays of the keys of materials are, one a key of physics/law.h; ELEMENT_KEYS: those of single elements. */
#define KNOWN_ARRAYS(X, KEY_ARRAYS, ELEMENT_KEYS)                                                                      \
    X("node.position", MODEL_F64, "m", "node", 3, 3, 0, KNOWN_FINITE, 0, 0, "voxelise or msds-mesh", "rest position")  \
    X("node.lattice", MODEL_I32, "1", "node", 3, 3, 0, KNOWN_ANY, 0, 0, "voxelise", "corner of the lattice: i, j, k")  \
    X("node.rigid", MODEL_U8, "1", "node", 1, 1, 0, KNOWN_FROM, 0, 1, "attach or msds-mesh", "1 = fixed")              \
    X("node.anchor", MODEL_I32, "@anchor", "node", 1, 1, 0, KNOWN_ANY, 0, 0, "attach",                                 \
      "rigid surface that holds the node, -1 = none")                                                                  \
    X("anchor.name", MODEL_STR, "1", "anchor", 1, 1, 0, KNOWN_ANY, 0, 0, "attach", "name of a rigid surface")          \
    X("node.body", MODEL_I32, "@body", "node", 1, 1, 0, KNOWN_ANY, 0, 0, "attach",                                     \
      "rigid body that the rigid node moves with, -1 = none")                                                          \
    X("body.name", MODEL_STR, "1", "body", 1, 1, 0, KNOWN_ANY, 0, 0, "attach", "name of a rigid body")                 \
    X("body.centre", MODEL_F64, "m", "body", 3, 3, 0, KNOWN_FINITE, 0, 0, "attach", "the mean of its nodes at rest")   \
    X("element.node", MODEL_I32, "@node", "element", 4, 8, KNOWN_EVERY, KNOWN_ANY, 0, 0, "voxelise or msds-mesh",      \
      "nodes in VTK order: 8 (hexahedron) or 4 (tetrahedron, its volume above 0)")                                     \
    X("element.lattice", MODEL_I32, "1", "element", 3, 3, 0, KNOWN_ANY, 0, 0, "voxelise",                              \
      "cell of the lattice: i, j, k")                                                                                  \
    X("element.volume", MODEL_I32, "@volume", "element", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "voxelise or msds-mesh",  \
      "volume it belongs to")                                                                                          \
    X("element.fraction", MODEL_F32, "1", "element", 1, 1, 0, KNOWN_FROM, 0, 1, "voxelise",                            \
      "share of it that is enclosed: the part that it has of its mass and forces; without the array all is")           \
    X("cut.element", MODEL_I32, "@element", "cut", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "voxelise",                     \
      "element that is enclosed in part and takes its strain as the mean over that part; ascending")                   \
    X("cut.moments", MODEL_F32, "1", "cut", 7, 7, 0, KNOWN_FROM, -1, 1, "voxelise",                                    \
      "means over that part of xi, eta, zeta, xi eta, eta zeta, zeta xi, xi eta zeta, each from -1 to 1 across it")    \
    X("element.mix", MODEL_I32, "@volume", "element", 1, 1, 0, KNOWN_ANY, 0, 0, "voxelise",                            \
      "second volume that it is mixed of, -1 = none")                                                                  \
    X("element.mixture", MODEL_F32, "1", "element", 1, 1, 0, KNOWN_FROM, 0, 1, "voxelise",                             \
      "share of what is enclosed that is of element.mix; the rest is of element.volume")                               \
    X("border.element", MODEL_I32, "@element", "border", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "voxelise",               \
      "element that is a laminate of its two volumes, parted by a plane; ascending")                                   \
    X("border.normal", MODEL_F32, "1", "border", 3, 3, 0, KNOWN_FROM, -1, 1, "voxelise",                               \
      "unit normal of that plane, towards element.mix")                                                                \
    X("border.moments", MODEL_F32, "1", "border", 6, 6, 0, KNOWN_FROM, -1, 1, "voxelise",                              \
      "means over the part of element.mix of xi, eta, zeta, xi eta, eta zeta, zeta xi, each from -1 to 1 across it")   \
    X("element.inside", MODEL_F32, "1", "element", 3, 3, 0, KNOWN_FROM, 0, 1, "voxelise",                              \
      "a place in it that the surfaces enclose, in shares of its sides; without the array its centre")                 \
    X("element.fibre", MODEL_F32, "1", "element", 3, 3, 0, KNOWN_DIRECTION, 0, 0, "attach",                            \
      "unit direction of its fibres, along which a muscle contracts; 0 0 0 where there is none")                       \
    X("element.mixfibre", MODEL_F32, "1", "element", 3, 3, 0, KNOWN_DIRECTION, 0, 0, "attach",                         \
      "the same of element.mix")                                                                                       \
    X("element.normal", MODEL_F32, "1", "element", 3, 3, 0, KNOWN_DIRECTION, 0, 0, "voxelise",                         \
      "unit outward normal of the skin next to it; 0 0 0 where there is none")                                         \
    ELEMENT_KEYS                                                                                                       \
    X("volume.name", MODEL_STR, "1", "volume", 1, 1, 0, KNOWN_ANY, 0, 0, "voxelise or msds-mesh", "name")              \
    X("volume.level", MODEL_I32, "1", "volume", 1, 1, 0, KNOWN_FROM, 0, INT32_MAX, "voxelise or msds-mesh",            \
      "level, 0 the lowest")                                                                                           \
    X("volume.priority", MODEL_I32, "1", "volume", 1, 1, 0, KNOWN_FROM, 0, INT32_MAX, "voxelise or msds-mesh",         \
      "priority within the level, 0 the first")                                                                        \
    X("volume.material", MODEL_I32, "@material", "volume", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0,                         \
      "voxelise or msds-mesh", "material")                                                                             \
    X("volume.muscle", MODEL_U8, "1", "volume", 1, 1, 0, KNOWN_FROM, 0, 1, "voxelise or msds-mesh", "1 = a muscle")    \
    X("material.name", MODEL_STR, "1", "material", 1, 1, 0, KNOWN_ANY, 0, 0, "voxelise or msds-mesh", "name")          \
    X("material.law", MODEL_STR, "1", "material", 1, 1, 0, KNOWN_ANY, 0, 0, "voxelise or msds-mesh",                   \
      "its law, one of those in sinew-laws(7)")                                                                        \
    KEY_ARRAYS                                                                                                         \
    X("material.fibre", MODEL_STR, "1", "material", 1, 1, 0, KNOWN_ANY, 0, 0, "voxelise or msds-mesh",                 \
      "kind of its families of fibres, one of those in sinew-laws(7), or none")                                        \
    X("muscle.volume", MODEL_I32, "@volume", "muscle", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "attach",                   \
      "volume of the muscle")                                                                                          \
    X("muscle.centre", MODEL_F64, "m", "muscle", 3, 3, KNOWN_NAN, KNOWN_FINITE, 0, 0, "attach",                        \
      "contraction centre, the mean of its rigid nodes; nan where it has none")                                        \
    X("muscle.fibre", MODEL_STR, "1", "muscle", 1, 1, 0, KNOWN_ANY, 0, 0, "attach",                                    \
      "rule that its fibres follow, one of those in attach(1)")                                                        \
    X("attachment.muscle", MODEL_I32, "@muscle", "attachment", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "attach",           \
      "muscle that is fixed there: a connected part of its rigid nodes; the largest first")                            \
    X("attachment.anchor", MODEL_I32, "@anchor", "attachment", 1, 1, 0, KNOWN_ANY, 0, 0, "attach",                     \
      "rigid surface that holds most of its nodes")                                                                    \
    X("attachment.nodes", MODEL_I32, "1", "attachment", 1, 1, 0, KNOWN_FROM, 1, INT32_MAX, "attach",                   \
      "how many rigid nodes")                                                                                          \
    X("attachment.centre", MODEL_F64, "m", "attachment", 3, 3, 0, KNOWN_FINITE, 0, 0, "attach",                        \
      "the mean of its rigid nodes")                                                                                   \
    X("bone.element", MODEL_I32, "@element", "bone", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "attach",                     \
      "element that a film of tissue on bone hangs on")                                                                \
    X("bone.anchor", MODEL_I32, "@anchor", "bone", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "attach",                       \
      "rigid surface that the film is on")                                                                             \
    X("bone.point", MODEL_F64, "m", "bone", 3, 3, 0, KNOWN_FINITE, 0, 0, "attach",                                     \
      "place in the element where it hangs on the film, at rest")                                                      \
    X("bone.normal", MODEL_F32, "1", "bone", 3, 3, 0, KNOWN_DIRECTION, 0, 0, "attach",                                 \
      "unit normal of the bone, into the tissue")                                                                      \
    X("bone.depth", MODEL_F64, "m", "bone", 1, 1, 0, KNOWN_FROM, 0, 1e9, "attach",                                     \
      "how thick the film is, from the bone to the place; above 0")                                                    \
    X("bone.area", MODEL_F64, "m2", "bone", 1, 1, 0, KNOWN_FROM, 0, 1e9, "attach", "its area; above 0")                \
    X("bone.products", MODEL_F32, "1", "bone", 4, 4, 0, KNOWN_FROM, -27, 27, "attach",                                 \
      "means over the film of products of places in its element, -1 to 1 there: xy, yz, zx, xyz")                      \
    X("bone.body", MODEL_I32, "@body", "bone", 1, 1, 0, KNOWN_ANY, 0, 0, "attach",                                     \
      "rigid body that the bone moves with, -1 = none")                                                                \
    X("film.element", MODEL_I32, "@element", "film", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "attach",                     \
      "element that films have a part of; ascending")                                                                  \
    X("film.share", MODEL_F32, "1", "film", 1, 1, 0, KNOWN_FROM, 0, 1, "attach", "that part of its volume")            \
    X("film.moments", MODEL_F32, "1", "film", 7, 7, 0, KNOWN_FROM, -1, 1, "attach",                                    \
      "means over that part, as cut.moments")                                                                          \
    X("slide.node", MODEL_I32, "@node", "slide", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "attach",                         \
      "node that slides on bone; ascending")                                                                           \
    X("slide.field", MODEL_I32, "@field", "slide", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "attach",                       \
      "distance field of that bone")                                                                                   \
    X("slide.lifts", MODEL_U8, "1", "slide", 1, 1, 0, KNOWN_FROM, 0, 1, "attach",                                      \
      "1 = it may come off the bone, 0 = it keeps its distance from it")                                               \
    X("field.body", MODEL_I32, "@body", "field", 1, 1, 0, KNOWN_ANY, 0, 0, "attach",                                   \
      "rigid body that the field moves with, -1 = none")                                                               \
    X("field.contact", MODEL_U8, "1", "field", 1, 1, 0, KNOWN_FROM, 0, 1, "attach",                                    \
      "1 = samples of skin may not enter it, 0 = nodes slide on it")                                                   \
    X("field.first", MODEL_I32, "1", "field", 3, 3, 0, KNOWN_ANY, 0, 0, "attach",                                      \
      "corner of the lattice where its first sample is: i, j, k")                                                      \
    X("field.samples", MODEL_I32, "1", "field", 3, 3, 0, KNOWN_FROM, 2, INT32_MAX, "attach",                           \
      "samples along x, y and z, a voxel apart")                                                                       \
    X("distance.value", MODEL_F32, "m", "distance", 1, 1, 0, KNOWN_FINITE, 0, 0, "attach",                             \
      "distance from the bone, above 0 in the tissue: field after field, x fastest, then y")                           \
    X("contact.element", MODEL_I32, "@element", "contact", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "bind",                 \
      "element that a sample of skin, which may touch itself, is bound to")                                            \
    X("contact.weight", MODEL_F64, "1", "contact", 3, 3, 0, KNOWN_FINITE, 0, 0, "bind", "its 3 weights (W&M eq. 1)")   \
    X("contact.blended", MODEL_U8, "1", "contact", 1, 1, 0, KNOWN_FROM, 0, 1, "bind",                                  \
      "1 = it moves blended, as MOTION in bind(1) says; without the array none does")                                  \
    X("skin.node", MODEL_I32, "@node", "skin", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "bind",                             \
      "node about that skin; ascending")                                                                               \
    X("skin.distance", MODEL_F32, "m", "skin", 1, 1, 0, KNOWN_FINITE, 0, 0, "bind",                                    \
      "how far it is from the skin of its own part of the tissue, above 0 outside")                                    \
    X("probe-vertex.position", MODEL_F64, "m", "probe-vertex", 3, 3, 0, KNOWN_FINITE, 0, 0, "msds-run or tled-run",    \
      "of a convex probe: a corner, in the probe's frame")                                                             \
    X("probe-face.vertex", MODEL_I32, "@probe-vertex", "probe-face", 3, 3, KNOWN_EVERY, KNOWN_ANY, 0, 0,               \
      "msds-run or tled-run", "the corners of a triangle of it, turned out")                                           \
    X("*/vertex.position", MODEL_F64, "m", "*/vertex", 3, 3, 0, KNOWN_FINITE, 0, 0, "voxelise or bind",                \
      "rest position")                                                                                                 \
    X("*/vertex.element", MODEL_I32, "@element", "*/vertex", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "bind",               \
      "element it is bound to")                                                                                        \
    X("*/vertex.weight", MODEL_F64, "1", "*/vertex", 3, 4, 0, KNOWN_WEIGHTS, 0, 0, "bind",                             \
      "3 weights in a hexahedron (W&M eq. 1) or 4 in a tetrahedron")                                                   \
    X("*/vertex.blended", MODEL_U8, "1", "*/vertex", 1, 1, 0, KNOWN_FROM, 0, 1, "bind",                                \
      "1 = it moves blended, as MOTION in bind(1) says; without the array none does")                                  \
    X("*/face.start", MODEL_I64, "@*/corner", "*/face", 1, 1, KNOWN_EVERY, KNOWN_STARTS, 0, 0, "voxelise or bind",     \
      "its first corner; it ends where the next begins")                                                               \
    X("*/face.vertex", MODEL_I32, "@*/vertex", "*/corner", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "voxelise or bind",     \
      "vertices of the faces: 1 = point, 2 = line, 3 and more = polygon")                                              \
    X("*/face.group", MODEL_I32, "@*/group", "*/face", 1, 1, KNOWN_EVERY, KNOWN_ANY, 0, 0, "voxelise or bind",         \
      "group it is in")                                                                                                \
    X("*/group.name", MODEL_STR, "1", "*/group", 1, 1, 0, KNOWN_ANY, 0, 0, "voxelise or bind",                         \
      "names between spaces: a face may be in several")                                                                \
    X("node.displacement", MODEL_F64, "m", "node", 3, 3, KNOWN_FRAME, KNOWN_FINITE, 0, 0, "tled-run or msds-run",      \
      "displacement from rest")                                                                                        \
    X("node.velocity", MODEL_F64, "m/s", "node", 3, 3, KNOWN_FRAME, KNOWN_FINITE, 0, 0, "tled-run or msds-run",        \
      "velocity")                                                                                                      \
    X("element.contractile", MODEL_F64, "1", "element", 1, 1, KNOWN_FRAME, KNOWN_FINITE, 0, 0, "tled-run",             \
      "of a muscle with vmax: stretch of the fibre without that of the spring, less 1")                                \
    X("element.mixcontractile", MODEL_F64, "1", "element", 1, 1, KNOWN_FRAME, KNOWN_FINITE, 0, 0, "tled-run",          \
      "the same of element.mix")                                                                                       \
    X("element.stress", MODEL_F32, "Pa", "element", 6, 6, KNOWN_FRAME | KNOWN_NAN, KNOWN_FINITE, 0, 0,                 \
      "tled-run or sinew results", "Cauchy stress at its centre: xx yy zz xy yz xz; nan where it is inside out")       \
    X("element.stress.mises", MODEL_F32, "Pa", "element", 1, 1, KNOWN_FRAME | KNOWN_NAN, KNOWN_FINITE, 0, 0,           \
      "tled-run or sinew results", "von Mises stress, of element.stress")                                              \
    X("element.strain", MODEL_F32, "1", "element", 6, 6, KNOWN_FRAME | KNOWN_NAN, KNOWN_FINITE, 0, 0,                  \
      "tled-run or sinew results", "Green-Lagrange strain at its centre: xx yy zz xy yz xz")                           \
    X("element.stretch", MODEL_F32, "1", "element", 3, 3, KNOWN_FRAME | KNOWN_NAN, KNOWN_FINITE, 0, 0,                 \
      "tled-run or sinew results", "principal stretches at its centre, the largest first")                             \
    X("element.stretch.fibre", MODEL_F32, "1", "element", 1, 1, KNOWN_FRAME | KNOWN_NAN, KNOWN_FINITE, 0, 0,           \
      "tled-run or sinew results", "stretch along its fibre; nan where it has none")                                   \
    X("element.energy", MODEL_F32, "J/m3", "element", 1, 1, KNOWN_FRAME | KNOWN_NAN, KNOWN_FINITE, 0, 0,               \
      "tled-run or sinew results", "strain energy at its centre, by volume at rest")                                   \
    X("material.energy", MODEL_F64, "J", "material", 1, 1, KNOWN_FRAME | KNOWN_NAN, KNOWN_FINITE, 0, 0,                \
      "tled-run or sinew results", "strain energy of all elements of the material")                                    \
    X("volume.activation", MODEL_F64, "1", "volume", 1, 1, KNOWN_FRAME, KNOWN_FINITE, 0, 0, "tled-run",                \
      "activation of the muscle that the volume is; 0 where it does not contract")                                     \
    X("probe.pose", MODEL_F64, "1", "probe", 7, 7, KNOWN_FRAME, KNOWN_POSE, 0, 0, "msds-run or tled-run",              \
      "place of its frame, m, and its turn, a unit quaternion x y z w")                                                \
    X("probe.force", MODEL_F64, "N", "probe", 3, 3, KNOWN_FRAME, KNOWN_FINITE, 0, 0, "msds-run or tled-run",           \
      "force of the tissue on it")                                                                                     \
    X("probe.torque", MODEL_F64, "N.m", "probe", 3, 3, KNOWN_FRAME, KNOWN_FINITE, 0, 0, "msds-run or tled-run",        \
      "torque of the tissue on it, about the origin of its frame")                                                     \
    X("bone.displacement", MODEL_F64, "m", "bone", 3, 3, KNOWN_FRAME, KNOWN_FINITE, 0, 0, "tled-run",                  \
      "how the bone of a film has moved from rest, at the film's place")                                               \
    X("body.pose", MODEL_F64, "1", "body", 7, 7, KNOWN_FRAME, KNOWN_POSE, 0, 0, "tled-run",                            \
      "its motion from rest: where the origin has moved to, m, and its turn, a unit quaternion x y z w")               \
    X("body.force", MODEL_F64, "N", "body", 3, 3, KNOWN_FRAME, KNOWN_FINITE, 0, 0, "tled-run",                         \
      "force of the tissue on it")                                                                                     \
    X("body.torque", MODEL_F64, "N.m", "body", 3, 3, KNOWN_FRAME, KNOWN_FINITE, 0, 0, "tled-run",                      \
      "torque of the tissue on it, about the mean of its nodes as they are now")                                       \
    X("*/vertex.displacement", MODEL_F64, "m", "*/vertex", 3, 3, KNOWN_FRAME, KNOWN_FINITE, 0, 0,                      \
      "msds-run or tled-run", "of a skin, or a bound surface: displacement from rest")                                 \
    X("*/vertex.normal", MODEL_F64, "1", "*/vertex", 3, 3, KNOWN_FRAME, KNOWN_DIRECTION, 0, 0, "msds-run",             \
      "of a skin: unit normal as it is moved")

/* Whether a name is the user's: it begins "x-", and nothing is known of it, whatever follows. */
bool known_users(const char *name);

/* The row for an array's name, or NULL. */
const known *known_find(const char *name);

/* The i-th row, or NULL past the last. */
const known *known_row(int i);

/* "finite numbers", "0 to 1", "0.001 to 1e12 Pa": what the rule expects; "" where it is KNOWN_ANY. Not whether nan is
 * allowed. */
enum { KNOWN_WORDS = 100 };
void known_words(const known *k, char to[KNOWN_WORDS]);

/* Writes pattern (an axis or unit of the row) for the array `name`, its * replaced. */
void known_expand(const char *pattern, const char *name, char *to, size_t size);

#endif
