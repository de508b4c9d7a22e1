#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Writes docs/speed.md, docs/accuracy.md and the tables of docs/atlas.md anew from measurements, in
# an hour or more.
#
#   scripts/make_docs.sh [COMMAND [TESTS]]
#
# COMMAND is a release build of alpenglow (default build/release/apps/alpenglow/alpenglow), TESTS the
# folder of the test programs (default build/dev/tests), whose lines "accuracy: …" are collected.
# Run it on a machine that has nothing else to do, with ALPENGLOW_SHARED set to the shared scenes:
# those that are not there show as skipped.
set -euo pipefail
cd "$(dirname "$0")/.."
command=${1:-build/release/apps/alpenglow/alpenglow}
tests=${2:-build/dev/tests}

machine() {
    local cpu
    cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)
    printf 'Measured %s on %s with %s cores, load %s before, alpenglow %s, by `scripts/make_docs.sh`.\n' \
        "$(date -I)" "${cpu:-an unknown processor}" "$(nproc)" "$(cut -d' ' -f1 /proc/loadavg)" \
        "$("$command" --version | sed 's/.* //')"
}

section() { # title, room
    printf '\n## %s\n\n    alpenglow bench %s\n\n' "$1" "$2"
    "$command" bench "$2" --markdown | sed '/./,$!d' | cat -s
}

speed() {
    cat <<'TEXT'
# Speed

Written by `scripts/make_docs.sh`; do not edit. Machines drift, so what counts is the ratio of what
was measured in turns in one process: seconds of the limit over ours, 1 is the limit. Medians;
processor time for one worker, wall time for more.

TEXT
    machine
    section 'The innermost loop' transport
    section 'Light' light
    section 'Error per second' maps
    section 'Atlases' atlas
    section 'Acceleration structure' trace
    section 'Reading files' formats
}

closed_forms() {
    printf '\n## Closed forms and oracles\n\nWhat the tests say of accuracy, `ctest --preset dev`:\n\n'
    local test
    for test in "$tests"/test_*; do
        [ -f "$test" ] && [ -x "$test" ] && grep -q 'accuracy: ' "$test" || continue
        "$test" 2>&1 | sed -n "s/^accuracy: /    /p" || true
    done
}

accuracy() {
    cat <<'TEXT'
# Accuracy

Written by `scripts/make_docs.sh`; do not edit. Errors of occlusion are in units of accessibility, 0
to 1, or in percent of the mean of the map where they say so. What interpolation costs and gains
stands in [speed.md](speed.md), "Error per second": the lines `adaptive off` and `auto` of a scene.

TEXT
    machine
    section 'Techniques against the truth' truth
    section 'Stated errors' accuracy
    closed_forms
}

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
speed >"$folder/speed.md"
accuracy >"$folder/accuracy.md"
cp "$folder"/*.md docs/
tests/truth/atlas_table.py "$(dirname "$command")/alpenglow-bench" --document docs/atlas.md
