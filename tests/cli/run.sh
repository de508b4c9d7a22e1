#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs golden tests of the command.
#
#   tests/cli/run.sh [--update] TOOLS [AREA/CASE ...]
#
# TOOLS is a folder list (a:b) put in front of PATH: where `alpenglow` and `json_shape` are.
# A case is AREA/CASE.sh, run by bash in an empty folder of its own. Beside it lie what it must give:
#   CASE.stdout.exact, CASE.stderr.exact   the very text; no such file: nothing
#   CASE.stdout.glob,  CASE.stderr.glob    line by line a pattern (* ? [a-z]); the line "..." stands
#                                          for any lines at the end
#   CASE.exit                              the exit status; no such file: 0
# A case that ends with 77 is skipped, and its standard error says why.
# --update writes .exact and .exit anew (a .glob is kept, and must still match). Read the difference.
set -u
here=$(cd "$(dirname "$0")" && pwd)
update=no
if [ "${1:-}" = --update ]; then
    update=yes
    shift
fi
tools=${1:?usage: run.sh [--update] TOOLS [AREA/CASE ...]}
shift
absolute=
while IFS= read -r folder; do # cases run in a folder of their own
    absolute+=$(cd "$folder" && pwd): || exit 2
done < <(tr ':' '\n' <<<"$tools")
export PATH="$absolute$PATH" LC_ALL=C
for tool in alpenglow json_shape; do
    command -v $tool >/dev/null || { echo "run.sh: no $tool in $tools" >&2; exit 2; }
done

matches_glob() { # actual, glob file
    local actual pattern number=0
    exec 3<"$1" 4<"$2"
    while IFS= read -r pattern <&4 || [ -n "$pattern" ]; do
        number=$((number + 1))
        [ "$pattern" = "..." ] && return 0
        IFS= read -r actual <&3 || [ -n "$actual" ] || {
            echo "line $number is missing: $pattern"
            return 1
        }
        # shellcheck disable=SC2053 # the right side is a pattern on purpose
        [[ $actual == $pattern ]] || {
            printf 'line %s: %s\n is not: %s\n' "$number" "$actual" "$pattern"
            return 1
        }
    done
    if IFS= read -r actual <&3; then
        echo "one line too many: $actual"
        return 1
    fi
}

check_stream() { # case path, stream name, actual file
    local exact=$1.$2.exact glob=$1.$2.glob
    if [ -e "$glob" ]; then
        matches_glob "$3" "$glob"
    elif [ "$update" = yes ]; then
        if [ -s "$3" ]; then cp "$3" "$exact"; else rm -f "$exact"; fi
    elif [ -e "$exact" ]; then
        diff -u "$exact" "$3"
    else
        diff -u /dev/null "$3"
    fi
}

run_case() { # AREA/CASE
    local path=$here/$1 folder code=0 wanted=0 good=yes
    [ -f "$path.sh" ] || { echo "no such case: $1"; return 1; }
    folder=$(mktemp -d) || return 1
    mkdir "$folder/work"
    (cd "$folder/work" && bash "$path.sh" >"$folder/stdout" 2>"$folder/stderr" </dev/null) || code=$?
    if [ "$update" = yes ]; then
        if [ $code -ne 0 ]; then echo $code >"$path.exit"; else rm -f "$path.exit"; fi
    fi
    [ -e "$path.exit" ] && wanted=$(cat "$path.exit")
    if [ $code = 77 ] && [ $wanted != 77 ]; then
        cat "$folder/stderr"
        rm -rf "$folder"
        return 77
    fi
    [ "$code" = "$wanted" ] || { echo "exit status $code, not $wanted"; good=no; }
    check_stream "$path" stdout "$folder/stdout" || good=no
    check_stream "$path" stderr "$folder/stderr" || good=no
    chmod -R u+w "$folder" && rm -rf "$folder"
    [ $good = yes ]
}

cases=("$@")
if [ ${#cases[@]} -eq 0 ]; then
    mapfile -t cases < <(cd "$here" && ls ./*/*.sh | sed 's|^\./||; s|\.sh$||')
fi
failed=0 skipped=0
for name in "${cases[@]}"; do
    run_case "$name"
    case $? in
    0) echo "good  $name" ;;
    77)
        echo "skip  $name"
        skipped=$((skipped + 1))
        ;;
    *)
        echo "BAD   $name"
        failed=$((failed + 1))
        ;;
    esac
done
echo "${#cases[@]} cases, $failed failed"
[ $failed -eq 0 ] || exit 1
[ $skipped -lt ${#cases[@]} ] || exit 77
