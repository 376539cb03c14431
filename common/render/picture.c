#include "render/picture.h"

#include "base/mem.h"
#include "base/num.h"
#include "picture/legend.h"
#include "picture/sheet.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const float ink[3] = {.012f, .012f, .012f}, none[4] = {0, 0, 0, 0};
static const float paper[2][4] = {{1, 1, 1, 1}, {0, 0, 0, 0}}; /* 1: transparent */

/* What it takes to draw one frame. */
typedef struct work {
    picture *p;
    const model *m;
    const frame *const *f;       /* of each panel */
    field field[PICTURE_PANELS]; /* likewise: of the first panel that has its frame */
    bool coloured;               /* there is a field */
    showing showing[PICTURE_PANELS];
    double low, high; /* of the scale, SI */
    sheet sheet;      /* above the strip */
    int letters;
    legend_key key[PICTURE_PANELS][64];
    int keys[PICTURE_PANELS];
    bool one_bar, one_key; /* what several panels would repeat is once in a strip below all of them */
} work;

int picture_open(picture *p, const picture_spec *spec, font *f, pool *threads, err *e)
{
    *p = (picture){.spec = spec, .font = f, .threads = threads};
    colourmap_make(&p->map);
    return image_create(&p->image, spec->width, spec->height, e);
}

void picture_close(picture *p)
{
    image_free(&p->image);
    *p = (picture){0};
}

/* ---- cameras */

static bool same_view(const picture_view *a, const picture_view *b)
{
    return a->kind == b->kind && !strcmp(a->name, b->name) && !memcmp(a->from, b->from, sizeof a->from);
}

static int turn(picture *p, int i, err *e)
{
    static const double middle[3] = {0, 0, 0};
    const picture_spec *s = p->spec;
    const picture_view *v = &s->panel[i].view;
    double away = v->kind == PICTURE_PLACED
                      ? hypot(hypot(v->eye[0] - v->target[0], v->eye[1] - v->target[1]), v->eye[2] - v->target[2])
                      : 1;
    double angle = s->angle > 0 ? s->angle : 2 * away * tan(.17);
    if (v->kind == PICTURE_NAMED)
        return camera_view(&p->camera[i], v->name, s->up, s->front, e);
    if (v->kind == PICTURE_FROM)
        return camera_look(&p->camera[i], v->from, middle, s->up, s->angle <= 0, angle, e);
    return camera_look(&p->camera[i], v->eye, v->target, s->up, s->angle <= 0, angle, e);
}

/* All panels with one view have one camera, which sees what is in any of them: so that they can be compared. */
static int fit_together(work *w, int i, err *e)
{
    scene all = {0};
    int bad = 0;
    const picture_spec *s = w->p->spec;
    for (int k = 0; k < s->panels && !bad; k++) {
        const scene *one = &w->showing[k].scene;
        if (!same_view(&s->panel[i].view, &s->panel[k].view))
            continue;
        bad = mem_grow(&all.mesh, &all.mesh_capacity, all.meshes + one->meshes, sizeof *all.mesh, "a scene", e) ||
              mem_grow(&all.spheres, &all.sphere_capacity, all.sphere_sets + one->sphere_sets, sizeof *all.spheres,
                       "a scene", e);
        for (int64_t n = 0; n < one->meshes && !bad; n++)
            all.mesh[all.meshes++] = one->mesh[n];
        for (int64_t n = 0; n < one->sphere_sets && !bad; n++)
            all.spheres[all.sphere_sets++] = one->spheres[n];
    }
    sheet_cell c = sheet_picture(&w->sheet, i);
    if (!bad)
        bad = camera_fit_scene(&w->p->camera[i], &all, c.width, c.height, s->angle, s->margin, e);
    /* The meshes are the showings'. */
    free(all.mesh);
    free(all.spheres);
    return bad ? -1 : 0;
}

static int place_cameras(work *w, err *e)
{
    const picture_spec *s = w->p->spec;
    for (int i = 0; i < s->panels && !w->p->placed; i++) {
        int like = 0;
        while (like < i && !same_view(&s->panel[i].view, &s->panel[like].view))
            like++;
        if (like < i)
            w->p->camera[i] = w->p->camera[like];
        else if (s->panel[i].view.kind != PICTURE_PLACED && fit_together(w, i, e))
            return -1;
    }
    w->p->placed = true;
    return 0;
}

/* ---- what is in the panels */

/* The first panel that has this one's frame. */
static int like_frame(const work *w, int i)
{
    int like = 0;
    while (w->f[like] != w->f[i])
        like++;
    return like;
}

static const field *field_of_panel(const work *w, int i)
{
    return &w->field[like_frame(w, i)];
}

static int make_fields(work *w, err *e)
{
    const picture_spec *s = w->p->spec;
    for (int i = 0; i < s->panels; i++)
        if (like_frame(w, i) == i && field_of(&w->field[i], w->m, w->f[i], s->field, e))
            return -1;
    return 0;
}

static int things_of(const work *w, const picture_panel *panel)
{
    char name[8];
    int things = panel->things & ~SHOWING_PROBE, some = SHOWING_MUSCLES | SHOWING_RIGID | SHOWING_CENTRES;
    if (!things && !(panel->names && w->p->spec->names))
        things = model_surface(w->m, &(int){0}, name, sizeof name) ? SHOWING_SURFACES : SHOWING_VOXELS;
    things |= panel->things & SHOWING_PROBE;
    return panel->what_there_is ? things & (~some | showing_there(w->m)) : things;
}

static int showing_panel(work *w, int i, err *e)
{
    const picture_spec *s = w->p->spec;
    const picture_panel *panel = &s->panel[i];
    showing_cut cut[PICTURE_CUTS];
    for (int k = 0; k < s->cuts; k++) {
        bool above = s->cut[k].side ? s->cut[k].side > 0 : w->p->camera[i].forward[s->cut[k].axis] <= 0;
        cut[k] = (showing_cut){s->cut[k].axis, above, s->cut[k].at};
    }
    showing_want want = {.things = things_of(w, panel),
                         .name = s->name,
                         .names = panel->names ? s->names : 0,
                         .clear = s->clear,
                         .clears = s->clears,
                         .cut = cut,
                         .cuts = s->cuts,
                         .moved = panel->moved ? w->f[i] : NULL,
                         .slice = panel->moved ? s->slice : NULL,
                         .body = s->body,
                         .field = panel->coloured && w->coloured ? field_of_panel(w, i) : NULL};
    return showing_make(&w->showing[i], w->m, &want, e);
}

/* What is to be seen through must be seen, in some panel. */
static int check_clears(const work *w, err *e)
{
    const picture_spec *s = w->p->spec;
    uint64_t cleared = 0;
    for (int i = 0; i < s->panels; i++)
        cleared |= w->showing[i].cleared;
    for (int k = 0; k < s->clears; k++) {
        if (cleared >> k & 1)
            continue;
        const bool spheres = !strcmp(s->clear[k], "rigid") || !strcmp(s->clear[k], "centres");
        return err_set(e, NULL, 0,
                       "--clear %s: %s; expected surface, voxels, muscles, probe or the name of a surface or group "
                       "that is drawn",
                       s->clear[k], spheres ? "these are never transparent" : "nothing that is drawn has that name");
    }
    return 0;
}

static int showing_panels(work *w, err *e)
{
    for (int i = 0; i < w->p->spec->panels; i++)
        if ((!w->p->placed && turn(w->p, i, e)) || showing_panel(w, i, e))
            return -1;
    return check_clears(w, e);
}

/* One scale for all panels. What cannot be below 0 begins there. */
static void find_range(work *w)
{
    const picture_spec *s = w->p->spec;
    double low, high;
    w->low = INFINITY, w->high = -INFINITY;
    for (int i = 0; i < s->panels; i++)
        if (showing_range(&w->showing[i], &low, &high)) {
            w->low = fmin(w->low, low);
            w->high = fmax(w->high, high);
        }
    if (!(w->low <= w->high))
        w->low = w->high = 0;
    if (w->field[0].folds || (!w->field[0].below_zero && w->low > 0))
        w->low = 0;
    w->high = fmax(w->low, w->high);
    if (s->ranged)
        w->low = s->low, w->high = s->high;
    for (int i = 0; i < s->panels; i++)
        showing_colour(&w->showing[i], &w->field[0], &w->p->map, w->low, w->high);
}

/* ---- legends */

static void add_key(work *w, int i, const char *words, const uint8_t srgb[3], bool round)
{
    legend_key *k = &w->key[i][w->keys[i]++];
    k->words = words;
    k->round = round;
    image_linear(srgb, k->colour);
}

/* The names that faces are coloured by. */
static void add_names(work *w, int i)
{
    const field *f = &w->field[0];
    int most = (int)(sizeof w->key[i] / sizeof *w->key[i]);
    for (int64_t n = 0; n < f->names && w->keys[i] < most; n++) {
        bool seen = false;
        for (int64_t k = 0; k < w->showing[i].values && !seen; k++)
            for (int64_t v = 0; w->showing[i].value[k] && v < w->showing[i].scene.mesh[k].faces && !seen; v++)
                seen = (int64_t)w->showing[i].value[k][v] == n;
        if (!seen)
            continue;
        legend_key *key = &w->key[i][w->keys[i]++];
        key->words = f->name[n];
        key->round = false;
        colourmap_name(n, key->colour);
    }
}

/* Whether anything in a panel is folded. */
static bool has_folded(const work *w, int i)
{
    double low, high;
    return w->field[0].folds && showing_range(&w->showing[i], &low, &high) && low <= 0;
}

static bool has_field(const work *w, int i)
{
    return w->coloured && w->p->spec->panel[i].coloured;
}

static void make_keys(work *w)
{
    for (int i = 0; i < w->p->spec->panels; i++) {
        int seen = w->showing[i].seen;
        if (has_field(w, i) && w->field[0].name)
            add_names(w, i);
        if (has_field(w, i) && has_folded(w, i))
            add_key(w, i, "folded (J not above 0)", showing_red, false);
        if (!w->p->spec->captions)
            continue;
        if (seen & SHOWING_MUSCLES && !has_field(w, i))
            add_key(w, i, "muscle elements", showing_green, false);
        if (seen & SHOWING_RIGID)
            add_key(w, i, "rigid nodes", showing_red, true);
        if (seen & SHOWING_CENTRES)
            add_key(w, i, "contraction centres", showing_centre, true);
    }
}

static bool has_bar(const work *w, int i)
{
    return has_field(w, i) && !w->field[0].name;
}

/* The size of letters, pixels: readable, but no wider than a panel of this width has room for. */
static int letters(const picture_spec *s, int panel_width)
{
    int size = (int)fmin(fmin(s->width, s->height) / 36., panel_width / 22.);
    return (int)num_clamp_int(size, 11, 40);
}

static bool same_keys(const work *w, int a, int b)
{
    bool same = w->keys[a] == w->keys[b];
    for (int k = 0; k < w->keys[a] && same; k++) {
        const legend_key *x = &w->key[a][k], *y = &w->key[b][k];
        same = !strcmp(x->words, y->words) && x->round == y->round && !memcmp(x->colour, y->colour, sizeof x->colour);
    }
    return same;
}

/* One scale holds for all panels, so several need no more than one bar. */
static void find_shared(work *w)
{
    int panels = w->p->spec->panels, bars = 0;
    w->one_key = panels > 1 && w->keys[0];
    for (int i = 0; i < panels; i++) {
        bars += has_bar(w, i);
        w->one_key = w->one_key && same_keys(w, 0, i);
    }
    w->one_bar = bars > 1;
}

static int keys_height(const work *w, int i, int width)
{
    return w->keys[i] ? legend_keys_height(w->p->font, w->letters, width, w->key[i], w->keys[i]) : 0;
}

static int bar_height(const work *w, bool there)
{
    return there ? legend_bar_height(w->letters) : 0;
}

/* The height of the tallest legend that stands in a panel. */
static int legend_room(const work *w)
{
    int tallest = 0;
    for (int i = 0; i < w->p->spec->panels; i++) {
        int width = sheet_panel(&w->sheet, i).width;
        int room = bar_height(w, has_bar(w, i) && !w->one_bar) + (w->one_key ? 0 : keys_height(w, i, width));
        tallest = room > tallest ? room : tallest;
    }
    return tallest;
}

/* The number of columns depends on the room for legends, and that room on the width of a column and the size of
 * letters. So this begins with large letters and no room, and lets letters shrink and room grow until all fits. */
static int lay_out(work *w, err *e)
{
    const picture_spec *s = w->p->spec;
    int foot = 0;
    w->letters = letters(s, s->width);
    for (bool fits = false; !fits;) {
        if (w->p->font && font_set(w->p->font, w->letters, e))
            return -1;
        int head = s->captions ? 2 * w->letters : 0;
        int height = s->height - bar_height(w, w->one_bar) - (w->one_key ? keys_height(w, 0, s->width) : 0);
        sheet_make(&w->sheet, s->width, height, s->panels, head, foot);
        int size = letters(s, sheet_panel(&w->sheet, 0).width), room = legend_room(w);
        fits = size >= w->letters && room <= foot;
        if (size < w->letters) {
            foot = 0;
            w->letters = size;
        } else if (room > foot) {
            foot = room;
        }
    }
    sheet_cell c = sheet_picture(&w->sheet, 0);
    if (c.width < 16 || c.height < 16)
        return err_set(e, NULL, 0, "--size %dx%d leaves %d x %d pixels for each picture; expected a larger one",
                       s->width, s->height, c.width, c.height < 0 ? 0 : c.height);
    return 0;
}

static void put_caption(work *w, int i)
{
    const picture_spec *s = w->p->spec;
    sheet_cell c = sheet_panel(&w->sheet, i);
    int size = w->letters;
    char caption[sizeof s->panel[i].caption + 48], shown[sizeof caption + 4];
    snprintf(caption, sizeof caption, "%s", s->panel[i].caption);
    if (s->panel[i].moved && w->f[i] && !s->panel[i].worded)
        snprintf(caption, sizeof caption, "%s, %.4g s", s->panel[i].caption, w->f[i]->time);
    font_shorten(w->p->font, caption, c.width - size, shown);
    font_draw_middle(w->p->font, &w->p->image, c.x + c.width / 2, c.x, c.x + c.width, c.y + (int)lround(1.4 * size),
                     shown, ink);
}

/* A bar where `bar`, and the keys of panel i where `keys`, in [x, x + width) from y down. */
static int put_legend(work *w, int i, bool bar, bool keys, int x, int y, int width, err *e)
{
    picture *p = w->p;
    if (bar) {
        double scale;
        char words[200];
        const char *unit = field_unit(&w->field[0], w->m, fmax(fabs(w->low), fabs(w->high)), &scale);
        snprintf(words, sizeof words, "%s%s%s", w->field[0].label, *unit ? ", " : "", unit);
        legend_bar(&p->image, p->font, w->letters, x, y, width, &p->map, w->low * scale, w->high * scale, words);
        y += legend_bar_height(w->letters);
    }
    return keys ? legend_keys(&p->image, p->font, w->letters, x, y, width, w->key[i], w->keys[i], e) : 0;
}

static int put_words(work *w, err *e)
{
    const picture_spec *s = w->p->spec;
    int bad = 0;
    if (!w->p->font)
        return 0;
    for (int i = 0; i < s->panels && !bad; i++) {
        sheet_cell c = sheet_picture(&w->sheet, i);
        if (s->captions)
            put_caption(w, i);
        bad = put_legend(w, i, has_bar(w, i) && !w->one_bar, !w->one_key, c.x, c.y + c.height, c.width, e);
    }
    return bad ? -1 : put_legend(w, 0, w->one_bar, w->one_key, 0, w->sheet.height, s->width, e);
}

/* ---- all together */

/* Contraction centres lie within bone and muscle: what hides them lets them shine through. */
static int trace_marks(work *w, int i, image *im, err *e)
{
    static const float shine = .6f;
    const showing *b = &w->showing[i];
    trace_options o = trace_defaults();
    scene marks = {.sphere_sets = 1, .spheres = b->scene.spheres ? &b->scene.spheres[b->marks] : NULL};
    image over = {0};
    if (!b->marked)
        return 0;
    memcpy(o.background, none, sizeof none);
    if (image_create(&over, im->width, im->height, e))
        return -1;
    int bad = trace(&marks, &w->p->camera[i], &over, w->p->threads, &o, NULL, e);
    for (int64_t n = 0; n < 4 * (int64_t)over.width * over.height && !bad; n++)
        over.pixel[n] *= shine;
    image_over(im, &over, 0, 0);
    image_free(&over);
    return bad;
}

/* Whether a panel is all of the picture: then it is drawn there, not beside it and laid over. */
static bool fills(const work *w, int i)
{
    sheet_cell c = sheet_picture(&w->sheet, i);
    return c.x == 0 && c.y == 0 && c.width == w->p->image.width && c.height == w->p->image.height;
}

static int trace_panel(work *w, int i, err *e)
{
    picture *p = w->p;
    trace_options o = trace_defaults();
    trace_report r = {0};
    image part = {0}, *im = fills(w, i) ? &p->image : &part;
    sheet_cell c = sheet_picture(&w->sheet, i);
    memcpy(o.background, im == &part ? none : paper[p->spec->transparent], sizeof o.background);
    if (im == &part && image_create(im, c.width, c.height, e))
        return -1;
    int bad = trace(&w->showing[i].scene, &p->camera[i], im, p->threads, &o, &r, e);
    if (!bad && !r.covered)
        bad = err_set(e, NULL, 0, "the picture is empty: the camera looks past the model");
    if (!bad)
        bad = trace_marks(w, i, im, e);
    if (im == &part)
        image_over(&p->image, im, c.x, c.y);
    image_free(&part);
    p->report.build += r.build, p->report.trace += r.trace, p->report.rays += r.rays;
    p->report.faces += r.faces, p->report.spheres += r.spheres;
    return bad;
}

static int draw(work *w, err *e)
{
    picture *p = w->p;
    const picture_spec *s = p->spec;
    w->coloured = s->field != NULL;
    if ((w->coloured && make_fields(w, e)) || showing_panels(w, e))
        return -1;
    if (w->coloured)
        find_range(w);
    make_keys(w);
    find_shared(w);
    if (lay_out(w, e) || place_cameras(w, e))
        return -1;
    p->report = (trace_report){0};
    if (!fills(w, 0))
        image_fill(&p->image, paper[s->transparent]);
    for (int i = 0; i < s->panels; i++)
        if (trace_panel(w, i, e))
            return -1;
    return put_words(w, e);
}

int picture_draw(picture *p, const model *m, const frame *const f[PICTURE_PANELS], err *e)
{
    work *w = mem_array(1, sizeof *w, "a picture", e);
    if (!w)
        return -1;
    w->p = p, w->m = m, w->f = f;
    int bad = draw(w, e);
    for (int i = 0; i < PICTURE_PANELS; i++)
        showing_free(&w->showing[i]), field_free(&w->field[i]);
    free(w);
    return bad;
}
