#!/bin/sh
# tests/same: the tools are the same as themselves; one byte that is not, in whatever a tool writes, is seen and named.
. "$(dirname "$0")/lib.sh"

# same WORD...: its exit status and its last line, with numbers as N; $T/said has all of it.
same() {
    tests/same "$SINEW_BIN" "$@" >"$T/said" 2>&1
    echo "$? $(tail -n 1 "$T/said" | sed 's/[0-9][0-9]*/N/g')"
}
# instead TOOL COMMAND: another set of tools, in which COMMAND stands for TOOL; $real is the real one.
instead() {
    rm -rf "$T/other"
    mkdir "$T/other"
    for file in "$SINEW_BIN"/*; do
        [ -d "$file" ] || ln -s "$file" "$T/other/${file##*/}"
    done
    rm "$T/other/$1"
    printf '#!/bin/sh\nreal=%s/%s\n%s\n' "$SINEW_BIN" "$1" "$2" >"$T/other/$1"
    chmod +x "$T/other/$1"
}

rows='muscle|said|goes.on'
# differs TEXT NAME: what is said before the last line.
differs() {
    is "$(same "$T/other" "$rows"): $(sed '$d' "$T/said")" "1 different: N of N: $1" "$2"
}
# shellcheck disable=SC2016 # the wrappers' own $
{
    instead tled-run 'exec "$real" "$@"'
    is "$(same "$T/other" "$rows")" "0 same: N outputs" "the same tools by another name"
    instead tled-run 'case $1 in -v) "$real" "$@" | tr "\346" "\347" ;; *) exec "$real" "$@" ;; esac'
    differs "Files rows/said/stdout and other/said/stdout differ" "bytes of a model, but nothing of a row that reads it"
    rows=tetrahedra
    instead msds-mesh 'echo "msds-mesh: quite so" >&2; exec "$real" "$@"'
    differs "Files rows/tetrahedra/stderr and other/tetrahedra/stderr differ" "a message more"
    instead msds-mesh '"$real" "$@"; exit 1'
    differs "Files rows/tetrahedra/status and other/tetrahedra/status differ" "another exit status"
    instead msds-mesh ': >left; exec "$real" "$@"'
    differs "Only in other/tetrahedra: left" "a file more"
}
is "$(SINEW_SHARED=$T/none same "$SINEW_BIN" 'face|fetal.head|tetrahedra'): $(sed '$d' "$T/said")" \
    "0 same: N outputs: left out: 2 rows, as there is no shared data" "without the shared data"
SINEW_KEEP=$T/kept same "$T/other" tetrahedra >"$T/line"
is "$(find "$T/kept/rows" "$T/kept/other" -type f | grep -c .)" 7 "outputs are kept, the file more among them"
fails 2 "no such row" "tests/same: no row is called 'gravty'" tests/same "$SINEW_BIN" "$SINEW_BIN" gravty
fails 2 "one folder" 'usage: tests/same BIN OTHER' tests/same "$SINEW_BIN"
fails 2 "a folder without tools" 'usage: tests/same BIN OTHER' tests/same "$SINEW_BIN" "$T"
fails 2 "make same without WITH" 'WITH=FOLDER' "${MAKE:-make}" -s -o all BIN="$SINEW_BIN" same
done_testing
