#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# One step of the test of installed packages; hook.sh runs it inside the root. After a pipe, grep
# reads to the end: -q would end the writer early.
#
#   inside.sh STEP
set -euo pipefail
step=$1
[ -e /trial/repository/Packages ] || { # it moves the library and purges packages
    echo "deb: inside.sh runs only in the root that hook.sh prepares" >&2
    exit 1
}
cd /trial

fail() {
    printf 'deb: %s: %s\n' "$step" "$*" >&2
    exit 1
}

is_one_line() { # the line that a failing command printed to standard error, its start
    [ "$(wc -l <"$1")" = 1 ] || fail "more than one line: $(cat "$1")"
    grep -qF "$2" "$1" || fail "$(cat "$1"), instead of $2"
}

refused() { # text in the only line of a command that must fail, command
    local text=$1
    shift
    ! "$@" >out.txt 2>err.txt || fail "$* does not fail"
    is_one_line err.txt "$text"
}

run_consumer() { # folder of the program
    (cd "$1" && ./consumer) || fail "the program in $1 fails"
    [ -s "$1/cornell.glb" ] || fail "the program in $1 writes no file"
}

case $step in
command)
    alpenglow --version | grep -E '^alpenglow [0-9.]+$' >/dev/null || fail "no version"
    alpenglow bake builtin:cornell -o baked.glb --size 64 --maps ao,light -q
    cmp baked.glb expected.glb || fail "the package bakes other bits than the build"
    if [ -e /usr/share/alpenglow/web/page.html ]; then
        alpenglow web baked.glb -o page.html -q
        grep -q 'three.js authors' page.html || fail "the page has no notice of three.js"
        mv /usr/share/alpenglow/web/page.html moved.html
        refused "the page of three.js is missing" alpenglow web baked.glb -o other.html
        mv moved.html /usr/share/alpenglow/web/page.html
    else
        echo "without the page of alpenglow web"
    fi
    grep -q 'three.js authors' /usr/share/doc/alpenglow/copyright || fail "nor has the package"
    for page in alpenglow alpenglow-bake alpenglow-web; do
        zcat "/usr/share/man/man1/$page.1.gz" | grep '^\.SH NAME' >/dev/null || fail "no manual page $page"
    done
    bash -c '. /usr/share/bash-completion/completions/alpenglow && complete -p alpenglow' >out.txt ||
        fail "no completion for bash"
    [ -s /usr/share/zsh/vendor-completions/_alpenglow ] || fail "no completion for zsh"
    [ -s /usr/share/fish/vendor_completions.d/alpenglow.fish ] || fail "no completion for fish"
    [ -x /usr/libexec/alpenglow/alpenglow-bench ] || fail "no bench"
    ;;
no_viewer)
    refused "install the package alpenglow-viewer" alpenglow view baked.glb -o view.png --with ao
    ;;
no_driver)
    alpenglow view --help | grep '^Usage: alpenglow view' >/dev/null || fail "no help of the viewer"
    zcat /usr/share/man/man1/alpenglow-view.1.gz | grep '^\.SH NAME' >/dev/null || fail "no manual page"
    ! ls -d /usr/lib/*/dri >/dev/null 2>&1 || fail "there is a driver"
    refused "install libegl-mesa0 and libgl1-mesa-dri" alpenglow view baked.glb -o view.png --with ao
    [ ! -e view.png ] || fail "there is a picture without OpenGL"
    ;;
viewer)
    alpenglow view baked.glb -o view.png --with ao --resolution 64x64 -q
    [ "$(head -c 4 view.png | tail -c 3)" = PNG ] || fail "no picture"
    ;;
ranks)
    alpenglow-mpi --version | grep -E '^alpenglow [0-9.]+$' >/dev/null || fail "no version"
    mpirun --allow-run-as-root --oversubscribe -n 2 alpenglow-mpi bake builtin:cornell -o ranks.glb \
        --size 64 --maps ao,light -q
    cmp ranks.glb expected.glb || fail "two ranks bake other bits"
    zcat /usr/share/man/man1/alpenglow-mpi.1.gz | grep '^\.SH NAME' >/dev/null || fail "no manual page"
    ls /usr/share/doc/alpenglow-mpi/examples/ranks.sbatch* >/dev/null || fail "no scripts for Slurm"
    ;;
develop)
    mkdir pkg
    # shellcheck disable=SC2046 # a list of words
    cc -std=c17 -Wall -Wextra -Werror consumer.c -o pkg/consumer $(pkg-config --cflags --libs alpenglow)
    run_consumer pkg
    cmake -S . -B found >out.txt || fail "cmake: $(cat out.txt)"
    cmake --build found >out.txt || fail "cmake --build: $(cat out.txt)"
    run_consumer found
    ! ls /usr/include/jansson.h 2>/dev/null || fail "the headers of others are there, and hide faults"
    ;;
old_library)
    echo 'const char *alp_version(void); const char *alp_version(void) { return "0.0.9"; }' |
        cc -shared -fPIC -xc - -o old.so
    for program in alpenglow alpenglow-view alpenglow-mpi; do
        [ ! -x /usr/bin/$program ] ||
            refused "libalpenglow is of version 0.0.9, older than this program" \
                env LD_PRELOAD=/trial/old.so $program bake builtin:cornell
    done
    library=$(dirname /usr/lib/*/libalpenglow.so)/$(readlink /usr/lib/*/libalpenglow.so)
    mv "$library" moved.so
    refused "$(basename "$library"): cannot open shared object file" alpenglow --version
    mv moved.so "$library"
    alpenglow --version >out.txt || fail "no version"
    ;;
purge)
    mapfile -t packages < <(dpkg-query -W -f '${Package}\n' '*alpenglow*')
    dpkg --purge "${packages[@]}" >out.txt 2>&1 || fail "$(cat out.txt)"
    left=$(find / -xdev \( -path /proc -o -path /sys -o -path /trial -o -path '/var/lib/apt/*' \
        -o -path '/var/cache/apt/*' \) -prune -o -name '*alpenglow*' -print)
    [ -z "$left" ] || fail "these files are left: $left"
    ;;
*) fail "no such step" ;;
esac
