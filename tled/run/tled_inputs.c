#include "tled/run/tled_inputs.h"

#include "probe/probe_carry.h"
#include "tled/run/tled_live.h"
#include "volume/placing.h"

static int read_rigid_poses(session *s, const struct options *o, err *e)
{
    placing of;
    if (!o->rigid_poses)
        return 0;
    if (placing_read(&of, o->body, NULL, NULL, e))
        return -1;
    in *source = in_open(o->rigid_poses, e);
    const int failed = source ? script_read_poses(&s->script, source, &s->m, &of.body, e) : -1;
    in_close(source);
    return failed;
}

static int read_expressions(session *s, const struct options *o, err *e)
{
    if (!o->expressions)
        return 0;
    in *source = in_open(o->expressions, e);
    const int failed = source ? expressions_read(&s->expressions, source, &s->m, e) : -1;
    in_close(source);
    s->script.expressions = &s->expressions;
    return failed;
}

static int read_track(session *s, const struct options *o, err *e)
{
    if (!o->activations)
        return 0;
    in *source = in_open(o->activations, e);
    const int failed = source ? script_read_track(&s->script, source, &s->m, o->between == 1, e) : -1;
    in_close(source);
    return failed;
}

static int read_script(session *s, const struct options *o, err *e)
{
    in *source = o->script ? in_open(o->script, e) : NULL;
    s->script.unit = o->unit;
    int result = o->script && (!source || script_read(&s->script, source, &s->m, e)) ? -1 : 0;
    in_close(source);
    return result;
}

int tled_inputs_script(session *s, const struct options *o, err *e)
{
    if (o->rise_fall.count)
        s->script.times = (activation_times){o->rise_fall.value[0], o->rise_fall.value[1]};
    int result =
        read_expressions(s, o, e) || read_script(s, o, e) || read_rigid_poses(s, o, e) || read_track(s, o, e) ? -1 : 0;
    for (int i = 0; !result && i < o->contract.count; i++)
        result = script_add_contract(&s->script, &s->m, o->contract.value[i], o->ramp, e);
    if (!result && o->gravity.count)
        result = script_add_gravity(&s->script, o->gravity.value, o->ramp, e);
    if (!result)
        result = script_check_levels(&s->script, &s->m, &s->warnings, e);
    return result ? result : script_check_muscles(&s->script, &s->m, &s->warnings, e);
}

static int read_poses(session *s, const struct options *o, err *e)
{
    placing of;
    if (placing_read(&of, o->body, o->marker, NULL, e))
        return -1;
    if (s->live)
        return live_collider(s, &of, e);
    return collider_read_poses(&s->collider, o->poses, &of, e);
}

int tled_inputs_collider(session *s, const struct options *o, err *e)
{
    if (!o->probe && !o->poses)
        return 0;
    if (!o->probe || (!o->poses && !o->lines && !o->replay))
        return err_usage(e, "--%s without --%s; expected both", o->probe ? "probe" : "poses",
                         o->probe ? "poses" : "probe");
    return probe_read(&s->collider.shape, o->probe, o->unit, o->common.anonymous, &s->m, e) || read_poses(s, o, e) ||
                   model_axis_add(&s->m, "probe", 1, e) || probe_carry(&s->collider.shape, &s->m, &s->warnings, e)
               ? -1
               : 0;
}
