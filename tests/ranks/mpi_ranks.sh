#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# alpenglow-mpi under mpirun: the same bytes as the command, a killed rank, a request to stop, a
# resumed bake with another number of ranks, and refusals.
#
#   mpi_ranks.sh FOLDER     the folder of alpenglow and alpenglow-mpi
#
# Exit status: 0 all is right, 77 skipped, 1 a fault.
set -uo pipefail
programs=$1

skip() {
    echo "skipped: $1" >&2
    exit 77
}
command -v mpirun >/dev/null 2>&1 || skip "there is no mpirun (scripts/setup.sh cluster)"
[ -x "$programs/alpenglow-mpi" ] || skip "alpenglow-mpi is not built (scripts/setup.sh cluster)"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1

fail() { # text, file with output
    echo "FAILED: $1"
    [ -z "${2:-}" ] || sed 's/^/    /' "$2"
    exit 1
}

sums() { # the sums of a folder's files
    (cd "$1" && md5sum ./*)
}

bake() { # ranks, folder, options
    local ranks=$1 out=$2
    shift 2
    timeout 60 mpirun -n "$ranks" "$programs/alpenglow-mpi" bake builtin:cornell --maps-dir "$out" \
        --threads 1 -q "$@"
}

# --- the same bytes ------------------------------------------------------------------------------
small=(--maps "ao,light,probes" --size 48 --samples 16 --ao-samples 16 --sky 1 --spacing 0.14)
"$programs/alpenglow" bake builtin:cornell --maps-dir "$folder/alone" -q "${small[@]}" ||
    fail "the command"
for ranks in 1 2 4; do
    bake "$ranks" "$folder/ranks-$ranks" "${small[@]}" >"$folder/out" 2>&1 ||
        fail "$ranks ranks" "$folder/out"
    [ ! -s "$folder/out" ] || fail "$ranks ranks are not quiet" "$folder/out"
    [ "$(sums "$folder/alone")" = "$(sums "$folder/ranks-$ranks")" ] ||
        fail "$ranks ranks wrote other bytes"
done
mpirun -n 2 "$programs/alpenglow-mpi" probes builtin:cornell -o "$folder/two.probes.json" --sky 1 \
    --spacing 0.2 >"$folder/out" 2>&1 || fail "probes" "$folder/out"
[ "$(grep -c '^wrote' "$folder/out")" = 1 ] || fail "not one rank prints" "$folder/out"

# --- refusals ------------------------------------------------------------------------------------
refuses() { # status, text, words
    local status=$1 text=$2 got=0
    shift 2
    timeout 60 mpirun -n 2 "$programs/alpenglow-mpi" "$@" >"$folder/out" 2>&1 || got=$?
    [ "$got" = "$status" ] || fail "$*: status $got" "$folder/out"
    [ "$(grep -c "$text" "$folder/out")" = 1 ] || fail "$*: not one line of \"$text\"" "$folder/out"
}
refuses 2 "runs in one process" info builtin:cornell
refuses 1 "no-such-file" bake no-such-file.glb -o "$folder/out.glb"
refuses 1 "exists already" bake builtin:cornell --maps-dir "$folder/alone" "${small[@]}"
refuses 1 "time-limit" bake builtin:cornell --maps-dir "$folder/late" --time-limit 9 --size 48
[ ! -e "$folder/late" ] || fail "a refused bake left a folder"

# A rank with other options.
timeout 60 mpirun -n 1 "$programs/alpenglow-mpi" bake builtin:cornell --maps-dir "$folder/other" \
    --size 48 --seed 1 : -n 1 "$programs/alpenglow-mpi" bake builtin:cornell \
    --maps-dir "$folder/other" --size 48 --seed 2 >"$folder/out" 2>&1 &&
    fail "ranks with other seeds end well" "$folder/out"
grep -q 'the ranks run different bakes: rank 0 has "--seed 1"' "$folder/out" ||
    fail "the seeds are not named" "$folder/out"

# --- a kill, a request to stop, and resumed bakes ------------------------------------------------
large=(--maps light --size 320 --samples 768 --sky 1)
timeout 60 "$programs/alpenglow" bake builtin:cornell --maps-dir "$folder/undisturbed" -q --threads 2 \
    "${large[@]}" || fail "the command"

interrupt() { # name, status pattern, text; the job runs 1 s after its first checkpoint
    local name=$1 wanted=$2 text=$3 got=0 job rank
    bake 2 "$folder/$name" "${large[@]}" --checkpoint "$folder/$name.kept" --checkpoint-every 0.2 \
        >"$folder/out" 2>&1 &
    job=$!
    for _ in $(seq 100); do
        [ ! -s "$folder/$name.kept/rank-1.tiles" ] || break
        sleep 0.1
    done
    sleep 0.3
    rank=$(ps -eo pid,args | awk -v out="$folder/$name" '
        /alpenglow-mpi bake/ && index($0, out) && !/mpirun|awk|timeout/ {print $1}' | tail -1)
    case $name in
    killed) kill -9 "$rank" ;;
    stopped) kill -USR1 "$(ps -eo pid,comm,args | awk -v out="$folder/$name" '
        $2 == "mpirun" && index($0, out) {print $1}')" ;;
    esac
    wait "$job" || got=$?
    [[ $got =~ ^($wanted)$ ]] || fail "$name: status $got" "$folder/out"
    grep -q "$text" "$folder/out" || fail "$name: no line \"$text\"" "$folder/out"
    [ ! -e "$folder/$name/irradiance.exr" ] || fail "$name: maps were written"
}
resume() { # name, ranks
    timeout 60 mpirun -n "$2" "$programs/alpenglow-mpi" bake builtin:cornell --maps-dir \
        "$folder/$1" --threads 1 "${large[@]}" --checkpoint "$folder/$1.kept" >"$folder/out" 2>&1 ||
        fail "resumed with $2 ranks" "$folder/out"
    grep -q "goes on from its checkpoint" "$folder/out" || fail "$1: not resumed" "$folder/out"
    [ "$(sums "$folder/undisturbed")" = "$(sums "$folder/$1")" ] || fail "$1: other bytes"
    [ -z "$(find "$folder/$1.kept" -name '*.tiles')" ] || fail "$1: tiles are left"
}
interrupt killed "1|137" "exited on signal 9"
resume killed 3
interrupt stopped 75 "the checkpoint keeps the work"
resume stopped 1
[ -z "$(ps -eo args | grep "^$programs/alpenglow-mpi .*$folder")" ] || fail "a rank is left"
echo "all is right"
