#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Reads the sources with everything that finds faults without running them.
#
#   scripts/lint.sh          formatting, rooms and cppcheck of all, clang-tidy of what changed
#   scripts/lint.sh all      clang-tidy of all too
#   scripts/lint.sh format   formats in place instead
#
# What changed is told from LINT_BASE, a commit. Unless it is set, that is origin/main, or the commit
# before where HEAD is already in origin/main. All checks run, then the exit status is 1 if any failed.
# Needs a configured build/dev (make lint does that). Settings: .clang-format, .clang-tidy,
# scripts/cppcheck.suppressions.
set -uo pipefail
cd "$(dirname "$0")/.."
jobs=$(nproc)

sources() {
    find src include apps bench examples tests -path '*/node_modules' -prune -o \( -name '*.[ch]' -o -name '*.cpp' \) -print0
}

# CMake writes files that compile a PATH_body.h for one level of instructions each. One of the levels
# is read.
variants() {
    find build/dev/src -name '*_baseline.c'
}

check_format() {
    sources | xargs -0 clang-format --dry-run -Werror
}

check_rooms() {
    scripts/check_rooms.py
}

check_cppcheck() { # not tests, which are run, most of them under sanitizers too
    # shellcheck disable=SC2046 # names without white space
    cppcheck --quiet --error-exitcode=1 -j "$jobs" --std=c11 --library=posix --inline-suppr \
        --enable=warning,performance,portability,style --suppress=missingIncludeSystem \
        --suppressions-list=scripts/cppcheck.suppressions -D__GNUC__ \
        -I include -I build/dev/include -I src -I apps/alpenglow -I apps/viewer -I . src apps bench examples $(variants)
}

base_commit() { # nothing where there is no commit to compare with
    local main
    if [ -n "${LINT_BASE:-}" ]; then
        git rev-parse --verify --quiet "$LINT_BASE^{commit}" && return
        echo "lint: LINT_BASE is no commit: $LINT_BASE" >&2
    fi
    main=$(git merge-base HEAD origin/main 2>/dev/null)
    if [ -n "$main" ] && [ "$main" != "$(git rev-parse HEAD)" ]; then
        echo "$main"
    else
        git rev-parse --verify --quiet 'HEAD~1^{commit}'
    fi
}

# The sources that clang-tidy must read for a list of changed files: those themselves, and for a
# header its own source, else the first one that includes it.
sources_for() {
    local file name source
    while read -r file; do
        case $file in
        *.c | *.cpp) echo "$file" ;;
        *_body.h) variants | grep -F "/${file%_body.h}_baseline.c" ;;
        *.h)
            source=${file%.h}.c
            name=$(basename "$file")
            [ -f "$source" ] || source=$(git grep -l -E "#include [\"<](.*/)?$name[\">]" -- '*.c' '*.cpp' | head -n 1)
            [ -z "$source" ] || echo "$source"
            ;;
        esac
    done | sort -u
}

tidy() { # name of the log, regular expression of paths below this folder, options
    local log=build/dev/clang-tidy-$1.log paths=$2
    shift 2
    run-clang-tidy -quiet -j "$jobs" -p build/dev "$@" "^$PWD/($paths)" >"$log" 2>&1 && return
    # One finding in a header is told for every file that includes it: each is shown once.
    sed 's/\x1b\[[0-9;]*m//g' "$log" | grep -E ': (error|warning): ' | sort -u
    echo "what led to each: $log"
    return 1
}

# Most of the time is the analyser's, which follows the paths of a function as far as so many nodes
# (of itself as far as 225,000). Tests do without (tests/.clang-tidy): they are run, most of
# them under sanitizers too.
check_clang_tidy() {
    local found=0 analyser=-extra-arg=-Xclang base list ours tests
    ours='(src|apps|bench)/|build/dev/src/.*_baseline\.c' tests='tests/'
    if [ "$scope" = changed ] && base=$(base_commit) && [ -n "$base" ]; then
        list=$({ git diff --name-only --diff-filter=d "$base" && git ls-files -o --exclude-standard; } | sources_for)
        ours=$(grep -E '^(src|apps|bench|build)/' <<<"$list" | sed 's/\./\\./g; s/$/$/' | paste -sd '|')
        tests=$(grep -E '^tests/' <<<"$list" | sed 's/\./\\./g; s/$/$/' | paste -sd '|')
        echo "lint: clang-tidy reads $(grep -c . <<<"$list") files, which changed since $(git log -1 --format=%h "$base"); 'make lint-all' reads all"
    fi
    if [ -n "$ours" ]; then
        tidy sources "$ours" $analyser -extra-arg=-analyzer-config $analyser \
            -extra-arg=max-nodes=45000 || found=1
    fi
    if [ -n "$tests" ]; then
        tidy tests "$tests" || found=1
    fi
    return $found
}

case "${1:-}" in
format)
    sources | xargs -0 clang-format -i
    exit
    ;;
all) scope=all ;;
"") scope=changed ;;
*)
    echo "usage: scripts/lint.sh [all|format]" >&2
    exit 2
    ;;
esac

failed=""
for step in format rooms cppcheck clang_tidy; do
    before=$SECONDS
    "check_$step" || failed="$failed $step"
    echo "lint: $step took $((SECONDS - before)) s"
done
[ -z "$failed" ] && echo "lint: no findings" && exit 0
echo "lint: findings in$failed"
exit 1
