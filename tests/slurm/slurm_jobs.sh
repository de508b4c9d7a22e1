#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The job scripts of examples/slurm: the same bytes as the command, a job that is told to stop and
# queued again, and shards that are missing.
#
#   with_slurm.sh PROGRAMS slurm_jobs.sh EXAMPLES    the folder of the scripts
#
# Exit status: 0 all is right, 1 a fault.
set -uo pipefail
examples=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1

fail() { # text, files with output
    echo "FAILED: $1"
    shift
    [ $# = 0 ] || tail -n 20 "$@"
    exit 1
}
wait_for() { # seconds, text, command
    local seconds=$1 text=$2
    shift 2
    for _ in $(seq $((seconds * 5))); do
        "$@" && return 0
        sleep 0.2
    done
    squeue -l 2>&1
    fail "$text" ./*.out
}

plain=(bake builtin:cornell --maps light --size 64 --samples 32 --sky 1 -q)
alpenglow "${plain[@]}" --maps-dir alone --adaptive off || fail "the command"
sums() { (cd "$1" && md5sum ./*); }
same() { [ "$(sums alone)" = "$(sums "$1")" ] || fail "$1: other bytes" ./*.out; }
submit() { sbatch --parsable --output=%x-%j.out "$@"; }
state_of() { scontrol show job "$1" 2>/dev/null | grep -o 'JobState=[A-Z]*' | sort -u; }
has_ended() { [ -z "$(squeue -h -j "$1" 2>/dev/null)" ]; }
completes() { # job, name
    wait_for 120 "$2 does not end" has_ended "$1"
    [ "$(state_of "$1")" = JobState=COMPLETED ] || fail "$2: $(state_of "$1")" ./*.out
}

job=$(submit --ntasks=2 "$examples/ranks.sbatch" ranks.kept "${plain[@]}" --maps-dir ranks \
    --adaptive off) || fail "ranks.sbatch is refused"
completes "$job" ranks.sbatch
same ranks

# Shard 2 is left out at first: the merge names it, and runs after it.
job=$(SHARDS=3 submit --array=1,3 "$examples/array.sbatch" shards.kept "${plain[@]}" \
    --maps-dir shards) || fail "array.sbatch is refused"
completes "$job" array.sbatch
alpenglow merge shards.kept -q >merge.out 2>&1 && fail "a merge lacks a shard and ends well"
grep -q -e '--array=2$' merge.out || fail "the merge does not name the shard" merge.out
job=$(SHARDS=3 submit --array=2 "$examples/array.sbatch" shards.kept "${plain[@]}" \
    --maps-dir shards)
merge=$(submit --dependency="afterok:$job" --kill-on-invalid-dep=yes --wrap="alpenglow merge shards.kept -q")
completes "$merge" "the merge"
same shards

# Ranks that are told to stop: 75, queued again, resumed.
large=(bake builtin:cornell --maps light --size 320 --samples 768 --sky 1 -q)
alpenglow "${large[@]}" --maps-dir large || fail "the command"
job=$(submit --ntasks=2 "$examples/ranks.sbatch" stopped.kept "${large[@]}" --maps-dir stopped \
    --checkpoint-every 0.2)
has_tiles() { [ -s stopped.kept/rank-1.tiles ]; }
wait_for 60 "no checkpoint" has_tiles
scancel --signal=USR1 "$job"
completes "$job" "the stopped job"
[ "$(scontrol show job "$job" | grep -o 'Restarts=[0-9]*')" = Restarts=1 ] ||
    fail "the job did not start twice" ./*.out
grep -q "the checkpoint keeps the work" ./*"-$job.out" || fail "no word of the stop" ./*.out
[ "$(sums large)" = "$(sums stopped)" ] || fail "a resumed job wrote other bytes" ./*.out
echo "all is right"
