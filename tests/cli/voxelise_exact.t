#!/bin/sh
# voxelise against whole numbers of any size, on meshes that all but touch voxel centres: see voxelise_exact.py.
. "$(dirname "$0")/lib.sh"

python3 -c 'import math; math.nextafter' 2>/dev/null || skip_all "no python3 with math.nextafter"
python3 tests/cli/voxelise_exact.py "$T" "$([ -n "$SINEW_LONG" ] && echo 400 || echo 6)" 1
echo 1..5
