#!/bin/sh
# voxelise: wrong command lines, wrong input, what is refused for its size, and how a pipe ends then.
. "$(dirname "$0")/lib.sh"
. tests/cli/boxes.sh

box skin -3 -3 -3 3 3 3 >"$T/cube.obj"
cube=$T/cube.obj

# wrong NAME PATTERN ARGS...: a usage error.
wrong() {
    name=$1 pattern=$2
    shift 2
    fails 2 "$name" "^voxelise: $pattern" voxelise -o "$T/out" "$@" "$cube"
}
wrong "no unit: the extents in mm and in m" "$cube: an OBJ does not say its unit: with --unit mm it is 0.006 x 0.006 x 0.006 m, with --unit m 6 x 6 x 6 m" -s 1
wrong "unknown unit" "--unit 'furlong': expected mm, cm" --unit furlong -s 1
wrong "no size" "no voxel size; expected -s H" --unit mm
wrong "two sizes" "-s and -n both" --unit mm -s 1 -n 3
wrong "two lengths" "-s: expected one length, or three" --unit mm -s 1,2
wrong "no length" "-s 'x': expected" --unit mm -s x
wrong "a size of 0" "-s: expected one length, or three between commas, above 0" --unit mm -s 0
wrong "a size below 0" "-s: expected one length, or three between commas, above 0" --unit mm -s 1,-1,1
wrong "no cells" "-n '0': expected a whole number from 1" --unit mm -n 0
wrong "half an origin" "--origin '1,2': expected X,Y,Z" --unit mm -s 1 --origin 1,2
wrong "half a box" "--box '1,2,3': expected X0,Y0,Z0,X1,Y1,Z1" --unit mm -s 1 --box 1,2,3
wrong "a box upside down" "--box: expected .* with X0 < X1" --unit mm -s 1 --box 0,0,0,1mm,1mm,-1m
wrong "no such option" "no option --volmues; did you mean --volumes" --unit mm -s 1 --volmues x
wrong "one surface too many" "extra operand" --unit mm -s 1 "$cube"
fails 1 "nothing to ask the unit of" "^voxelise: stdin: no polygons; expected closed surfaces" voxelise -s 1 -o "$T/out" -
fails 2 "a name without text" "^voxelise: operand '' is empty; expected surface.obj" voxelise -s 1 -o "$T/out" ''
fails 2 "no surface" "^voxelise: missing operand; expected surface.obj" voxelise --unit mm -s 1 -o "$T/out"

# bad NAME PATTERN ARGS...: refused.
bad() {
    name=$1 pattern=$2
    shift 2
    fails 1 "$name" "^voxelise: $pattern" voxelise -o "$T/out" --unit mm "$@"
}
bad "no such file" "$T/none.obj: .*No such file" -s 1 "$T/none.obj"
bad "nothing on stdin" "stdin: no polygons" -s 1 -
printf 'v 0 0 0\nv 1 0\nf 1 2 3\n' >"$T/bad.obj"
bad "an OBJ that is wrong says where" "$T/bad.obj:2: " -s 1 "$T/bad.obj"
sed 's/^v 3 3 3/v 1e99 3 3/' "$cube" >"$T/large.obj"
bad "a coordinate past all reason" "$T/large.obj: vertex 8 has a coordinate of 1e\+99" -s 1 "$T/large.obj"
awk '/^v/ { print "v 1 2 3"; next } { print }' "$cube" >"$T/point.obj"
bad "a surface that is a point, -n" "$T/point.obj: all vertices are at one place" -n 4 "$T/point.obj"
bad "a surface that is a point, -s" "$T/point.obj: no voxel has its centre inside" -s 1 "$T/point.obj"
bad "a grid too large for memory" "a lattice of 60000 x 60000 x 60000 cells .* needs .* GB of memory, and .* GB are free" -s 1e-4 "$cube"
bad "the same, along one axis" "a lattice of 60000000 x .* GB are free" -s 1e-7,1e-2,1e-2 "$cube"
bad "more cells than can be numbered" "the lattice would reach index 6e\+10 along x; .* larger voxels" -s 1e-10 "$cube"
bad "an origin too far" "the lattice would reach index -?1e\+12 along y" -s 1 --origin 0,1e12,0 "$cube"
bad "a size past all reason" "a voxel of 1e-200 along x" -s 1e-200 "$cube"
bad "an origin past all reason" "an origin of 1e\+100 along z" -s 1 --origin 0,0,1e100 "$cube"
fails 1 "bad SINEW_THREADS" "SINEW_THREADS" env SINEW_THREADS=x voxelise -o "$T/out" --unit mm -s 1 "$cube"
is "$([ -e "$T/out" ] && echo left)" "" "none of them left an output"
check "a small part of what would be too large" voxelise -q -o "$T/out" --unit mm -s 1e-4 --box 0,0,0,1e-3,1e-3,1e-3 "$cube"
is "$(sinew info --get axis.element <"$T/out")" 1000 "its elements"

# A pipe: one message, and the status of the first.
voxelise --unit mm -s 1 "$T/none.obj" 2>"$T/stderr" | sinew info >/dev/null 2>>"$T/stderr"
is "$? $(wc -l <"$T/stderr")" "1 1" "the tool behind it fails with the same status and says nothing"
voxelise -s 1 "$cube" 2>"$T/stderr" | sinew info >/dev/null 2>>"$T/stderr"
is "$? $(wc -l <"$T/stderr")" "2 1" "a usage error too"
if [ -w /dev/full ]; then
    # shellcheck disable=SC2016
    fails 1 "a full disk" "No space" sh -c 'voxelise -q --unit mm -n 30 "$1" >/dev/full' sh "$cube"
else
    skip 1 "no /dev/full"
fi
done_testing
