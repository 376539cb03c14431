# Bisshopp and Drucker's elastica (Quarterly of Applied Mathematics 3, 1945): a cantilever that only bends, under a load P across its end that
# keeps its direction. For a = P L^2 / (E I), prints how far the end moves across and along the beam, over L, and its slope in degrees.
# theta'' = -a cos(theta) along the length, theta(0) = 0, theta'(1) = 0: by bisection of theta'(0), in leapfrog steps.
function shoot(curvature,    i, n, h, t, w) { # theta'(1)
    n = 4000
    h = 1 / n
    t = x = y = 0
    w = curvature
    for (i = 0; i < n; i++) {
        t += h / 2 * w
        x += h * cos(t)
        y += h * sin(t)
        w -= h * a * cos(t)
        t += h / 2 * w
    }
    slope = t
    return w
}
BEGIN {
    high = a
    for (k = 0; k < 60; k++) {
        middle = (low + high) / 2
        # Too much curvature at the root turns the end past the load, where it bends on.
        if (shoot(middle) > 0 || slope > atan2(1, 0)) high = middle
        else low = middle
    }
    shoot(low)
    printf "%.6f %.6f %.2f\n", y, 1 - x, slope * 180 / atan2(0, -1)
}
