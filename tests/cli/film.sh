# shellcheck shell=sh
# A slab with stiff layers at its skin, turned in the lattice, for the tests of voxelise --layers: its energy, stretched along the
# layers and bent, in parts of what composite beams have. In plane strain, with nu 0, that is the whole field: one strain, or one
# curvature about the axis through the middle of all stiffness, whatever the layers are. Wants T.

# slab ANGLE LAYER...: 160 x 34 mm in voxels of 10 mm, one thick, skin on one long side. A layer: its thickness (mm) and how many times
# as stiff it is as what is below, as 2:20. To $T/slab.obj, $T/slab.layers, $T/slab.materials and $T/slab.parts.
slab() {
    awk -v turn="$1" 'BEGIN {
        c = cos(turn * atan2(0, -1) / 180); s = sin(turn * atan2(0, -1) / 180)
        for (y = 0; y < 2; y++) for (k = 0; k < 2; k++) for (i = 0; i < 2; i++)
            printf "v %.12g %d %.12g\n", 160 * i * c - 34 * k * s, 10 * y, 160 * i * s + 34 * k * c
        print "g rigid_sides\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 1 5 7 3\nf 2 4 8 6\ng skin\nf 3 7 8 4"
    }' >"$T/slab.obj"
    shift
    echo "tissue E=3000 nu=0" >"$T/slab.materials"
    for layer; do echo "$layer"; done | awk -F : -v to="$T/slab" '{
        printf "layer%d thickness=%smm\n", NR, $1 >to ".layers"
        printf "layer%d E=%.9g nu=0\n", NR, 3000 * $2 >>to ".materials"
        print 34 - below - $1, 34 - below, $2 >to ".parts"
        below += $1
    } END { print 0, 34 - below, 1 >to ".parts" }'
}

# slab_is: AWK that reads $T/slab.parts into `axis`, and own[0] and own[1]: stiffness by that of what is below, stretched (m) and bent (m3).
# shellcheck disable=SC2016 # awk's
slab_is='
    FILENAME ~ /parts$/ { low[NR] = $1 / 1000; high[NR] = $2 / 1000; times[NR] = $3; parts = NR; next }
    FILENAME !~ /parts$/ && !known {
        for (i = 1; i <= parts; i++) { own[0] += times[i] * (high[i] - low[i]); axis += times[i] * (high[i] ^ 2 - low[i] ^ 2) / 2 }
        axis /= own[0]; known = 1
        for (i = 1; i <= parts; i++) own[1] += times[i] * ((high[i] - axis) ^ 3 - (low[i] - axis) ^ 3) / 3
    }'

# slab_energies ANGLE ORIGIN ARGS...: of the slab that was made: stretching and bending, in parts of the closed form.
slab_energies() {
    turn=$1 origin=$2
    shift 2
    voxelise -q --text --unit mm -s 10 --origin "$origin" --layers "$T/slab.layers" --materials "$T/slab.materials" "$@" "$T/slab.obj" >"$T/m" 2>"$T/said"
    for bent in 0 1; do
        awk -v turn="$turn" -v bent="$bent" "$slab_is"'
            FNR == 1 { c = cos(turn * atan2(0, -1) / 180); s = sin(turn * atan2(0, -1) / 180); print "0 displace -1,-1,-1,1,1,1 -,0,-" }
            $1 == "array" { on = $2 == "node.position"; next }
            /^[^-+0-9]/ { on = 0 }
            on {
                along = $1 * c + $3 * s; across = -$1 * s + $3 * c - axis
                if (along > 0.012 && along < 0.148) next
                u = bent ? -0.05 * along * across : 1e-3 * along; w = bent ? 0.05 * along ^ 2 / 2 : 0
                at = sprintf("displace %.9g,-1,%.9g,%.9g,1,%.9g", $1 - 1e-3, $3 - 1e-3, $1 + 1e-3, $3 + 1e-3)
                if (!(at in seen)) printf "0 %s 0,-,0\n0.02 %s %.12g,-,%.12g\n", at, at, u * c - w * s, u * s + w * c
                seen[at] = 1
            }' "$T/slab.parts" "$T/m" >"$T/script"
        tled-run -q -d cpu --rest 1e-6 --script "$T/script" --log "$T/log" <"$T/m" >"$T/out" 2>"$T/said"
        awk -v bent="$bent" "$slab_is"'
            { held = $6 }
            END { printf "%.4g ", held / (0.5 * (bent ? 0.05 : 1e-3) ^ 2 * 3000 * own[bent] * 0.16 * 0.01) }' "$T/slab.parts" "$T/log"
    done
}

# layer_volume NAME: of a layer of $T/m, in voxels.
layer_volume() {
    awk -v name="\"$1\"" '$1 == "array" { on = $2; k = 0; next }
        /^[a-z]/ { on = "" }
        on == "element.fraction" { f[k++] = $1; elements = k }
        on == "element.volume" { of[k++] = $1 }
        on == "element.mix" { mix[k++] = $1; mixed = 1 }
        on == "element.mixture" { share[k++] = $1 }
        on == "volume.name" { if ($0 == name) which = k; k++ }
        END {
            for (i = 0; i < elements; i++) sum += f[i] * ((of[i] == which) * (1 - share[i]) + (mixed && share[i] && mix[i] == which) * share[i])
            printf "%.6g\n", sum
        }' "$T/m"
}
