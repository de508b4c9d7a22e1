#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The installed package, used as strangers use it.
#
#   check.sh install BUILD WORK    installs the build into WORK/installed, then moves that away
#   check.sh find_package WORK     a CMake project finds it, builds and runs
#   check.sh pkg_config WORK       so does a compiler with pkg-config's flags
#   check.sh headers WORK          each header alone compiles as C17 and as C++17
#   check.sh symbols WORK          the library shows what the headers declare, and nothing else
#   check.sh examples WORK         examples/ compile as their first comments say and by CMake, and run
#   check.sh manual WORK           manual pages and completion lie where man and the shells look
#   check.sh old_library WORK      programs refuse a library that is older than they are
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

run_quick_examples() { # folder with the programs, names of five
    local folder=$1 points=$2 bake=$3 maps=$4 light=$5 lpv=$6
    cd "$folder"
    "./$points" >points.txt || fail "$points failed"
    awk 'NR > 1 { n++; if ($5 * $5 > 0.005 * 0.005 || $3 - $4 > 0.005 || $4 - $3 > 0.005) bad = 1 }
         END { exit bad || n != 5 }' points.txt || fail "$points is off: $(cat points.txt)"
    "$prefix/bin/alpenglow" bake builtin:sphere-plane -o scene.glb --size 32 --ao-samples 1 -q -f
    "./$bake" scene.glb baked.glb >bake.txt 2>stages.txt || fail "$bake failed"
    grep -q '^baked.glb: [0-9]* texels, [0-9]* rays, mean accessibility 0\.[0-9]*, ' bake.txt ||
        fail "$bake says $(cat bake.txt)"
    grep -q '^stage occlusion$' stages.txt || fail "$bake tells no progress"
    "$prefix/bin/alpenglow" info baked.glb >/dev/null || fail "$bake wrote no scene"
    ! "./$bake" no-such.glb baked.glb 2>error.txt || fail "$bake takes a file that is not there"
    grep -q 'no-such.glb' error.txt || fail "$bake does not name the file that is not there"
    "./$maps" >maps.txt || fail "$maps failed"
    awk '$NF <= 0 || $NF > 1 { bad = 1 } $NF < 1 { shaded++ } END { exit bad || shaded < 3 || NR < 6 }' \
        maps.txt || fail "$maps is off: $(cat maps.txt)"
    "$prefix/bin/alpenglow" compare page.png page.png --max-rmse 0 -q >/dev/null ||
        fail "$maps wrote no picture"
    # 60,000 lux from 45 degrees are 42,426 on level ground, to which a sky with 7.3 kcd/m2 at its
    # zenith adds 20,000 to 30,000; where the wall keeps the sun off there are no more than these
    "./$light" >light.txt || fail "$light failed"
    awk '/^irradiance/ { seen = $5 > 5000 && $5 < 30000 && $7 > 62426 && $7 < 90000 }
         END { exit !seen }' light.txt || fail "$light is off: $(cat light.txt)"
    # a ceiling four cells above the floor: propagation gives .7 of the closed form
    "./$lpv" >lpv.txt || fail "$lpv failed"
    awk '{ share = $8 / $NF; if (share < .5 || share > 1.2) bad = 1 } END { exit bad || NR != 3 }' \
        lpv.txt || fail "$lpv is off: $(cat lpv.txt)"
    cd - >/dev/null
}

run_slow_examples() { # folder with the programs, names of two
    local folder=$1 probes=$2 ambience=$3
    cd "$folder"
    "./$probes" >probes.txt || fail "$probes failed"
    # the nine harmonics and the grid are within a fifth of the path tracer
    awk '/^above/ { seen = ($3 - $7) ^ 2 < (.2 * $7) ^ 2 } END { exit !seen || NR != 3 }' probes.txt ||
        fail "$probes is off: $(cat probes.txt)"
    # the clear sky and what the ground reflects, 5,000 to 40,000 lux; the shader's vectors give the same
    "./$ambience" >ambience.txt || fail "$ambience failed"
    awk '$6 != "lit" || $8 < 5000 || $8 > 40000 || ($8 - $13) ^ 2 > 1 || $3 < 500 { bad = 1 }
         END { exit bad || NR != 3 }' ambience.txt || fail "$ambience is off: $(cat ambience.txt)"
    cd - >/dev/null
}

if [ "$step" = install ]; then
    build=$2 work=$3
    rm -rf "$work"
    mkdir -p "$work"
    cmake --install "$build" --prefix "$work/installed" >"$work/install.log"
    mv "$work/installed" "$work/moved" # nothing in it may know where it was installed
    [ "$("$work/moved/bin/alpenglow" --version | wc -l)" -ge 1 ] || fail "the command says nothing"
    [ ! -e "$build/apps/alpenglow/alpenglow-view" ] ||
        "$work/moved/bin/alpenglow-view" --help | grep '^Usage: alpenglow view' >/dev/null ||
        fail "the viewer is not beside the command"
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
examples)
    examples=$(cd "$project/../../../examples" && pwd)
    export PKG_CONFIG_PATH=$libraries/pkgconfig
    static=""
    [ -e "$libraries/libalpenglow.so" ] || static=--static
    # shellcheck disable=SC2086,SC2317 # nothing or one word; called by the line
    pkg-config() { command pkg-config $static "$@"; }
    rm -rf "$work/examples" && mkdir -p "$work/examples"
    for source in "$examples"/*.c; do
        [ "$(wc -l <"$source")" -lt 100 ] || fail "$source is not under 100 lines"
        line=$(sed -n 's|^//  *\(cc .*\)$|\1|p' "$source")
        [ -n "$line" ] || fail "$source does not say how to compile it"
        (cd "$examples" && eval "${line/ -o / $warnings -o $work/examples/}") || fail "$line"
        grep -qF "$(basename "$source")" "$examples/README.md" || fail "README.md misses $source"
    done
    # CMake's programs know where the library is, a compiler's do not.
    (
        export LD_LIBRARY_PATH=$libraries
        run_quick_examples "$work/examples" points bake maps light lpv
        run_slow_examples "$work/examples" probes ambience
    )
    cmake -S "$examples" -B "$work/examples/build" -DCMAKE_PREFIX_PATH="$prefix"
    cmake --build "$work/examples/build"
    run_quick_examples "$work/examples/build" 01_occlusion_at_points 02_bake_a_file 03_maps_as_arrays \
        04_light_a_scene 08_lpv
    for program in 06_probes 07_ambience; do # the same sources and library as above
        ldd "$work/examples/build/$program" >"$work/ldd.txt" && ! grep "not found" "$work/ldd.txt" >&2 ||
            fail "$program does not find the library"
    done
    ;;
manual)
    share=$(dirname "$(find "$prefix" -name man -type d)")
    "$prefix/bin/alpenglow" --man | diff - "$share/man/man1/alpenglow.1"
    for name in $("$prefix/bin/alpenglow" --commands); do
        "$prefix/bin/alpenglow" --man "$name" | diff - "$share/man/man1/alpenglow-$name.1"
    done
    "$prefix/bin/alpenglow" --completion bash |
        diff - "$share/bash-completion/completions/alpenglow"
    "$prefix/bin/alpenglow" --completion zsh | diff - "$share/zsh/site-functions/_alpenglow"
    "$prefix/bin/alpenglow" --completion fish |
        diff - "$share/fish/vendor_completions.d/alpenglow.fish"
    [ "$(find "$share/man" -type f | wc -l)" = \
        $(($("$prefix/bin/alpenglow" --commands | wc -l) + 1)) ] || fail "pages of nothing"
    ! command -v man >/dev/null || man -M "$share/man" alpenglow-bake | grep -q 'ao-falloff' ||
        fail "man does not find alpenglow-bake"
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
old_library)
    [ -e "$libraries/libalpenglow.so" ] || exit 0 # a static library is as old as its program
    for version in 0.0.9 999.0.0; do
        echo "const char *alp_version(void); const char *alp_version(void) { return \"$version\"; }" |
            cc -shared -fPIC -xc - -o "$work/$version.so"
    done
    for program in "$prefix"/bin/alpenglow*; do
        ! LD_PRELOAD=$work/0.0.9.so "$program" info builtin:cornell >"$work/out" 2>"$work/error" ||
            fail "$program accepts an older library"
        grep -q "^alpenglow: the library libalpenglow is of version 0.0.9, older than this program" \
            "$work/error" || fail "$program: $(cat "$work/error")"
        [ "$(wc -l <"$work/error")" = 1 ] || fail "more than one line: $(cat "$work/error")"
    done
    LD_PRELOAD=$work/999.0.0.so "$prefix/bin/alpenglow" info builtin:cornell >"$work/out" ||
        fail "a later library is refused"
    ;;
readme)
    # shellcheck disable=SC2016 # the backquotes are Markdown
    sed -n '/^```c$/,/^```$/p' "$project/../../../README.md" | sed '/^```/d' >"$work/readme.c"
    sed '/^\/\//d' "$project/consumer.c" | diff - "$work/readme.c" ||
        fail "the C program in README.md is not $project/consumer.c"
    ;;
*) fail "no such step" ;;
esac
