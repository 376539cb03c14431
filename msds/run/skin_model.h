/* A skin in a model: its surface carried under its file's name, its displacement and normals in frames. Owns nothing
 * but what skin_free frees.
 */
#ifndef SINEW_SKIN_MODEL_H
#define SINEW_SKIN_MODEL_H

#include "msds/run/skin.h"
#include "results/frame_choice.h"
#include "volume/body.h"

/* An OBJ: its coordinates times scale are in the model's axes, or where a body has them as this part (else NULL). */
typedef struct skin_source {
    const char *path;
    double scale; /* to metres; 1 where a part has it */
    const body *around;
    const body_part *part;
} skin_source;

/* Carries the OBJ as the surface of its base name (or of one that says nothing, where that is to be), unless the model
 * does so already; name gets that. */
int skin_model_carry(model *m, const skin_source *from, bool nameless, char name[SURFACE_NAME_MOST + 1],
                     notes *warnings, err *e);

/* Offers the arrays that frames get. */
int skin_model_offer(const skin *s, frame_choice *c, err *e);

/* Starts from a frame, whose displacement of it goes into u; at rest in speed. */
int skin_model_start(skin *s, const frame *f, err *e);

/* Adds "NAME/vertex.displacement" and "NAME/vertex.normal". */
int skin_model_put(const skin *s, frame *f, const model *m, err *e);

#endif
