#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the Debian packages, reads them with lintian, and installs them in a new root of Debian.
#
#   run.sh COMMAND WORK    COMMAND is the built alpenglow, whose bits the package must write; WORK is a
#                          folder to write in
#
# Exit status: 0 all is right, 77 skipped, 1 a fault.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
sources=$here/../../..
command=$1 work=$2
suite=bookworm # of the packages that the dependencies name

skip() {
    echo "skipped: $*"
    exit 77
}

fail() {
    printf 'deb: %s\n' "$*" >&2
    exit 1
}

for need in apt-get dh lintian mmdebstrap dpkg-scanpackages; do
    builtin command -v "$need" >/dev/null 2>&1 || skip "there is no $need ('scripts/setup.sh deb')"
done
[ "$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)" = $suite ] || skip "this is not Debian $suite"
# The mirror that this machine installs from.
# shellcheck disable=SC2016 # apt-get expands the names
mirror=$(apt-get indextargets --format '$(RELEASE) $(REPO_URI)' 'Created-By: Packages' |
    sed -n "s/^$suite //p" | head -n 1)
[ -n "$mirror" ] || skip "apt knows no mirror of Debian $suite"
mode=unshare # not the modes that imitate chroot
[ "$(id -u)" != 0 ] || mode=root
mmdebstrap --quiet --mode=$mode --simulate --variant=essential $suite /dev/null "$mirror" >/dev/null 2>&1 ||
    skip "mmdebstrap finds no network, or may make no root"

rm -rf "$work"
mkdir -p "$work"
work=$(cd "$work" && pwd)
"$sources/scripts/make_deb.sh" "$work/packages"

# --- lintian and the list of packages --------------------------------------------------------------
as_root=""
[ "$(id -u)" != 0 ] || as_root=--allow-root
lintian $as_root --fail-on error "$work/packages"/*.changes || fail "lintian finds errors"
for name in alpenglow 'libalpenglow[0-9]*' libalpenglow-dev alpenglow-viewer alpenglow-mpi; do
    compgen -G "$work/packages/${name}_*.deb" >/dev/null 2>&1 ||
        case $name in
        alpenglow-viewer) echo "without alpenglow-viewer" ;;
        alpenglow-mpi) echo "without alpenglow-mpi" ;;
        *) fail "the package $name is missing" ;;
        esac
done

# --- the installation ------------------------------------------------------------------------------
# Below /tmp, because an unprivileged mmdebstrap may not enter home folders.
share=$(mktemp -d)
trap 'rm -rf "$share"' EXIT
chmod 755 "$share"
mkdir "$share/repository"
cp "$work/packages"/*.deb "$share/repository"
(cd "$share/repository" && dpkg-scanpackages --multiversion . >Packages 2>/dev/null)
cp "$here/inside.sh" "$sources/tests/consumer/project/consumer.c" \
    "$sources/tests/consumer/project/CMakeLists.txt" "$share"
"$command" bake builtin:cornell -o "$share/expected.glb" --size 64 --maps ao,light -q
chmod -R a+rX "$share"
mmdebstrap --quiet --mode=$mode --variant=apt \
    --customize-hook="'$here/hook.sh' \"\$1\" '$share'" $suite /dev/null "$mirror" ||
    fail "the packages do not work in a root of Debian $suite (see above)"
