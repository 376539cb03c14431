#include "render/render_plan.h"

#include "base/mem.h"
#include "base/near.h"
#include "cli/spelling.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CLEARS = 64 }; /* showing_want has room for so many */

static int usage(err *e)
{
    e->status = STATUS_USAGE;
    return -1;
}

static num_unit metre(void)
{
    return num_unit_of("m");
}

/* ---- lists: all values of an option, split at their commas, one after the other in `text` */

/* Room for every list of the command line. */
static int make_text(render_plan *p, const render_options *o, err *e)
{
    const opt_list *const lists[] = {&o->show, &o->clear, &o->sheet, &o->cut};
    size_t size = 1;
    for (int l = 0; l < 4; l++)
        for (int i = 0; i < lists[l]->count; i++)
            size += strlen(lists[l]->value[i]) + 1;
    p->text = mem_array((int64_t)size, 1, "options", e);
    return p->text ? 0 : -1;
}

/* Splits a list; returns how many are at list[0], … or -1; the rest of list stays NULL. *at moves on. */
static int split(const opt_list *from, const char *option, char **at, const char **list, int room, err *e)
{
    int count = 0;
    for (int i = 0; i < from->count; i++) {
        char *end = strcpy(*at, from->value[i]) + strlen(from->value[i]);
        for (char *word = *at, *comma; word; word = comma) {
            comma = strchr(word, ',');
            if (comma)
                *comma++ = 0;
            if (!*word)
                return err_set(e, NULL, 0, "%s '%s': an empty name", option, from->value[i]);
            if (count == room)
                return err_set(e, NULL, 0, "%s: more than %d names", option, room);
            list[count++] = word;
        }
        *at = end + 1;
    }
    return count;
}

/* ---- views */

static int view_named(picture_view *v, const picture_spec *s, const char *name, err *e)
{
    camera c;
    if (camera_view(&c, name, s->up, s->front, e))
        return -1;
    v->kind = PICTURE_NAMED;
    snprintf(v->name, sizeof v->name, "%s", name);
    return 0;
}

static int read_view(picture_view *v, const picture_spec *s, const char *text, err *e)
{
    double from[3] = {0}, middle[3] = {0};
    camera c;
    if (!strchr(text, ','))
        return view_named(v, s, text, e);
    if (num_list(text, from, 3) != 3)
        return err_set(e, NULL, 0, "--view '%s': expected %s, or the way to the eye as X,Y,Z", text, CAMERA_VIEWS);
    v->kind = PICTURE_FROM;
    memcpy(v->from, from, sizeof from);
    return camera_look(&c, from, middle, s->up, false, 20, e);
}

static int read_camera(picture_view *v, const picture_spec *s, const opt_lengths *place, err *e)
{
    camera c;
    if (place->count != 6)
        return err_set(e, NULL, 0, "--camera: %d numbers; expected 6: the eye and what it looks at", place->count);
    v->kind = PICTURE_PLACED;
    for (int i = 0; i < 3; i++) {
        v->eye[i] = num_length_in(place->value[i], metre(), metre());
        v->target[i] = num_length_in(place->value[3 + i], metre(), metre());
    }
    return camera_look(&c, v->eye, v->target, s->up, false, 20, e);
}

/* The way that a model looks, where only its up is told: as our samples and most heads do. */
static const char *front_of(const double up[3])
{
    return up[2] != 0 ? "y" : "z";
}

static int read_axes(picture_spec *s, const render_options *o, err *e)
{
    camera c;
    if (camera_axis(o->up ? o->up : "y", s->up, e))
        return -1;
    if (camera_axis(o->front ? o->front : front_of(s->up), s->front, e))
        return -1;
    return camera_view(&c, "front", s->up, s->front, e);
}

/* ---- panels */

static const char *const panels[] = {"rest", "voxels", "deformed"};
static const char undeformed[] = "undeformed"; /* the same as rest */
enum { REST, VOXELS, DEFORMED, VIEWED };

/* A panel's name is one of these, or a view: then all else is as the other options say. */
static void name_panel(picture_panel *p, const picture_panel *as_asked, int which)
{
    picture_view view = p->view;
    *p = (picture_panel){.view = view};
    if (which == REST)
        strcpy(p->caption, "at rest");
    if (which == VOXELS) {
        p->things = SHOWING_VOXELS | SHOWING_MUSCLES | SHOWING_RIGID | SHOWING_CENTRES;
        p->what_there_is = true;
        strcpy(p->caption, "voxels");
    }
    if (which == DEFORMED) {
        p->moved = p->coloured = true;
        p->things = as_asked->things & SHOWING_PROBE;
        strcpy(p->caption, "deformed");
    }
    if (which == VIEWED) {
        *p = *as_asked;
        p->view = view;
    }
}

static int unknown_panel(const char *name, err *e)
{
    char views[] = CAMERA_VIEWS;
    const char *names[16] = {0};
    int count = 0;
    for (; count < 3; count++)
        names[count] = panels[count];
    for (char *next = views, *word = next; next && count < 16; word = next) {
        next = strstr(word, ", ");
        if (next) {
            *next = 0;
            next += 2;
        }
        names[count++] = word;
    }
    return near_option(e, NULL, "panel", name, names, count);
}

/* "rest", "left", "rest@left". */
static int read_shown(picture_panel *p, const picture_spec *s, const picture_panel *as_asked, const char *text, err *e)
{
    const char *at = strchr(text, '@');
    size_t n = at ? (size_t)(at - text) : strlen(text), used;
    int which = 0;
    err ignored = {0};
    const bool at_rest = n == strlen(undeformed) && !strncmp(text, undeformed, n);
    while (!at_rest && which < VIEWED && (strlen(panels[which]) != n || strncmp(panels[which], text, n) != 0))
        which++;
    p->view = as_asked->view;
    if (which == VIEWED && (at || view_named(&p->view, s, text, &ignored)))
        return unknown_panel(text, e);
    if (at && view_named(&p->view, s, at + 1, e))
        return -1;
    name_panel(p, as_asked, which);
    used = strlen(p->caption);
    if (which == VIEWED || at)
        snprintf(p->caption + used, sizeof p->caption - used, "%s%s", used ? ", " : "", p->view.name);
    return 0;
}

/* ":12", after a panel. */
static int read_index(picture_panel *p, const char *colon, const char *text, err *e)
{
    p->framed = true;
    if (num_int(colon + 1, 0, INT64_MAX, &p->index))
        return err_set(e, NULL, 0, "--sheet %s: expected the index of a frame after the colon", text);
    if (!p->moved)
        return err_set(e, NULL, 0, "--sheet %s: this panel is at rest; expected no frame", text);
    return 0;
}

/* The same after "CAPTION=" and before ":FRAME". */
static int read_panel(picture_panel *p, const picture_spec *s, const picture_panel *as_asked, const char *text, err *e)
{
    const char *equals = strchr(text, '='), *from = equals ? equals + 1 : text, *colon = strrchr(from, ':');
    const size_t words = equals ? (size_t)(equals - text) : 0, n = colon ? (size_t)(colon - from) : strlen(from);
    char shown[64];
    snprintf(shown, sizeof shown, "%.*s", (int)n, from);
    if (equals && (!words || words >= sizeof p->caption))
        return err_set(e, NULL, 0, "--sheet: a caption of %zu bytes; expected 1 to %zu", words, sizeof p->caption - 1);
    if (read_shown(p, s, as_asked, shown, e) || (colon && read_index(p, colon, text, e)))
        return -1;
    p->worded = equals != NULL;
    if (equals)
        snprintf(p->caption, sizeof p->caption, "%.*s", (int)words, text);
    return 0;
}

static int read_sheet(picture_spec *s, const char *const *list, int count, err *e)
{
    picture_panel as_asked = s->panel[0];
    if (count > PICTURE_PANELS)
        return err_set(e, NULL, 0, "--sheet: %d panels; expected %d at most", count, PICTURE_PANELS);
    for (int i = 0; i < count && list[i]; i++)
        if (read_panel(&s->panel[i], s, &as_asked, list[i], e))
            return -1;
    s->captions = count > 0;
    s->panels = count ? count : 1;
    return 0;
}

/* ---- the other options */

static int read_size(picture_spec *s, const char *text, err *e)
{
    int64_t width, height;
    char head[32];
    const char *x = strchr(text, 'x');
    snprintf(head, sizeof head, "%.*s", x ? (int)(x - text) : 0, text);
    if (!x || num_int(head, 1, IMAGE_SIDE_MOST, &width) || num_int(x + 1, 1, IMAGE_SIDE_MOST, &height))
        return err_set(e, NULL, 0, "--size '%s': expected WIDTHxHEIGHT in pixels, 1 to %d each", text, IMAGE_SIDE_MOST);
    s->width = (int)width;
    s->height = (int)height;
    return 0;
}

/* "x=1cm": away goes the side toward the eye; "+x=1cm", "-x=1cm": what lies above, below. */
static int read_cut(picture_cut *c, const char *text, err *e)
{
    const char *at = text + (*text == '+' || *text == '-');
    num_length length;
    if (*at < 'x' || *at > 'z' || at[1] != '=' || num_length_of(at + 2, &length))
        return err_set(e, NULL, 0, "--cut '%s': expected AXIS=POSITION, as x=0, +y=2cm or -z=5mm", text);
    c->axis = *at - 'x';
    c->side = (*text == '+') - (*text == '-');
    c->at = num_length_in(length, metre(), metre());
    return 0;
}

static int read_range(render_plan *p, const opt_lengths *range, err *e)
{
    picture_spec *s = &p->spec;
    if (!range->count)
        return 0;
    if (range->count != 2)
        return err_set(e, NULL, 0, "--range: expected two numbers, the ends of the scale");
    s->ranged = true;
    p->ranged_bare = !range->value[0].unit && !range->value[1].unit;
    s->low = num_length_in(range->value[0], metre(), metre());
    s->high = num_length_in(range->value[1], metre(), metre());
    return s->low < s->high ? 0 : err_set(e, NULL, 0, "--range %g,%g: the first must be the lower", s->low, s->high);
}

static int read_frames(render_plan *p, const render_options *o, err *e)
{
    const char *f = o->frame;
    p->frame_given = f != NULL;
    for (int i = 0; i < p->spec.panels; i++)
        p->panels_framed |= p->spec.panel[i].framed;
    if (f && p->panels_framed)
        return err_set(e, NULL, 0, "--frame %s: panels of --sheet name frames of their own; expected no --frame", f);
    if (frames_asked(f ? f : "last", &p->frames, &p->index, e))
        return -1;
    p->files = p->frames == FRAMES_ALL && o->format == RENDER_PNG;
    if (p->frames == FRAMES_ALL && p->spec.field && !p->spec.ranged)
        return err_set(e, NULL, 0,
                       "--frame all with --colour: expected --range A,B, so that a colour means the same in "
                       "every frame");
    return p->files ? numbered_of(&p->names, o->common.output, ", or --format ppm", e) : 0;
}

/* Which of the things that are shown; SHOWING_THINGS: none of them. */
static int thing_named(const char *name)
{
    char british[16];
    const char *ours = spelling_british(name, strlen(name), british, sizeof british) ? british : name;
    int t = 0;
    while (t < SHOWING_THINGS && strcmp(name, showing_things[t]) != 0 && strcmp(ours, showing_things[t]) != 0)
        t++;
    return t;
}

/* The one panel, or what those of a sheet begin with. */
static int read_panel_asked(render_plan *p, const render_options *o, char **at, err *e)
{
    picture_spec *s = &p->spec;
    picture_panel *panel = &s->panel[0];
    const char *things[64] = {0};
    int count = split(&o->show, "--show", at, things, 64, e);
    *panel = (picture_panel){.moved = true, .coloured = o->colour != NULL, .names = true};
    for (int i = 0; i < count && things[i]; i++) {
        const int t = thing_named(things[i]);
        if (t < SHOWING_THINGS)
            panel->things |= 1 << t;
        else
            p->name[s->names++] = things[i];
    }
    s->name = p->name;
    s->clear = p->name + s->names;
    s->clears = count < 0 ? -1 : split(&o->clear, "--clear", at, p->name + s->names, CLEARS, e);
    if (count < 0 || s->clears < 0)
        return -1;
    if (o->camera.count && o->view)
        return err_set(e, NULL, 0, "--camera and --view: expected one of them");
    return o->camera.count ? read_camera(&panel->view, s, &o->camera, e)
                           : read_view(&panel->view, s, o->view ? o->view : "three-quarter", e);
}

static int read_lists(render_plan *p, const render_options *o, err *e)
{
    picture_spec *s = &p->spec;
    char *at = p->text;
    const char *sheet[64] = {0}, *cut[64] = {0};
    if (read_panel_asked(p, o, &at, e))
        return -1;
    int panels_asked = split(&o->sheet, "--sheet", &at, sheet, 64, e);
    if (panels_asked < 0 || read_sheet(s, sheet, panels_asked, e))
        return -1;
    s->cuts = split(&o->cut, "--cut", &at, cut, 64, e);
    if (s->cuts > PICTURE_CUTS)
        return err_set(e, NULL, 0, "--cut: %d planes; expected %d at most", s->cuts, PICTURE_CUTS);
    for (int i = 0; i < s->cuts && cut[i]; i++)
        if (read_cut(&s->cut[i], cut[i], e))
            return -1;
    return s->cuts < 0 ? -1 : 0;
}

/* Only where something moves or is coloured does it say anything. */
static void read_colour(picture_spec *s, const render_options *o)
{
    bool deformed = false;
    for (int i = 0; i < s->panels; i++)
        deformed |= s->captions && s->panel[i].coloured;
    s->field = o->colour;
    if (!s->field && deformed)
        s->field = "displacement";
}

int render_plan_of(render_plan *p, const render_options *o, err *e)
{
    picture_spec *s = &p->spec;
    *p = (render_plan){0};
    s->transparent = o->transparent;
    s->slice = o->slice;
    s->body = o->body;
    s->angle = o->angle;
    s->margin = .03;
    if (make_text(p, o, e))
        return -1;
    if (read_axes(s, o, e) || read_size(s, o->size, e) || read_lists(p, o, e) || read_range(p, &o->range, e))
        return usage(e);
    read_colour(s, o);
    if (s->ranged && !s->field)
        err_set(e, NULL, 0, "--range is for --colour");
    else if (o->format == RENDER_PPM && o->transparent)
        err_set(e, NULL, 0, "--transparent is for png: ppm has no transparency");
    else if (!read_frames(p, o, e))
        return 0;
    return usage(e);
}

void render_plan_free(render_plan *p)
{
    free(p->text);
    *p = (render_plan){0};
}
