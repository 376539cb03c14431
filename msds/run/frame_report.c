#include "msds/run/frame_report.h"

#include <math.h>
#include <stdio.h>

void frame_report_work(void *context, const msds_progress *now)
{
    session *s = context;
    char text[300], left[40] = "", at[80] = "", share[20] = "";
    if (!progress_due(&s->progress))
        return;
    if (now && now->share > 0)
        snprintf(share, sizeof share, ", %.0f %%", 100 * now->share);
    if (now && !isnan(now->residual))
        snprintf(left, sizeof left, ", residual %.2g", now->residual);
    if (now && now->solve)
        snprintf(at, sizeof at, "solve %d%s, %lld nodes near the probe: ", now->solve, left, (long long)now->contacts);
    snprintf(text, sizeof text, "pose %lld, %.6g s%s%s%s%s", (long long)s->posed + 1, s->time, now ? ": " : "", at,
             now ? now->what : "", share);
    progress_text(&s->progress, text);
}

static double size_of(const double force[3])
{
    return sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
}

/* A row of the report on frames: with --residual, --compare or -v. */
static void say_row(session *s, const char *row)
{
    progress_clear(&s->progress);
    if (s->o->residual || s->other)
        tool_say(s->t, "%s", row);
    else
        tool_detail(s->t, "%s", row);
}

/* Columns of cavities: how far each is open. heading: their names. */
static void put_cavities(const session *s, bool heading, char *to, size_t size)
{
    const model_array *name = model_find(&s->m, "volume.name");
    size_t at = 0;
    to[0] = 0;
    for (int c = 0; c < s->cavities.count && at < size; c++)
        at += (size_t)(heading ? snprintf(to + at, size - at, "  %7.7s%%", name->str[s->cavities.list[c].volume])
                               : snprintf(to + at, size - at, "  %8.3g", 100 * s->openness.now[c]));
}

static void say_heading(session *s)
{
    char row[1200], hollow[800];
    put_cavities(s, true, hollow, sizeof hollow);
    snprintf(row, sizeof row, "%10s  %-10s  %7s  %9s  %9s  %6s%s  %8s%s", "time/s", "method", "pressed", "force/N",
             "residual", "solves", s->other ? "  other's/N   rms/rms   max/max" : "", "inverted", hollow);
    say_row(s, row);
}

/* As the table has it: --warp, which holds for all of a run, is not said again. */
static const char *name_of(const session *s)
{
    if (s->used == METHOD_EXACT || (s->used == METHOD_EXACT_WARP && s->o->warp))
        return "fem-exact";
    return s->used == METHOD_WARP && s->o->warp ? "fem" : methods_words[s->used];
}

/* The largest values so far: the last pose may have left the tissue. */
static void find_peaks(session *s)
{
    const double force = size_of(s->reading.force);
    if (s->posed == 1 || s->reading.largest > s->moved.value)
        s->moved = (peak){s->reading.largest, s->time, 0};
    if (force > s->pushed.value)
        s->pushed = (peak){force, s->time, s->reading.contacts};
}

void frame_report_row(session *s)
{
    const msds_reading *reading = &s->reading;
    char left[40] = "-", solves[40] = "-", other[100] = "", row[1200], hollow[800];
    if (!isnan(reading->residual))
        snprintf(left, sizeof left, "%.3g", reading->residual);
    if (reading->solves)
        snprintf(solves, sizeof solves, "%d", reading->solves);
    if (s->other)
        snprintf(other, sizeof other, "  %9.4g  %8.4g  %8.4g", size_of(s->other->reading.force), s->other->mean,
                 s->other->worst);
    put_cavities(s, false, hollow, sizeof hollow);
    snprintf(row, sizeof row, "%10.6g  %-10s  %7lld  %9.4g  %9s  %6s%s  %8lld%s", s->time, name_of(s),
             (long long)reading->contacts, size_of(reading->force), left, solves, other, (long long)s->inverted.now,
             hollow);
    if (s->posed == 1)
        say_heading(s);
    say_row(s, row);
    find_peaks(s);
}

static void warn_of_misses(session *s)
{
    if (s->o->probe && !s->pressed)
        notes_add(
            &s->warnings,
            "the probe touches nothing in any frame (%lld in all); expected poses in metres, in the model's space, "
            "and nodes closer together than the probe is wide",
            (long long)s->posed);
    if (s->pressed && s->skin.vertices && !s->dented)
        notes_add(&s->warnings,
                  "the probe presses the tissue, but touches the skin in no frame; expected %s in the place of the "
                  "tissue; check --unit",
                  s->skin_name);
}

static void say_cavities(const session *s)
{
    const model_array *name = model_find(&s->m, "volume.name");
    for (int c = 0; c < s->cavities.count; c++)
        tool_say(s->t, "cavity %s: %.4g ml at rest; at least %.3g %% of that, at %.6g s; %.3g %% at the end",
                 name->str[s->cavities.list[c].volume], 1e6 * s->openness.at_rest[c], 100 * s->openness.least[c],
                 s->openness.least_time[c], 100 * s->openness.now[c]);
}

static void warn_of_bone(session *s)
{
    if (s->stopped)
        notes_add(&s->warnings, "a rigid volume kept the probe from its pose in %lld of %lld frames, first at %.6g s",
                  (long long)s->stopped, (long long)s->posed, s->stopped_first);
}

void frame_report_words(const session *s, char *to, size_t size)
{
    char force[200] = "";
    const peak *u = &s->moved, *f = &s->pushed;
    if (f->value > 0)
        snprintf(force, sizeof force, "; largest force on the probe %.4g N, from %lld node%s, at %.6g s", f->value,
                 (long long)f->contacts, f->contacts == 1 ? "" : "s", f->time);
    else if (s->o->probe)
        snprintf(force, sizeof force, "; no force on the probe");
    snprintf(to, size, "%lld pose%s, to %.6g s: largest displacement %.6g mm, at %.6g s%s", (long long)s->posed,
             s->posed == 1 ? "" : "s", s->time, 1e3 * u->value, u->time, force);
}

void frame_report_end(session *s)
{
    char text[FRAME_REPORT_WORDS];
    warn_of_misses(s);
    warn_of_bone(s);
    inverted_warn(&s->inverted, s->posed, methods_words[s->used], &s->warnings);
    frame_report_words(s, text, sizeof text);
    tool_say(s->t, "%s", text);
    say_cavities(s);
}

/* Live, where no line is known, it is said once. */
static void warn_of_inside(session *s, int64_t line, const press_moves *moves)
{
    char place[300] = "";
    if (!line && s->inside_told)
        return;
    s->inside_told = true;
    if (line)
        snprintf(place, sizeof place, "%s:%lld: ", s->source, (long long)line);
    notes_add(&s->warnings,
              "%sthe probe begins inside the tissue; it is moved in along its axis, from %.3g mm back, in %d moves",
              place, 1e3 * moves->back, moves->count);
}

/* Said once; at the end, how often. */
static void note_stop(session *s, const pose *at, int64_t line, const press_moves *moves)
{
    char place[300] = "";
    double square = 0;
    if (s->stopped++)
        return;
    s->stopped_first = s->time;
    for (int a = 0; a < 3; a++)
        square += pow(press_end(moves)->position[a] - at->position[a], 2);
    if (line)
        snprintf(place, sizeof place, "%s:%lld: ", s->source, (long long)line);
    notes_add(&s->warnings, "%sthe probe would enter a rigid volume, and stops %.3g mm before its pose", place,
              1e3 * sqrt(square));
}

void frame_report_pose(session *s, const pose *at, int64_t line, const press_moves *moves, bool first)
{
    const probe_placed placed = probe_place(&s->probe, at);
    if (first && probe_is_plate(&placed, s->problem.position, s->problem.nodes))
        notes_add(&s->warnings, "the probe's face is larger than the tissue: it presses like a plate");
    if (first && probe_is_thin(&s->probe, s->problem.side))
        notes_add(
            &s->warnings,
            "the probe is %.3g mm thick, cells are %.3g mm wide: it may slip between nodes; expected a finer mesh",
            2e3 * s->probe.size, 1e3 * s->problem.side);
    if (moves->inside)
        warn_of_inside(s, line, moves);
    if (moves->stopped)
        note_stop(s, at, line, moves);
    if (s->warnings.count)
        progress_clear(&s->progress);
    tool_warn(s->t, &s->warnings);
}
