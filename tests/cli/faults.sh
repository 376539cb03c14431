# shellcheck shell=sh
# Small commands of every tool, for the tests of what fails: `make_inputs` once, then `each_command FUNCTION` calls
#     FUNCTION NAME INPUT COMMAND...
# for each, INPUT what it reads on standard input. All write to standard output, and take -o FILE. One of every tool, and of
# tled-run's output as it is and gzipped; with SINEW_LONG more of most.

# box NAMES X0 Y0 Z0 X1 Y1 Z1, as OBJ.
. "$ROOT/tests/cli/boxes.sh"

# make_inputs: into $T/in.
make_inputs() {
    mkdir "$T/in"
    {
        box skin 0 0 0 24 16 12
        box skull_jaw 0 0 0 4 16 12
        box muscle_a 2 4 4 20 12 8
    } >"$T/in/head.obj"
    box skin 2 2 2 22 14 11 >"$T/in/skin.obj"
    gzip -c "$T/in/skin.obj" >"$T/in/skin.obj.gz"
    printf 'skin level=0 priority=0 material=tissue surfaces=skin,skull*\nmuscle_a level=1 priority=0 material=flesh surfaces=muscle_a\n' >"$T/in/volumes"
    printf 'tissue E=3000 nu=0.45\nflesh E=6000 nu=0.45 peak=20000\n' >"$T/in/materials"
    printf '0 contract a 0\n0.02 contract a 0.5\n0 gravity 0,0,-9.81\n0 force 0.02,0.008,0.006 0.006 0,0.001,0\n0 displace skull_jaw 0,0,0\n0.03 displace skull_jaw 0,0,-1mm\n' >"$T/in/script"
    printf '0 0.016 0.008 0.013 1 0 0 0\n0.02 0.016 0.008 0.011 1 0 0 0\n0.04 0.016 0.008 0.01 1 0 0 0\n' >"$T/in/poses"
    voxelise -q --unit mm -s 4 --volumes "$T/in/volumes" --materials "$T/in/materials" -o "$T/in/voxels.sinew" "$T/in/head.obj" &&
        attach -q -o "$T/in/attached.sinew" <"$T/in/voxels.sinew" &&
        sinew bind "$T/in/skin.obj" -o "$T/in/bound.sinew" <"$T/in/attached.sinew" &&
        tled-run -q -d cpu -c a=0.5 -t 0.02 --every 0.01 -o "$T/in/frames.sinew" <"$T/in/bound.sinew" &&
        tled-run -q -d cpu -c a=0.5 -t 0.02 --every 0.01 --text -z -o "$T/in/frames.text.gz" <"$T/in/bound.sinew" || return
    {
        printf '%s\n' NRRD0004 'type: uint8' 'dimension: 3' 'space: left-posterior-superior' 'sizes: 12 10 8' \
            'space directions: (2,0,0) (0,2,0) (0,0,2)' 'kinds: domain domain domain' 'encoding: text' 'space origin: (0,0,0)' ''
        awk 'BEGIN { for (k = 0; k < 8; k++) for (j = 0; j < 10; j++) for (i = 0; i < 12; i++) print (i > 3 && i < 8 && j > 2 && j < 7 && k > 1 && k < 6) ? 200 : (i * 37 + j * 91 + k * 53) % 100 }'
    } >"$T/in/volume.nrrd"
    us-segment -q -n bone --low 150 -o "$T/in/labels.nrrd" "$T/in/volume.nrrd" &&
        us-surface -q -l all -o "$T/in/bone.obj" "$T/in/labels.nrrd" &&
        msds-mesh -q --nodes 6x5x4 --like "$T/in/volume.nrrd" -o "$T/in/mesh.sinew" || return
    printf '0 .01 .008 -.006 0 0 0 1\n0.02 .01 .008 -.004 0 0 0 1\n' >"$T/in/press"
    msds-run -q -d cpu --probe sphere:5mm --poses "$T/in/press" -o "$T/in/pressed.sinew" <"$T/in/mesh.sinew" &&
        sinew export -f inp -o "$T/in/mesh.inp" "$T/in/attached.sinew" || return
    mkdir "$T/in/patient" && LC_ALL=C awk -v folder="$T/in/patient" -f samples/patient.awk
}

each_command() {
    tap_each=$1
    tap_more=$1
    [ "$SINEW_LONG" ] || tap_more=:
    "$tap_each" "voxelise" /dev/null voxelise --unit mm -s 4 --volumes "$T/in/volumes" --materials "$T/in/materials" "$T/in/head.obj"
    "$tap_more" "voxelise of gzipped, shares" /dev/null voxelise --unit mm -s 5 --fraction 3 "$T/in/skin.obj.gz"
    "$tap_more" "voxelise --check" /dev/null voxelise --unit mm -s 4 --check "$T/in/head.obj"
    "$tap_more" "attach" "$T/in/voxels.sinew" attach
    "$tap_each" "attach --fibre field, text" "$T/in/voxels.sinew" attach --fibre field --report --text
    "$tap_each" "bind" "$T/in/attached.sinew" sinew bind "$T/in/skin.obj"
    "$tap_each" "deform" "$T/in/frames.sinew" sinew deform "$T/in/skin.obj"
    "$tap_each" "tled-run" "$T/in/bound.sinew" tled-run -d cpu --threads 2 -c a=0.5 -t 0.02 --every 0.005
    "$tap_each" "tled-run, a script, gzip" "$T/in/bound.sinew" tled-run -d cpu --threads 2 --script "$T/in/script" -t 0.02 -z
    "$tap_more" "tled-run, a probe, single" "$T/in/attached.sinew" tled-run -d cpu --threads 2 --precision single --probe sphere:3mm --poses "$T/in/poses" -t 0.02 --text
    "$tap_more" "tled-run going on" "$T/in/frames.text.gz" tled-run -d cpu --threads 2 -c a=0.5 -t 0.01
    "$tap_each" "msds-mesh" /dev/null msds-mesh --nodes 6x5x4 --like "$T/in/volume.nrrd"
    "$tap_more" "msds-run" "$T/in/mesh.sinew" msds-run -d cpu --threads 2 --probe sphere:5mm --poses "$T/in/press"
    "$tap_each" "msds-run, FEM" "$T/in/mesh.sinew" msds-run -d cpu --threads 2 --method fem --probe curved:3cm,60,5mm --poses "$T/in/press"
    "$tap_more" "msds-run, FEM exactly, a skin" "$T/in/mesh.sinew" msds-run -d cpu --threads 2 --method fem --exact --skin "$T/in/bone.obj" --unit mm --probe "convex:$T/in/skin.obj" --poses "$T/in/press"
    "$tap_each" "us-segment" /dev/null us-segment -n bone --low 150 --largest --smooth 1mm "$T/in/volume.nrrd"
    "$tap_each" "us-surface" /dev/null us-surface -l all --smooth 1mm --taubin 3 "$T/in/labels.nrrd"
    "$tap_more" "us-slice" /dev/null us-slice --rigid --size 24x24 --poses "$T/in/press" "$T/in/volume.nrrd"
    "$tap_each" "us-slice through a mesh" "$T/in/pressed.sinew" us-slice --size 24x24 --depth 2cm "$T/in/volume.nrrd"
    "$tap_each" "info" "$T/in/frames.sinew" sinew info
    "$tap_more" "info --json" "$T/in/frames.text.gz" sinew info --json
    "$tap_more" "info --get" "$T/in/frames.sinew" sinew info --get node.displacement.max
    "$tap_each" "diff" /dev/null sinew diff "$T/in/frames.sinew" "$T/in/frames.text.gz"
    "$tap_each" "distance" /dev/null sinew distance --unit mm --both --threads 2 --region "all=$T/in/head.obj" "$T/in/skin.obj" "$T/in/skin.obj.gz"
    "$tap_each" "export -f vtu" "$T/in/frames.sinew" sinew export -f vtu
    "$tap_more" "export -f inp" "$T/in/frames.sinew" sinew export -f inp
    "$tap_more" "export -f obj" "$T/in/frames.sinew" sinew export -f obj
    "$tap_each" "import" /dev/null sinew import --unit m "$T/in/mesh.inp"
    "$tap_each" "render" "$T/in/frames.sinew" sinew render --size 64x48
    "$tap_each" "us-import" /dev/null us-import "$T/in/patient"
}
