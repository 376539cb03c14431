#!/bin/sh
# sinew console with its tools, and its page in a browser that selenium drives: see console_live.py. `make browser` runs this test.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/../cli/lib.sh"

python=/usr/bin/python3 # Debian's, which has Debian's selenium
[ -x "$python" ] || skip_all "no $python"
"$python" -c 'import selenium' 2>/dev/null || skip_all "no selenium"
have chromium || skip_all "no chromium"
have chromedriver || skip_all "no chromedriver"
[ -e /usr/share/javascript/three/build/three.module.js ] || skip_all "no three.js"
(
    cd samples || exit 1
    make -s OUT="$T" NODES=10x8x8 "$T/case/mesh.sinew" || exit 1
    awk -f shape.awk -f muscle.awk >"$T/muscle.obj"
    voxelise -q --unit mm -s 4 --volumes muscle.volumes --materials muscle.materials "$T/muscle.obj" |
        attach -q --fibre axis | sinew bind >"$T/face.sinew"
) >"$T/made" 2>&1 || diag_file "$T/made"
mkdir "$T/records" "$T/jaw"
sh tests/cli/jaw_case.sh "$T/jaw" >"$T/made" 2>&1 || diag_file "$T/made"
HOME=$T PYTHONDONTWRITEBYTECODE=1 "$python" "$ROOT/tests/browser/console_live.py" "$T/case" "$T/face.sinew" "$T/jaw" "$T/records"
exit $?
