#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the packages one after the other in a root, and tries each. mmdebstrap calls it.
#
#   hook.sh ROOT SHARE    SHARE holds what run.sh put there
set -euo pipefail
root=$1 share=$2
if [ "${MMDEBSTRAP_HOOK:-}" != customize ] || [ "$(realpath "$root")" = / ]; then
    echo "deb: hook.sh installs and removes packages, and only mmdebstrap may call it" >&2
    exit 1
fi

apt() { # arguments: the apt-get of the root, which cannot reach the machine around it
    chroot "$root" apt-get -qq --yes -o Dpkg::Use-Pty=0 "$@" >"$root/trial/apt.txt" 2>&1 || {
        tail -n 20 "$root/trial/apt.txt" >&2
        echo "deb: apt-get fails: $*" >&2
        exit 1
    }
}

install() { # options and packages
    apt install "$@"
}

try() { # a step of inside.sh
    chroot "$root" env -i PATH=/usr/bin:/bin:/usr/sbin:/sbin HOME=/trial LC_ALL=C.UTF-8 \
        bash /trial/inside.sh "$1"
    echo "deb: $1: right"
}

has() {
    ls "$share/repository/${1}_"*.deb >/dev/null 2>&1
}

cp -r "$share" "$root/trial"
echo "deb [trusted=yes] file:/trial/repository ./" >"$root/etc/apt/sources.list.d/trial.list"
apt update

install --no-install-recommends alpenglow
try command
try no_viewer
if has alpenglow-viewer; then
    install --no-install-recommends alpenglow-viewer
    try no_driver
    install libegl-mesa0 libgl1-mesa-dri
    try viewer
fi
if has alpenglow-mpi; then
    install --no-install-recommends alpenglow-mpi openmpi-bin
    try ranks
fi
install --no-install-recommends libalpenglow-dev gcc libc6-dev pkg-config cmake make
try develop
try old_library
try purge
