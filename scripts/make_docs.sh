#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures, and writes docs/measured/*.md and the table of README.md. Takes an hour or more.
#
#   scripts/make_docs.sh [-c COMMAND] [-t TESTS] [PAGE ...]
#
# PAGE is accuracy, speed, atlas, peers, sh, fields, ambience or lpv; without it all eight. The page views makes
# the sheets of the viewer in docs/gallery.md. COMMAND is a release build of
# alpenglow (default build/release/apps/alpenglow/alpenglow). TESTS is the folder of the test
# programs (default build/dev/tests), whose lines "accuracy: …" are collected. Texts above the tables
# are in scripts/captions.md. Run it on an idle machine, with ALPENGLOW_SHARED set to the folder of
# the shared scenes and peers. Scenes that are absent are skipped; peers needs Blender and numpy.
set -euo pipefail
cd "$(dirname "$0")/.."
command=build/release/apps/alpenglow/alpenglow tests=build/dev/tests
while getopts c:t: option; do
    case $option in
        c) command=$OPTARG ;;
        t) tests=$OPTARG ;;
        *) exit 2 ;;
    esac
done
shift $((OPTIND - 1))

head_of() { # page, title: with its text, and the machine
    printf '# %s\n\n' "$2"
    scripts/make_tables.py text "$1"
    local cpu
    cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)
    printf '\nMeasured %s on %s, %s cores, load %s before, alpenglow %s, by `scripts/make_docs.sh %s`.\n' \
        "$(date -I)" "${cpu:-an unknown processor}" "$(nproc)" "$(cut -d' ' -f1 /proc/loadavg)" \
        "$("$command" --version | sed 's/.* //')" "$1"
}

section() { # title, room of the bench
    printf '\n## %s\n\n    alpenglow bench %s\n\n' "$1" "$2"
    "$command" bench "$2" --markdown | scripts/make_tables.py captions
}

speed() {
    head_of speed "Speed"
    section 'The innermost loop' transport
    section 'Light' light
    section 'Error per second' maps
    section 'Atlases' atlas
    section 'Acceleration structure' trace
    section 'Reading files' formats
}

accuracy() {
    head_of accuracy "Accuracy"
    section 'Techniques against the truth' truth
    section 'Stated errors' accuracy
    printf '\n'
    scripts/make_tables.py text 'closed forms'
    printf '\n'
    find "$tests" -type f -perm -u+x -print0 | sort -z | xargs -0 grep -l 'accuracy: ' |
        while read -r test; do
            { "$test" 2>&1 || true; } | sed -n 's/^accuracy: /    /p'
        done
}

peers() {
    head_of peers "Beside Blender's Cycles"
    printf '\n    scripts/peer_speed.py build/release/apps/alpenglow/alpenglow "$ALPENGLOW_SHARED"\n'
    scripts/peer_speed.py "$command" "$ALPENGLOW_SHARED" | scripts/make_tables.py peers
}

atlas() { # the tables come in place, and the pictures in docs/pictures
    head_of atlas "Atlases"
    printf '\n'
    scripts/make_tables.py text 'atlas tables'
}

sh_page() {
    head_of sh "Spherical harmonics"
    section 'Cube maps' sh
}

fields() {
    head_of fields "Light in space"
    section 'Models against the truth' fields
    printf '\n'
    scripts/make_tables.py text 'fields leak'
    printf '\n| wall at, m | ours | worst point | three.js look-up |\n|---:|---:|---:|---:|\n'
    "$tests/test_truth" test_probe_leak | sed -n 's/^leak: //p'
}

ambience() { # the plot goes to docs/pictures
    local head tables wall
    head=$(head_of ambience "Live ambience")
    wall=$(TEST_CASES=light_that_is_seen_does_not_jump AMBIENCE_PATHS=2000 "$tests/test_fields" \
        test_ambience_continuity | sed -n 's/.* \([0-9.]*\) % along 1 mm$/\1/p')
    tables=$("$(dirname "$command")/alpenglow-bench" ambience --markdown --pictures docs/pictures)
    printf '%s\n\n## Goals\n\n' "$head"
    scripts/make_tables.py text 'ambience goals'
    printf '\n'
    scripts/make_tables.py goals "$wall" <<<"$tables"
    printf '\n'
    scripts/make_tables.py text 'ambience plot'
    printf '\n## The volume along flights\n\n    alpenglow bench ambience\n\n'
    scripts/make_tables.py captions <<<"$tables"
}

lpv() { # the plot goes to docs/pictures
    head_of lpv "Light propagation"
    printf '\n## Speed, reach and error\n\n    alpenglow bench lpv\n\n'
    "$(dirname "$command")/alpenglow-bench" lpv --markdown --pictures docs/pictures |
        scripts/make_tables.py captions
    printf '\n'
    scripts/make_tables.py text 'lpv reach'
}

write_page() {
    local page=$1 new
    new=$(mktemp)
    case $page in
        sh) sh_page >"$new" ;; # not the shell
        *) "$page" >"$new" ;;
    esac
    cat "$new" >"docs/measured/$page.md"
    rm "$new"
    case $page in
        atlas)
            tests/truth/atlas_table.py "$(dirname "$command")/alpenglow-bench" \
                --document docs/measured/atlas.md
            ;;
        peers) scripts/make_tables.py readme docs/measured/peers.md README.md ;;
    esac
}

for page in "${@:-accuracy speed atlas peers sh fields ambience lpv}"; do
    for one in $page; do
        case $one in
            views)
                scripts/make_gallery.py "$command" docs/pictures \
                    view-cornell view-teapot-room view-terrain view-zdm2
                ;;
            accuracy | speed | atlas | peers | sh | fields | ambience | lpv) write_page "$one" ;;
            *) echo "make_docs: no page $one" >&2 && exit 2 ;;
        esac
    done
done
