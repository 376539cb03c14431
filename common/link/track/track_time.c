#include "link/track/track_time.h"

#include "link/igtl.h"

#include <math.h>

/* What stands for the stamp of a pose that has none. */
static double stamp_of(const track_time *t, uint64_t stamp, double came)
{
    if (stamp)
        return igtl_seconds(stamp);
    return t->begun ? t->stamp + (came - t->came) : came;
}

static void put(track_time *t, double stamp, double came, double time)
{
    *t = (track_time){true, stamp - time, stamp, came, time};
}

track_when track_time_of(track_time *t, uint64_t stamp, double came, double *time, double *jump)
{
    const double at = stamp_of(t, stamp, came), passed = came - t->came;
    const double on = at - t->stamp; /* by the sender's clock */
    *jump = 0;
    if (!t->begun) {
        put(t, at, came, 0);
        *time = 0;
        return TRACK_ON_TIME;
    }
    if (on < 0 && on >= -TRACK_TIME_LATE) {
        *jump = on;
        return TRACK_LATE;
    }
    if (on < 0 || on > passed + TRACK_TIME_AHEAD) {
        *jump = on < 0 ? on : on - passed;
        *time = t->last + passed;
        put(t, at, came, *time);
        return TRACK_JUMP;
    }
    *time = fmax(t->last, at - t->origin);
    t->stamp = at;
    t->came = came;
    t->last = *time;
    return TRACK_ON_TIME;
}
