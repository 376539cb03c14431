#!/bin/sh
# msds-run --live --haptics: a simulated device that comes to rest against a run, through its socket; what lines have, also in a body; clients
# that come, go and do not read; and that frames are the same as without.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/lib.sh"
have python3 || skip_all "no python3"

msds-mesh -q --text --nodes 9x9x7 --size 8cm,8cm,6cm --young 20000 --poisson 0.45 --density 1000 >"$T/block.sinew"
mkfifo "$T/poses"

# start OPTIONS...: in the background, its frames in $T/live.
start() {
    rm -f "$T/record"
    msds-run --live --text -d cpu --rate 250 --record "$T/record" --poses "$T/poses" --haptics "$T/socket" --probe sphere:2cm "$@" \
        <"$T/block.sinew" >"$T/live" 2>"$T/said" &
    run=$!
    tries=0
    while [ ! -S "$T/socket" ] && [ "$tries" -lt 300 ] && kill -0 "$run" 2>/dev/null; do
        sleep 0.02
        tries=$((tries + 1))
    done
}

# end SIGNAL: its status.
end() {
    kill "-$1" "$run"
    wait "$run"
    status=$?
}

# device NAME OPTIONS...: against a run with these.
device() {
    name=$1
    shift
    # shellcheck disable=SC2086 # none, or one
    timeout 60 python3 tests/cli/haptic_device.py "$T/socket" "$T/poses" "$T/lines" $body >"$T/came" 2>"$T/error" || diag_file "$T/error"
    is "$(cat "$T/came")" "rest balance pressed" "$name: the device comes to rest where the hand's spring and the tissue balance"
}

# agree NAME X Y Z: what the words of a line are as that frame's force in the model's axes; of all lines.
agree() {
    sinew info --tsv probe.force "$T/live" >"$T/forces"
    if awk -v CONVFMT=%.9g 'function off(a, b) { return (a - b) ^ 2 > 1e-12 }
        NR == FNR { $2 += 0; x[$2] = $3; y[$2] = $4; z[$2] = $5; next }
        { wrong += !($2 in x) || off(x[$2], '"$2"') || off(y[$2], '"$3"') || off(z[$2], '"$4"') }
        END { exit FNR < 70 || wrong > 0 }' "$T/forces" "$T/lines"; then
        ok "$1: each line has its frame's force"
    else
        not_ok "$1: each line has its frame's force"
    fi
}

body=
start --method tissue
is "$(stat -c %a "$T/socket")" 600 "the socket is for its owner alone"
fails 1 "a socket that is in use" 'another program listens on this socket' msds-run -q --live --poses "$T/poses" --haptics "$T/socket" --probe sphere:2cm <"$T/block.sinew"
# That one has connected too, to see. One that never reads, while the device goes on.
python3 -c 'import select, socket, sys
s, until = socket.socket(socket.AF_UNIX), select.poll()
s.connect(sys.argv[1])
until.register(s, 0)
sys.exit(not until.poll(60000))' "$T/socket" &
idle=$!
device "tissue"
end INT
check "a client is hung up on at the end" wait "$idle"
is "$status $(tail -n 1 "$T/live")" "0 end" "it ends as any live run"
check "the socket is gone" test ! -e "$T/socket"
# shellcheck disable=SC2016 # awk's
agree "tissue" '$13' '$14' '$15'
check "what it sent is told: $(grep haptics: "$T/said")" grep -q 'haptics: 3 clients, [1-9][0-9]* frames sent, [1-9][0-9]* lost by clients that were slow' "$T/said"
sed -n '/^frame /,$p' "$T/live" >"$T/one"
check "the record is replayed" msds-run --text --replay "$T/record" -o "$T/again" <"$T/block.sinew"
sed -n '/^frame /,$p' "$T/again" >"$T/two"
check "to the same bytes, without the stiffness" cmp "$T/one" "$T/two"

# In a body that is turned by a quarter about x; and over a socket that a killed run has left.
python3 -c 'import socket, sys
s = socket.socket(socket.AF_UNIX)
s.bind(sys.argv[1])' "$T/socket"
echo 'volume turn=0.70710678118654752,0,0,0.70710678118654752' >"$T/body"
body=turned
start --method fem --body "$T/body"
device "fem in a body"
end TERM
# shellcheck disable=SC2016 # awk's
agree "fem in a body" '$13' '$15' '-$14'
check "the socket that was left is gone" test ! -e "$T/socket"

no() {
    name=$1 pattern=$2
    shift 2
    fails 2 "$name" "$pattern" msds-run "$@" <"$T/block.sinew"
}
no "not live" 'haptics are for --live' --haptics "$T/socket" --poses "$T/poses" --probe sphere:2cm
no "without a probe" 'haptics without --probe and --poses' --live --haptics "$T/socket" --poses "$T/poses"
no "without poses" 'haptics without --probe and --poses' --live --haptics "$T/socket" --control "$T/poses" --probe sphere:2cm
no "a replay" 'replay with --live, --poses' --replay "$T/record" --haptics "$T/socket"
fails 1 "a file that is there" 'is no socket; expected a name that is free' msds-run -q --live --poses "$T/poses" --haptics "$T/record" --probe sphere:2cm <"$T/block.sinew"
check "it stays" test -s "$T/record"
fails 1 "no folder" 'none/socket: cannot make the socket' msds-run -q --live --poses "$T/poses" --haptics "$T/none/socket" --probe sphere:2cm <"$T/block.sinew"

done_testing
