# shellcheck shell=sh
# For the tests in this folder, which talk with programs on Debian's libopenigtlink: `. "$(dirname "$0")/peer.sh"` is their first line.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/../cli/lib.sh"

[ -e /usr/include/openigtlink/igtlTransformMessage.h ] || skip_all "no libopenigtlink-dev"
have c++ || skip_all "no c++"

# peer NAME: builds NAME.cc of this folder, with the library, as $T/NAME. (Its headers are not ours to mend.)
peer() {
    check "$1.cc is built with Debian's libopenigtlink" c++ -std=c++17 -O1 -Wall -Wextra -Werror -isystem /usr/include/openigtlink \
        -o "$T/$1" "tests/link/$1.cc" -lOpenIGTLink -lpthread
}
