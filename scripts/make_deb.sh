#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the packages of packaging/debian from a copy of the sources, with or without git.
#
#   scripts/make_deb.sh [FOLDER]    writes the .deb files, .changes and .buildinfo (build/deb)
#
# DEBFULLNAME and DEBEMAIL name the maintainer. SOURCE_DATE_EPOCH dates the change log; else the last
# commit or CMakeLists.txt does. The viewer, the MPI program or the page of alpenglow web are left out
# where what they need is missing; a line names each.
# Exit status: 0 the packages are there, 1 something is missing or a build failed.
set -euo pipefail
cd "$(dirname "$0")/.."
output=${1:-build/deb}

say() {
    printf 'deb: %s\n' "$*" >&2
}

left_out() { # what, reason
    say "left out: $1: $2 ('scripts/setup.sh deb' installs it)"
}

missing=""
for need in dh:debhelper dpkg-buildpackage:dpkg-dev cmake:cmake ninja:ninja-build \
    pkg-config:pkg-config; do
    command -v "${need%%:*}" >/dev/null 2>&1 || missing="$missing ${need#*:}"
done
if [ -n "$missing" ]; then
    say "these Debian 12 packages are missing:$missing; run 'scripts/setup.sh deb'"
    exit 1
fi

version=$(sed -n 's/^project(alpenglow VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
[ -n "$version" ] || { say "CMakeLists.txt: no line project(alpenglow VERSION ...)"; exit 1; }
soversion=${version%.*} # as src/CMakeLists.txt sets it
maintainer="${DEBFULLNAME:-Alpenglow contributors} <${DEBEMAIL:-alpenglow@packages.invalid}>"
seconds=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || stat -c %Y CMakeLists.txt)}

profiles=${DEB_BUILD_PROFILES:-}
pkg-config --exists epoxy egl || {
    profiles="$profiles pkg.alpenglow.noviewer"
    left_out alpenglow-viewer "there is no libepoxy-dev or no libegl-dev"
}
[ "$(dpkg-query -W -f '${db:Status-Status}' libopenmpi-dev 2>/dev/null)" = installed ] || {
    profiles="$profiles pkg.alpenglow.nompi"
    left_out alpenglow-mpi "there is no libopenmpi-dev"
}
[ -e web/viewer/node_modules/three/build/three.core.js ] ||
    left_out "the page of alpenglow web" "there is no three.js in web/viewer"

mkdir -p "$output"
output=$(cd "$output" && pwd)
work=$(mktemp -d "$output/work.XXXXXX") # on the same disk, so that the packages are renamed
trap 'rm -rf "$work"' EXIT
tree=$work/alpenglow-$version
mkdir -p "$tree"
list_sources() { # files of the sources, each with a zero byte behind it
    if [ -e .git ] && command -v git >/dev/null 2>&1; then
        git ls-files -z
    else
        find . \( -name .git -o -path ./build -o -path ./demo -o -name node_modules -o \
            -name __pycache__ \) -prune -o -type f -print0
    fi
    [ ! -d web/viewer/node_modules ] || find web/viewer/node_modules -type f -print0
}
list_sources | tar -c --null --no-recursion -T - | tar -x -C "$tree"

cp -r packaging/debian "$tree/debian"
mv "$tree/debian/libalpenglow.install" "$tree/debian/libalpenglow$soversion.install"
control=$(<packaging/debian/control)
control=${control//@SOVERSION@/"$soversion"}
printf '%s\n' "${control//@MAINTAINER@/"$maintainer"}" >"$tree/debian/control"
cat >"$tree/debian/changelog" <<CHANGELOG
alpenglow ($version) unstable; urgency=medium

  * Version $version, whose content is listed in CHANGELOG.md of the sources.

 -- $maintainer  $(LC_ALL=C date -u -R -d "@$seconds")
CHANGELOG

log=$output/build.log
say "building in $tree"
(cd "$tree" &&
    env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL -u SOURCE_DATE_EPOCH \
        DEB_BUILD_PROFILES="${profiles# }" DEB_BUILD_OPTIONS="${DEB_BUILD_OPTIONS:-noautodbgsym}" \
        dpkg-buildpackage -b -us -uc) >"$log" 2>&1 || {
    tail -n 30 "$log" >&2
    say "dpkg-buildpackage failed; $log has all of its output"
    exit 1
}
for name in alpenglow libalpenglow; do # a former build may have had more packages
    rm -f "$output/$name"[_0-9-]*.{deb,changes,buildinfo}
done
mv "$work"/*.deb "$work"/*.changes "$work"/*.buildinfo "$output"
rm -f "$log"
ls -1 "$output"/*.deb
