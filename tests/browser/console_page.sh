#!/bin/sh
# The page of sinew console, in a browser that selenium drives: see console_page.py. `make browser` runs this test.
# shellcheck source=tests/cli/lib.sh
. "$(dirname "$0")/../cli/lib.sh"

python=/usr/bin/python3 # Debian's, which has Debian's selenium
[ -x "$python" ] || skip_all "no $python"
have chromium || skip_all "no chromium"
have chromedriver || skip_all "no chromedriver"
HOME=$T PYTHONDONTWRITEBYTECODE=1 "$python" "$ROOT/tests/browser/console_page.py"
exit $?
