#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The installed package, used as strangers use it.
#
#   check.sh install BUILD WORK    installs the build into WORK/installed, then moves that away
#   check.sh find_package WORK     a CMake project finds it, builds and runs
#   check.sh pkg_config WORK       so does a compiler with pkg-config's flags
#   check.sh headers WORK          each header alone compiles as C17 and as C++17
#   check.sh symbols WORK          the library shows what the headers declare, and nothing else
#   check.sh readme WORK           the README shows the program that is built here
set -euo pipefail
project=$(cd "$(dirname "$0")/project" && pwd)
step=$1
unset MAKEFLAGS MFLAGS # of a make that may stand above

fail() {
    printf '%s: %s\n' "$step" "$*" >&2
    exit 1
}

run_consumer() { # program, folder to run in
    rm -f "$2/cornell.glb"
    (cd "$2" && "$1") || fail "the program failed"
    [ -s "$2/cornell.glb" ] || fail "the program wrote no file"
}

if [ "$step" = install ]; then
    build=$2 work=$3
    rm -rf "$work"
    mkdir -p "$work"
    cmake --install "$build" --prefix "$work/installed" >"$work/install.log"
    mv "$work/installed" "$work/moved" # nothing in it may know where it was installed
    [ "$("$work/moved/bin/alpenglow" --version | wc -l)" -ge 1 ] || fail "the command says nothing"
    exit 0
fi

work=$(cd "$2" && pwd)
prefix=$work/moved
libraries=$(dirname "$(find "$prefix" -name 'libalpenglow.*' | head -n 1)")
warnings="-Wall -Wextra -Wpedantic -Werror"

case $step in
find_package)
    cmake -S "$project" -B "$work/found" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release
    cmake --build "$work/found"
    run_consumer "$work/found/consumer" "$work/found"
    sed 's/find_package(alpenglow 0.1/find_package(alpenglow 0.2/' "$project/CMakeLists.txt" |
        (mkdir -p "$work/newer" && cat >"$work/newer/CMakeLists.txt")
    ! cmake -S "$work/newer" -B "$work/newer/build" -DCMAKE_PREFIX_PATH="$prefix" \
        >/dev/null 2>&1 || fail "version 0.2 was asked for and 0.1 accepted"
    ;;
pkg_config)
    export PKG_CONFIG_PATH=$libraries/pkgconfig
    static=""
    [ -e "$libraries/libalpenglow.so" ] || static=--static
    mkdir -p "$work/pkg"
    # shellcheck disable=SC2046,SC2086 # lists of words
    cc -std=c17 $warnings "$project/consumer.c" -o "$work/pkg/consumer" \
        $(pkg-config $static --cflags --libs alpenglow)
    LD_LIBRARY_PATH=$libraries run_consumer "$work/pkg/consumer" "$work/pkg"
    ;;
headers)
    for header in "$prefix"/include/alpenglow/*.h; do
        name=alpenglow/$(basename "$header")
        # shellcheck disable=SC2086 # a list of words
        printf '#include <%s>\ntypedef int something;\n' "$name" |
            cc -std=c17 $warnings -Wstrict-prototypes -I"$prefix/include" -fsyntax-only -xc - ||
            fail "$name alone is not C17"
        # shellcheck disable=SC2086
        printf '#include <%s>\ntypedef int something;\n' "$name" |
            c++ -std=c++17 $warnings -I"$prefix/include" -fsyntax-only -xc++ - ||
            fail "$name alone is not C++17"
        grep -q "<$name>" "$prefix/include/alpenglow/alpenglow.h" || case $name in
        alpenglow/alpenglow.h | alpenglow/export.h) ;;
        *) fail "alpenglow.h does not include <$name>" ;;
        esac
    done
    ;;
symbols)
    [ -e "$libraries/libalpenglow.so" ] || exit 0 # only a shared library hides
    nm -D --defined-only "$libraries/libalpenglow.so" | awk '{print $NF}' | sort >"$work/shown"
    echo '#include <alpenglow/alpenglow.h>' |
        cc -std=c17 -I"$prefix/include" -E -P -xc - | tr '\n' ' ' | tr ';}' '\n\n' |
        grep -o 'visibility("default").*' | grep -o 'alp_[a-z0-9_]* *(' | tr -d ' (' |
        sort -u >"$work/declared"
    [ -s "$work/declared" ] || fail "no function was found in the headers"
    diff "$work/declared" "$work/shown" >"$work/difference" ||
        fail "declared (<) and shown (>) differ:
$(cat "$work/difference")"
    ;;
readme)
    # shellcheck disable=SC2016 # the backquotes are Markdown
    sed -n '/^```c$/,/^```$/p' "$project/../../../README.md" | sed '/^```/d' >"$work/readme.c"
    sed '/^\/\//d' "$project/consumer.c" | diff - "$work/readme.c" ||
        fail "the C program in README.md is not $project/consumer.c"
    ;;
*) fail "no such step" ;;
esac
