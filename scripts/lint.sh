#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Reads the sources with everything that finds faults without running them.
#
#   scripts/lint.sh          formatting, rooms, cppcheck, clang-tidy: all run, then 1 if any failed
#   scripts/lint.sh format   formats in place instead
#
# Needs a configured build/dev (make lint does that). Settings: .clang-format, .clang-tidy,
# scripts/cppcheck.suppressions.
set -uo pipefail
cd "$(dirname "$0")/.."
jobs=$(nproc)

sources() {
    find src include apps bench examples tests -path '*/node_modules' -prune -o \( -name '*.[ch]' -o -name '*.cpp' \) -print0
}

check_format() {
    sources | xargs -0 clang-format --dry-run -Werror
}

check_rooms() {
    scripts/check_rooms.py
}

check_cppcheck() { # not tests, which are run, most of them under sanitizers too
    cppcheck --quiet --error-exitcode=1 -j "$jobs" --std=c11 --library=posix --inline-suppr \
        --enable=warning,performance,portability,style --suppress=missingIncludeSystem \
        --suppressions-list=scripts/cppcheck.suppressions -D__GNUC__ \
        -I include -I build/dev/include -I src -I . src apps bench examples
}

tidy() { # folders, options
    local log=build/dev/clang-tidy-${1//[^a-z]/}.log folders=$1
    shift
    run-clang-tidy -quiet -j "$jobs" -p build/dev "$@" "^$PWD/$folders/" >"$log" 2>&1 && return
    # One finding in a header is told for every file that includes it: each is shown once.
    sed 's/\x1b\[[0-9;]*m//g' "$log" | grep -E ': (error|warning): ' | sort -u
    echo "what led to each: $log"
    return 1
}

# Most of the time is the analyser's, which follows the paths of a function as far as so many nodes
# (of itself as far as 225,000). Tests do without (tests/.clang-tidy): they are run, most of
# them under sanitizers too.
check_clang_tidy() {
    local found=0 analyser=-extra-arg=-Xclang
    tidy "(src|apps|bench)" $analyser -extra-arg=-analyzer-config $analyser \
        -extra-arg=max-nodes=45000 || found=1
    tidy tests || found=1
    return $found
}

if [ "${1:-}" = format ]; then
    sources | xargs -0 clang-format -i
    exit
fi

failed=""
for step in format rooms cppcheck clang_tidy; do
    before=$SECONDS
    "check_$step" || failed="$failed $step"
    echo "lint: $step took $((SECONDS - before)) s"
done
[ -z "$failed" ] && echo "lint: no findings" && exit 0
echo "lint: findings in$failed"
exit 1
