#!/bin/sh
# Poses that Debian's libopenigtlink sends, a program that shares no code with ours.
# shellcheck source=tests/link/peer.sh
. "$(dirname "$0")/peer.sh"

peer send
check "it packs a pose" "$T/send" pack transform
is "$(head -c 24 "$T/stdout" | tail -c 22 | tr '\0' . | head -c 22) $(wc -c <"$T/stdout")" "TRANSFORM...ProbeToRef 106" "of 58 and 48 bytes"
done_testing
