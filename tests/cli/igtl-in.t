#!/bin/sh
# sinew igtl-in: poses by OpenIGTLink, from programs that are written for this test (igtl_in.py); with Debian's library: tests/link/in.t.
. "$(dirname "$0")/lib.sh"

fails 2 "nothing to connect to" "neither HOST nor --listen; expected one of these" sinew igtl-in
fails 2 "both" "HOST and --listen; expected one of these" sinew igtl-in --listen 0 localhost
fails 2 "a port that is none" "HOST:PORT 'localhost:0': expected HOST:PORT" sinew igtl-in localhost:0
fails 2 "an address that is none" "--listen 'here:1': expected \[ADDRESS:\]PORT" sinew igtl-in --listen here:1
fails 2 "a space that is none" "lps" sinew igtl-in --space las localhost
fails 1 "a host that is unknown" "a\.\.b:18944: no address is known: Name or service not known" sinew igtl-in a..b
fails 1 "an address of another machine" "192\.0\.2\.1:0: cannot listen: Cannot assign requested address" sinew igtl-in --listen 192.0.2.1:0

have python3 || {
    skip 1 "no python3"
    done_testing
}
timeout 120 /usr/bin/python3 tests/cli/igtl_in.py >"$T/cases"
while read -r line; do
    case $line in
    'ok '*) ok "${line#ok }" ;;
    'not ok '*) not_ok "${line#not ok }" ;;
    *) printf '%s\n' "$line" ;;
    esac
done <"$T/cases"
is "$(grep -c 'came to its end$' "$T/cases")" "$(grep -c '^@case' tests/cli/igtl_in.py)" "all cases were made"
done_testing
