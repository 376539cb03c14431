#!/bin/sh
# The format frozen at 1: the models of tests/golden/v1, in both encodings, gzipped and not, are read, come out as the same bytes from
# every way round, and `sinew info --json` says of them what it said. The summary for people, which is
# not frozen, is that of tests/golden/summary. Flips and cuts of the models are tests/unit/test_golden.c's.
. "$(dirname "$0")/lib.sh"

golden=tests/golden/v1
summary=tests/golden/summary

# status NAME: what a tool that reads it exits with.
status() {
    case $1 in
    failed) echo 3 ;;
    *) echo 0 ;;
    esac
}

# same GOT WANT: the same bytes; where not, which file is not.
same() {
    cmp "$1" "$2" >>"$T/cmp" 2>&1 || echo "$2"
}

# round NAME FILE: FILE as binary and as text, against the two that are kept.
round() {
    sinew export -f model <"$2" >"$T/binary" 2>>"$T/said"
    [ $? -eq "$(status "$1")" ] || echo "status"
    sinew export -f model --text <"$2" >"$T/text" 2>>"$T/said"
    [ $? -eq "$(status "$1")" ] || echo "status"
    same "$T/binary" "$golden/$1.binary"
    same "$T/text" "$golden/$1.text"
}

# packed NAME: what -z writes of it holds the same.
packed() {
    sinew export -f model -z <"$golden/$1.text" 2>>"$T/said" | gzip -dc >"$T/binary"
    same "$T/binary" "$golden/$1.binary"
    sinew export -f model -z --text <"$golden/$1.binary" 2>>"$T/said" | gzip -dc >"$T/text"
    same "$T/text" "$golden/$1.text"
}

# info NAME FILE WANT ARGUMENTS...
info() {
    name=$1 file=$2 want=$3
    shift 3
    sinew info "$@" <"$file" >"$T/info" 2>>"$T/said"
    [ $? -eq "$(status "$name")" ] || echo "status"
    same "$T/info" "$want"
}

: >"$T/said"
for name in empty failed hex tet types; do
    for encoding in text binary; do
        file=$golden/$name.$encoding
        is "$(round "$name" "$file")" "" "$name.$encoding: read, and written to the same bytes"
        is "$(round "$name" "$file.gz")" "" "$name.$encoding.gz too"
        is "$(info "$name" "$file" "$summary/$name.$encoding.info")$(info "$name" "$file.gz" "$summary/$name.$encoding.info")" "" \
            "$name.$encoding: the summary, gzipped or not"
        is "$(info "$name" "$file" "$golden/$name.json.$encoding" --json)" "" "$name.$encoding: sinew info --json says what it said"
    done
    is "$(packed "$name")" "" "$name: gzipped by -z, and back"
done
is "$(cat "$T/said")" "" "and no tool says anything on standard error"

# What later minor versions will be like.
sed '1s/1 text/1.7 text/' "$golden/types.text" | sinew export -f model --text >"$T/text"
check "text of a later minor version" cmp "$T/text" "$golden/types.text"

for name in hex tet types; do
    check "$name: the two encodings do not differ" sinew diff "$golden/$name.text" "$golden/$name.binary"
done

done_testing
