# The script of Biot's block of n x n x 1 elements of side h (m) in plane strain, pressed together along x by `strain` between its ends, which slide,
# on a floor that slides. Small forces f across its top, up and down by turns and more on one half, are to show whether it wrinkles.
BEGIN {
    l = n * h
    printf "0 displace 0,0,0,%.15g,%.15g,0 -,-,0\n", l, h
    printf "0 displace 0,0,0,%.15g,0,%.15g -,0,-\n", l, l
    printf "0 displace 0,%.15g,0,%.15g,%.15g,%.15g -,0,-\n", h, l, h, l
    printf "0 displace 0,0,0,0,%.15g,%.15g 0,-,-\n", h, l
    end = sprintf("displace %.15g,0,0,%.15g,%.15g,%.15g", l, l, h, l)
    printf "0 %s 0,-,-\n%g %s %.15g,-,-\n", end, ramp, end, -strain * l
    for (i = 1; i < n; i++) for (j = 0; j < 2; j++) {
        at = sprintf("force %.15g,%.15g,%.15g %.3g", i * h, j * h, l, h / 1000)
        push = f * ((i % 2 ? 1 : -1) + (i < n / 2 ? .5 : -.5))
        printf "0 %s 0,0,0\n%g %s 0,0,%.6g\n", at, ramp, at, push
    }
}
