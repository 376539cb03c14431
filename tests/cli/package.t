#!/bin/sh
# What names the version agrees: the tools, debian/changelog, CHANGELOG.md. And the Debian package, which holds what `make install` installs,
# lacks no tool and no page. (make deb and make deb-check build and try the package itself.)
. "$(dirname "$0")/lib.sh"

have make || skip_all "no make"

# ---- the version
version=$(sed -n 's/^#define SINEW_VERSION "\(.*\)"/\1/p' common/cli/tool.h)
check "there is a version: $version" expr "$version" : '[0-9]*\.[0-9]*\.[0-9]*$'
is "$(sinew --version)" "sinew (Sinew) $version" "sinew --version"
is "$(tled-run --version)" "tled-run (Sinew) $version" "tled-run --version"
is "$(sed -n '1s/^sinew (\(.*\)) .*/\1/p' debian/changelog)" "$version" "debian/changelog begins with it"
newest=$(sed -n '/^## \[[0-9]/{p;q;}' CHANGELOG.md) # but for what is not released yet
is "${newest% - *}" "## [$version]" "CHANGELOG.md has it as its newest"
is "$(date -u -d "$(sed -n '/^ -- /{s/.*>  //p;q;}' debian/changelog)" +%Y-%m-%d)" "${newest#* - }" "and both have its date"
is "$(grep -rnE '\b0\.[0-9]+\.[0-9]+\b' Makefile debian/rules debian/control debian/package.mk debian/copyright)" "" "no other file of the package has one"

# ---- what is in it
root=$T/root
zsh=$(sed -n 's/^SETTINGS = .* ZSH_COMPLETIONS=\([^ ]*\) .*/\1/p' debian/rules)
check "make install" env -u MAKEFLAGS -u MAKELEVEL make -s BIN="$SINEW_BIN" DESTDIR="$root" PREFIX=/usr ZSH_COMPLETIONS="$zsh" install
if have zsh && [ -e /etc/debian_version ]; then
    check "$zsh is where Debian's zsh looks for completions of packages" sh -c "zsh -f -c 'print -l \$fpath' | grep -qx '$zsh'"
else
    skip 1 "no zsh of Debian's"
fi
check "and they are there" test -s "$root$zsh/_tled-run"
check "the package is what make install installs" grep -q "dh_auto_install -- " debian/rules
check "under /usr" grep -q "^SETTINGS = .*PREFIX=/usr " debian/rules
is "$(find debian -name '*.install' -o -name '*.manpages')" "" "no list beside that has to be kept"
mains=$(grep -l '^int main(' attach/*.c bind/*.c common/*/*.c msds/*/*.c slice/*/*.c tled/*/*.c voxelise/*.c | sed 's|.*/||; s|\.c$||' | sort)
check "there are tools" test "$(echo "$mains" | wc -l)" -ge 17
for tool in $mains; do
    check "$tool is installed" test -x "$root/usr/bin/$tool"
    check "$tool has a page" test -s "$root/usr/share/man/man1/$tool.1"
    case $tool in
    sinew-*) word=${tool#sinew-} ;;
    *) word=$tool ;;
    esac
    check "the package's description names $word" grep -qw -e "$word" debian/control
done
for page in man/*.[1-9]; do
    check "$page is installed" test -s "$root/usr/share/man/man${page##*.}/${page#man/}"
done

# ---- what debian/ names is there
while read -r file; do
    check "$file, of debian/sinew.docs" test -s "$file"
done <debian/sinew.docs
while read -r target link; do
    check "$link leads to something" test -e "$root/$target"
done <debian/sinew.links
is "$(sed -n '/^ Redistribution/,$p' debian/copyright | sed 's/^ //; s/^\.$//')" "$(sed -n '/^Redistribution/,$p' LICENSE)" "debian/copyright has the text of LICENSE"
# What .ci/setup installs for a build; libccd, clang and libopenigtlink are for tests, and Debian has libc6-dev wherever packages are built.
sed -n 's/^ *want \(lib[^ ]*-dev\|zlib[^ ]*-dev\) .*/\1/p' .ci/setup | grep -v '^libccd-dev$\|^libc6-dev$\|^libclang\|^libopenigtlink' >"$T/wanted"
while read -r package; do
    check "the package is built with $package" grep -qw -e "$package" debian/control
done <"$T/wanted"
done_testing
