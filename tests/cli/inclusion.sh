# shellcheck shell=sh
# A cylinder of another stiffness in plane strain, against its closed form (Muskhelishvili): for tests and tests/bench/border.
# Wants T. The far strain is 1e-3 along x and -3e-4 along y; the slab is 1 m wide and has N x N voxels, one thick; the cylinder,
# of radius 0.3 m, has its axis DX and DY voxels from the middle. E is 1000 Pa outside, RATIO times that inside.

# inclusion_is AWK: defines ux(x, y), uy(x, y) from the axis, and the strains inside, in awk, for nu and ratio.
inclusion_is='
    function set_up(nu, ratio,   mu, k, in_mu) {
        R = 0.3; EM = 3.5e-4; ED = 6.5e-4
        mu = 1; in_mu = ratio; KAPPA = 3 - 4 * nu
        wide = 1 / (1 - 2 * nu) # (lambda + mu)/mu
        INM = EM * (wide + 1) / (ratio * wide + 1); OUTM = (INM - EM) * R ^ 2
        IND = ED * (KAPPA + 1) / (1 + KAPPA * ratio); B = R ^ 2 * (IND - ED) / KAPPA
    }
    function move(x, y,   r, t, a, b) {
        r = sqrt(x * x + y * y)
        if (r <= R) { UX = (INM + IND) * x; UY = (INM - IND) * y; return }
        t = atan2(y, x); a = KAPPA * B / r + ED * r; b = B / r - B * R ^ 2 / r ^ 3
        UX = EM * x + OUTM * x / r ^ 2 + a * cos(t) + b * cos(3 * t)
        UY = EM * y + OUTM * y / r ^ 2 - a * sin(t) + b * sin(3 * t)
    }'

# inclusion N RATIO NU DX DY ARGS...: the model, without its run, to $T/inclusion, and what moves it to $T/script.
inclusion() {
    n=$1 ratio=$2 nu=$3 dx=$4 dy=$5
    shift 5
    awk -v n="$n" -v dx="$dx" -v dy="$dy" 'BEGIN {
        h = 1 / n; m = 512; pi = atan2(0, -1); r = 0.3 * sqrt(2 * pi / m / sin(2 * pi / m))
        for (k = 0; k < 8; k++) print "v", k % 2, int(k / 2) % 2, int(k / 4) * h
        for (k = 0; k < 2; k++) for (i = 0; i < m; i++)
            printf "v %.12g %.12g %.12g\n", 0.5 + dx * h + r * cos(2 * pi * i / m), 0.5 + dy * h + r * sin(2 * pi * i / m), (3 * k - 1) * h
        print "g skin\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\ng inner"
        low = "f"; high = "f"
        for (i = 0; i < m; i++) {
            j = (i + 1) % m; low = low " " 9 + m - 1 - i; high = high " " 9 + m + i
            print "f", 9 + i, 9 + j, 9 + m + j, 9 + m + i
        }
        print low; print high
    }' >"$T/inclusion.obj"
    printf 'skin surfaces=skin material=soft\ninner level=1 surfaces=inner material=stiff\n' >"$T/inclusion.volumes"
    awk -v nu="$nu" -v ratio="$ratio" 'BEGIN { print "soft E=1000 nu=" nu "\nstiff E=" 1000 * ratio " nu=" nu }' >"$T/inclusion.materials"
    voxelise -q --unit m -s "$(awk -v n="$n" 'BEGIN { printf "%.17g", 1 / n }')" --origin 0,0,0 --volumes "$T/inclusion.volumes" \
        --materials "$T/inclusion.materials" "$@" "$T/inclusion.obj" >"$T/inclusion" 2>"$T/said"
    awk -v n="$n" -v nu="$nu" -v ratio="$ratio" -v dx="$dx" -v dy="$dy" "$inclusion_is"'BEGIN {
        set_up(nu, ratio); print "0 displace -1,-1,-1,2,2,2 -,-,0"
        for (i = 0; i <= n; i++) for (j = 0; j <= n; j++) if (i % n == 0 || j % n == 0) {
            x = i / n; y = j / n; e = 0.1 / n; move(x - 0.5 - dx / n, y - 0.5 - dy / n)
            to = sprintf("displace %.9g,%.9g,-1,%.9g,%.9g,2", x - e, y - e, x + e, y + e)
            printf "0 %s 0,0,-\n0.02 %s %.12g,%.12g,-\n", to, to, UX, UY
        } }' >"$T/script"
}

# inclusion_errors N RATIO NU DX DY ARGS...: the root mean square of the displacement's error, in parts of what the cylinder changes
# of it, and how far the mean strain is off in elements that are wholly inside, in parts of the strain there.
inclusion_errors() {
    inclusion "$@"
    tled-run -q -d cpu --text --rest 1e-7 --script "$T/script" <"$T/inclusion" 2>"$T/said" |
        awk -v n="$1" -v ratio="$2" -v nu="$3" -v dx="$4" -v dy="$5" "$inclusion_is"'
            $1 == "array" { on = $2; k = 0; next }
            /^[^-+0-9]/ { on = "" }
            on == "node.position" { x[k] = $1 - 0.5 - dx / n; y[k++] = $2 - 0.5 - dy / n }
            on == "element.node" { for (c = 0; c < 8; c++) node[k, c] = $(c + 1); elements = ++k }
            on == "node.displacement" { u[k] = $1; v[k++] = $2; nodes = k }
            END {
                set_up(nu, ratio)
                for (i = 0; i < nodes; i++) {
                    move(x[i], y[i]); off += (u[i] - UX) ^ 2 + (v[i] - UY) ^ 2
                    all += (UX - (EM + ED) * x[i]) ^ 2 + (UY - (EM - ED) * y[i]) ^ 2
                }
                for (i = 0; i < elements; i++) {
                    xx = xy = yx = yy = far = 0
                    for (c = 0; c < 8; c++) {
                        p = node[i, c]; sx = c % 4 == 1 || c % 4 == 2 ? 1 : -1; sy = c % 4 > 1 ? 1 : -1
                        xx += sx * u[p] * n / 4; xy += sy * u[p] * n / 4; yx += sx * v[p] * n / 4; yy += sy * v[p] * n / 4
                        r = sqrt(x[p] ^ 2 + y[p] ^ 2); if (r > far) far = r
                    }
                    if (far < R) { a += xx; b += xy; c1 += yx; d += yy; inside++ }
                }
                strain = sqrt((a / inside - INM - IND) ^ 2 + (b / inside) ^ 2 + (c1 / inside) ^ 2 + (d / inside - INM + IND) ^ 2)
                printf "%.4g %.4g\n", sqrt(off / all), strain / sqrt((INM + IND) ^ 2 + (INM - IND) ^ 2)
            }'
}

# inclusion_mean N RATIO NU ARGS...: the means of these over four places of the lattice.
inclusion_mean() {
    n=$1 ratio=$2 nu=$3
    shift 3
    for at in "0 0" "0.5 0.5" "0.25 0.1" "0.37 -0.29"; do
        # shellcheck disable=SC2086 # two numbers
        inclusion_errors "$n" "$ratio" "$nu" $at "$@"
    done | awk '{ a += $1 / 4; b += $2 / 4 } END { printf "%.3g %.3g\n", a, b }'
}
