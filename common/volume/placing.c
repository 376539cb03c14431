#include "volume/placing.h"

#include "place/transform.h"

int placing_read(placing *p, const char *body_path, const char *marker_path, body *parts, err *e)
{
    body all = {.volume = pose_none()};
    *p = (placing){.has_body = body_path != NULL, .has_marker = marker_path != NULL, .marker = pose_none()};
    if ((body_path && body_open(&all, body_path, e)) || (marker_path && transform_marker(marker_path, &p->marker, e))) {
        body_free(&all);
        return -1;
    }
    p->body = all.volume;
    if (parts)
        *parts = all;
    else
        body_free(&all);
    return 0;
}

pose placing_of(const placing *p, const pose *came)
{
    const pose at = p->has_marker ? pose_compose(came, &p->marker) : *came;
    return p->has_body ? pose_relative(&p->body, &at) : at;
}
