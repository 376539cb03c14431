# A quarter of a layer that is bonded to bone, its middle at 0,0 (mm, tissue's skin and bone below), and a ball over it.
#   W, H   how wide the quarter is, and how thick
#   R, D   the ball's radius, and how deep it is to be pressed in
#   what   layer: the OBJ of the layer; ball: of the ball's underside, which touches the layer; script: what holds the sides where the
#          layer goes on, and presses the body `ball` in by 0.1 s; poses: the same way for --probe; force: by E and nu, a quarter of
#          the force of the bonded layer's formula, N, of lengths in mm (Dimitriadis et al. 2002, Biophysical Journal 82:2798, eq. 10)
function power(x, n) { return n ? x * power(x, n - 1) : 1 }
BEGIN {
    if (what == "layer") {
        printf "g skin\nv 0 0 0\nv %g 0 0\nv %g %g 0\nv 0 %g 0\nv 0 0 %g\nv %g 0 %g\nv %g %g %g\nv 0 %g %g\n", W, W, W, W, H, W, H, W, W, H, W, H
        print "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 7 8\ng bone\nf 4 3 2 1"
    }
    if (what == "ball") {
        step = 2.86 * sqrt(R * D) / 30
        print "g ball"
        for (j = -6; j <= 30; j++) for (i = -6; i <= 30; i++) printf "v %.9g %.9g %.9g\n", i * step, j * step, H + R - sqrt(R * R - (i * i + j * j) * step * step)
        for (j = 0; j < 36; j++) for (i = 0; i < 36; i++) { a = 37 * j + i + 1; print "f", a, a + 37, a + 38, a + 1 }
    }
    if (what == "script") {
        print "0 displace -1mm,-1mm,.1mm,.01mm,999mm,999mm 0,-,-\n0 displace -1mm,-1mm,.1mm,999mm,.01mm,999mm -,0,-"
        if (!still) printf "0 move ball 0,0,0 0,0,0,1\n.1 move ball 0,0,-%gmm 0,0,0,1\n1 move ball 0,0,-%gmm 0,0,0,1\n", D, D
    }
    if (what == "poses") printf "0 0 0 %g 1 0 0 0\n.1 0 0 %g 1 0 0 0\n1 0 0 %g 1 0 0 0\n", H / 1e3, (H - D) / 1e3, (H - D) / 1e3
    if (what == "force") {
        pi = atan2(0, -1)
        a = -(1.2876 - 1.4678 * nu + 1.3442 * nu * nu) / (1 - nu)
        b = (.6387 - 1.0277 * nu + 1.5164 * nu * nu) / (1 - nu)
        x = sqrt(R * D) / H
        more = 1 - 2 * a / pi * x + power(2 * a * x / pi, 2) - 8 * power(x / pi, 3) * (power(a, 3) + 4 * pi * pi / 15 * b) + 16 * a * power(x / pi, 4) * (power(a, 3) + 3 * pi * pi / 5 * b)
        print E / (3 * (1 - nu * nu)) * sqrt(R * D * D * D) * 1e-6 * more
    }
}
