#!/bin/sh
# Poses that Debian's libopenigtlink sends, a program that shares no code with ours.
# shellcheck source=tests/link/peer.sh
. "$(dirname "$0")/peer.sh"

peer send

# hear NAME WORDS OPTIONS...: what the library sends as WORDS (send.cc has them) becomes $T/lines; $T/said and $T/sent have what the two say.
hear() {
    words=$1
    shift
    # shellcheck disable=SC2086 # words
    "$T/send" listen $words >"$T/sent" 2>"$T/failed" &
    sender=$!
    while ! grep -q port "$T/sent"; do sleep .02; done
    sinew igtl-in "$@" "127.0.0.1:$(sed -n 's/^port //p' "$T/sent")" >"$T/lines" 2>"$T/said" &
    listener=$!
    wait $sender
    is "$? $(cat "$T/failed")" "0 " "the library sends: $words"
    for _ in 1 2 3 4 5 6 7 8 9 10; do
        grep -q 'has ended' "$T/said" && break
        sleep .05
    done
    kill -TERM $listener
    wait $listener
    is $? 0 "and igtl-in takes them"
}

# The k-th message: k / 4 s, and at (10 k, 20, 30) mm a quarter of a turn about z. From RAS, half a turn about z is made: three quarters.
half=0.707106781
ras() {
    awk -v k="$1" -v first="$2" -v h=$half 'BEGIN { printf "%.6f %.9g -0.02 0.03 0 0 %.9g %.9g\n", (k - first) / 4, -k / 100, -h, h }'
}
lps() {
    awk -v k="$1" -v first="$2" -v h=$half 'BEGIN { printf "%.6f %.9g 0.02 0.03 0 0 %.9g %.9g\n", (k - first) / 4, k / 100, h, h }'
}

# same NAME: the lines are those of $T/wanted, to 1e-6; q and -q are one rotation.
same() {
    # shellcheck disable=SC2016 # awk's
    check "$1" awk 'function off(a, b) { return a - b > 1e-6 || b - a > 1e-6 }
        NR == FNR { wanted[++n] = $0; next }
        {
            split(wanted[++m], w)
            s = w[7] * $7 + w[8] * $8 < 0 ? -1 : 1
            for (i = 1; i <= 8; i++) if (off($i, i > 4 ? s * w[i] : w[i])) { print "line " m ": " $0 " is not " wanted[m]; bad = 1 }
        }
        END { exit bad || n != m || !n }' "$T/wanted" "$T/lines"
}

hear 'image transform status point transform string sensor position position3 transform' -v --transform ProbeToReference --timeout 0
for k in 1 4 9; do ras $k 1; done >"$T/wanted"
same "TRANSFORM, with other messages between"
check "STATUS is told" grep -q 'status 13 (device not ready), Warming: the cameras warm up' "$T/said"
check "STRING is, with -v" grep -q "'ProbeToReference' says: hello from the library" "$T/said"
is "$(grep -c 'skipped' "$T/said")" 0 "no checksum of the library's is wrong"

hear 'position position3 transform' --transform ProbeToReference --space lps
for k in 0 1; do lps $k 0; done >"$T/wanted"
same "POSITION, with four and three numbers of a quaternion"
hear 'place' --transform ProbeToReference --space lps
echo '0 0 .02 .03 0 0 0 1' >"$T/wanted"
same "and with none"

hear 'asked tools tools' --transform Probe --rate 50
for k in 0 1; do ras $k 0; done >"$T/wanted"
same "TDATA: a tool"
is "$(sed 1d "$T/sent")" "STT_TDATA 20 ''" "which the library has understood to be asked for, every 20 ms"
hear 'asked tools' --transform Stylus --space lps
lps 100 100 >"$T/wanted"
same "and another one"

hear 'transform lost lost transform' --transform ProbeToReference
for k in 0 3; do ras $k 0; done >"$T/wanted"
same "zeros are no pose"
is "$(grep -c 'its matrix is 0' "$T/said") $(grep -c 'tracked again' "$T/said")" "1 1" "told once"

# ---- The library connects.
sinew igtl-in --listen 0 --transform ProbeToReference >"$T/lines" 2>"$T/said" &
listener=$!
while ! grep -q listening "$T/said"; do sleep .02; done
port=$(sed -n 's/.*127\.0\.0\.1:\([0-9]*\)$/\1/p' "$T/said" | head -n 1)
"$T/send" 127.0.0.1 "$port" transform transform left >"$T/sent" 2>&1 &
sender=$!
for _ in 1 2 3 4 5 6 7 8 9 10; do
    [ "$(wc -l <"$T/lines")" -ge 2 ] && break
    sleep .05
done
kill -TERM $listener
wait $listener
is $? 0 "who connects is heard"
wait $sender
for k in 0 1; do ras $k 0; done >"$T/wanted"
same "from where it connects"
is "$(cat "$T/sent")" STT_TDATA "and is asked"
done_testing
