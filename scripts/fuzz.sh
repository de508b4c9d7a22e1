#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Feeds the readers made-up input under the address and undefined behaviour sanitizers, by clang's
# libFuzzer (tests/fuzz, preset fuzz), and prints a table. Exits with 1 when anything crashed, hung
# for 10 s, leaked or took too much memory; the input that did it lies in build/fuzz/findings.
#
#   scripts/fuzz.sh [--seconds N] [TARGET...]          each for N seconds (default 600); what was
#                                                      learned is kept in build/fuzz/learned
#   scripts/fuzz.sh --runs N [--seed N] [TARGET[=N]...]  N inputs each (=N: for this one), from the
#                                                      corpus of the tree alone: the same each time
#
# Targets: those of tests/fuzz/CMakeLists.txt; default: all.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 2

seconds=600 runs="" seed=1 targets=()
while [ $# -gt 0 ]; do
    case $1 in
    --seconds) seconds=$2 && shift 2 ;;
    --runs) runs=$2 && shift 2 ;;
    --seed) seed=$2 && shift 2 ;;
    -*) sed -n '3,12s/^# \{0,1\}//p' "$0" && exit 2 ;;
    *) targets+=("$1") && shift ;;
    esac
done
if [ ${#targets[@]} -eq 0 ]; then
    read -ra targets <<<"$(sed -n 's/^set(fuzz_names \(.*\))$/\1/p' tests/fuzz/CMakeLists.txt)"
fi

if ! command -v clang >/dev/null; then
    echo "fuzz: clang and its libFuzzer are needed (Debian: apt-get install clang)" >&2
    exit 2
fi
out=build/fuzz
mkdir -p "$out"
if ! { cmake --preset fuzz --log-level=WARNING && cmake --build --preset fuzz; } \
    >"$out/build.log" 2>&1; then
    tail -40 "$out/build.log" >&2
    exit 2
fi
findings=$out/findings
scratch=$(mktemp -d "$([ -w /dev/shm ] && echo /dev/shm || echo "${TMPDIR:-/tmp}")/fuzz-XXXXXX")
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$findings"

longest() { # most bytes of an input: what is slow stays small
    case $1 in
    exr | gltf | glb | collada) echo 8192 ;;
    *) echo 4096 ;;
    esac
}

failed=0 total=0
printf '%-10s %10s %8s %10s %6s  %s\n' target inputs seconds "peak MiB" edges result
for word in "${targets[@]}"; do
    target=${word%%=*} count=$runs
    [ "$word" = "$target" ] || count=${word#*=}
    learned=$out/learned/$target
    options=(-timeout=10 -rss_limit_mb=3072 -max_len="$(longest "$target")" -print_final_stats=1
        -artifact_prefix="$findings/$target-" -verbosity=1)
    if [ -n "$count" ]; then
        learned=$scratch/learned/$target
        options+=(-runs="$count" -seed="$seed")
    else
        options+=(-max_total_time="$seconds")
    fi
    dictionary=tests/fuzz/dictionaries/${target/#glb/gltf}.dict
    dictionary=${dictionary/zae/collada}
    [ ! -f "$dictionary" ] || options+=(-dict="$dictionary")
    mkdir -p "$learned" "$scratch/files"
    before=$SECONDS
    TMPDIR=$scratch/files "$out/fuzz/fuzz_$target" "${options[@]}" "$learned" \
        "tests/fuzz/corpus/$target" >"$out/$target.log" 2>&1
    state=$?
    done_runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$out/$target.log" | tail -1)
    peak=$(sed -n 's/^stat::peak_rss_mb: *//p' "$out/$target.log" | tail -1)
    edges=$(grep -o 'cov: [0-9]*' "$out/$target.log" | tail -1)
    result="no finding"
    if [ $state -ne 0 ]; then
        failed=1
        result="FOUND: $(grep -hE '^(SUMMARY|fuzz:)' "$out/$target.log" | tail -1) ($out/$target.log)"
    fi
    total=$((total + ${done_runs:-0}))
    printf '%-10s %10s %8s %10s %6s  %s\n' "$target" "${done_runs:--}" $((SECONDS - before)) \
        "${peak:--}" "${edges#cov: }" "$result"
done
printf '%-10s %10s\n' all "$total"
exit $failed
