#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what the project needs on Debian 12. Looks first, and does nothing when all is there.
#
#   scripts/setup.sh build    what the library, the command and the viewer need
#   scripts/setup.sh check    that, and what tests, lint and CI need (default)
#   scripts/setup.sh browser  that, a browser (some 500 MB), which opens what is written for it, and
#                             what the Python module needs
#   scripts/setup.sh blender  what check needs, and Blender with a virtual screen (some 640 MB), which
#                             tests the add-on
#   scripts/setup.sh cluster  what check needs, MPI, and Slurm for tests (some 140 MB)
#   scripts/setup.sh deb      what build needs, MPI, and what builds and tests Debian packages
#
# Packages come from Debian (apt-get, through sudo where not root). From npm come three.js for the page
# of alpenglow web, wherever npm is there, the file validator of the tests, and what runs in a browser,
# where there is one; without them there is no page, and some tests are skipped.
# Exit status: 0 all is there, 1 something is missing, 2 wrong usage.
set -euo pipefail
cd "$(dirname "$0")/.."

# A package, and the command that proves it is there ("-": ask dpkg). A tool counts however it came.
build_packages="
    gcc                 gcc
    g++                 g++
    libc6-dev           -
    make                make
    cmake               cmake
    ninja-build         ninja
    pkg-config          pkg-config
    libembree-dev       -
    libjansson-dev      -
    libpng-dev          -
    libjpeg62-turbo-dev -
    libopenexr-dev      -
    libxml2-dev         -
    libzstd-dev         -
    libmeshoptimizer-dev -
    libdraco-dev        -
    libwebp-dev         -
    zlib1g-dev          -
    libepoxy-dev        -
    libegl-dev          -
    libegl-mesa0        -
    libopengl0          -
    libgl1-mesa-dri     -"
check_packages="
    python3             -
    libcmocka-dev       -
    libgles-dev         -
    clang               clang
    libclang-rt-14-dev  -
    clang-format        clang-format
    clang-tidy          clang-tidy
    lld                 ld.lld
    cppcheck            cppcheck
    ca-certificates     -
    nodejs              node
    npm                 npm
    groff-base          groff
    mandoc              mandoc
    zsh                 zsh
    fish                fish
    zstd                zstd"
browser_packages="
    chromium            chromium"
blender_packages="
    blender             blender
    python3-numpy       -
    xvfb                Xvfb
    xauth               xauth"
cluster_packages="
    libopenmpi-dev      -
    openmpi-bin         mpirun
    slurm-wlm           -
    munge               -"
deb_packages="
    ca-certificates     -
    debhelper           dh
    dpkg-dev            dpkg-buildpackage
    libopenmpi-dev      -
    lintian             lintian
    mmdebstrap          mmdebstrap
    nodejs              node
    npm                 npm"
python_packages="
    python3-cffi        -
    python3-numpy       -
    python3-venv        -
    python3-dev         -
    python3-setuptools  -
    python3-wheel       -"

say() {
    printf 'setup: %s\n' "$*" >&2
}

missing_packages() { # the packages of a list that are not there, one a line
    local package proof
    while read -r package proof; do
        [ -n "$package" ] || continue
        if [ "$proof" = - ]; then
            [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
                echo "$package"
        else
            command -v "$proof" >/dev/null 2>&1 || echo "$package"
        fi
    done <<<"$1"
}

refuse() { # reason, packages
    say "$1"
    say "these Debian 12 packages are missing:"
    say "    $2"
    say "install them (as root: apt-get install $2) and run this again"
    exit 1
}

install_packages() {
    local missing=$1 root=""
    command -v apt-get >/dev/null 2>&1 || refuse "this is not Debian: there is no apt-get" "$missing"
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null 2>&1 ||
            refuse "not root, and there is no sudo: nothing may be installed" "$missing"
        root=sudo
        if [ ! -t 0 ] && ! sudo -n true 2>/dev/null; then
            refuse "sudo needs a password and nobody is there to type it" "$missing"
        fi
    fi
    say "installing: $missing"
    $root apt-get update -q >&2 || say "apt-get update failed; trying with the lists at hand"
    # shellcheck disable=SC2086 # a list of words
    $root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -q -y --no-install-recommends $missing >&2 ||
        refuse "apt-get could not install everything (see above)" "$missing"
}

install_npm() { # folder, what is missing without: what package-lock.json pins, once per state of
                # that file
    local folder=$1
    [ -f "$folder/package-lock.json" ] || return 0
    cmp -s "$folder/package-lock.json" "$folder/node_modules/.installed-for" && return 0
    say "installing the npm packages of $folder"
    if ! npm ci --prefix "$folder" --no-audit --no-fund --ignore-scripts >&2; then
        say "npm ci failed in $folder (see above); the network is needed once. Going on"
        say "without: $2"
        return 0
    fi
    cp "$folder/package-lock.json" "$folder/node_modules/.installed-for"
}

case "${1:-check}" in
build) wanted=$build_packages ;;
check) wanted=$build_packages$'\n'$check_packages ;;
blender) wanted=$build_packages$'\n'$check_packages$'\n'$blender_packages ;;
cluster) wanted=$build_packages$'\n'$check_packages$'\n'$cluster_packages ;;
deb) wanted=$build_packages$'\n'$deb_packages ;;
browser) wanted=$build_packages$'\n'$check_packages$'\n'$browser_packages$'\n'$python_packages ;;
*)
    say "usage: scripts/setup.sh [build|check|browser|blender|cluster|deb]"
    exit 2
    ;;
esac

missing=$(missing_packages "$wanted" | xargs)
[ -z "$missing" ] || install_packages "$missing"
if command -v npm >/dev/null 2>&1; then
    install_npm web/viewer "alpenglow web will say what is missing"
fi
if [ "${1:-check}" != build ] && [ "${1:-check}" != deb ]; then
    install_npm tests/validator "tests that validate glTF files will be skipped, and say so"
    if command -v chromium >/dev/null 2>&1; then
        install_npm tests/browser "tests that open files in a browser will be skipped, and say so"
    fi
fi
