#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The job scripts of examples/slurm on a Slurm of one node on loopback: the same bytes as the command,
# a job that is told to stop and queued again, and shards that are missing.
#
#   slurm_jobs.sh FOLDER EXAMPLES    the folders of alpenglow and alpenglow-mpi, and of the scripts
#
# Exit status: 0 all is right, 77 skipped, 1 a fault.
set -uo pipefail
programs=$1 examples=$2

skip() {
    echo "skipped: $1" >&2
    exit 77
}
[ "$(id -u)" = 0 ] || skip "not root: a private Slurm needs it"
for program in munged slurmctld slurmd sbatch srun scontrol mpirun; do
    PATH=$PATH:/usr/sbin command -v "$program" >/dev/null 2>&1 ||
        skip "there is no $program (scripts/setup.sh cluster)"
done
[ -x "$programs/alpenglow-mpi" ] || skip "alpenglow-mpi is not built (scripts/setup.sh cluster)"

folder=$(mktemp -d)
export SLURM_CONF=$folder/slurm.conf PATH=$programs:$PATH:/usr/sbin
# Slurm gives jobs the name of this job's folder and node, where this test runs in a job.
unset "${!SLURM_@}" 2>/dev/null
export SLURM_CONF=$folder/slurm.conf

stop() { # the process of a pid file
    local pid
    [ -s "$1" ] || return 0
    pid=$(cat "$1")
    kill "$pid" 2>/dev/null || return 0
    for _ in $(seq 50); do
        kill -0 "$pid" 2>/dev/null || return 0
        sleep 0.1
    done
    kill -9 "$pid" 2>/dev/null
}
finish() {
    if [ -s "$folder/slurmctld.pid" ]; then
        scancel --user=root >/dev/null 2>&1
        for _ in $(seq 50); do
            [ -n "$(squeue -h 2>/dev/null)" ] || break
            sleep 0.2
        done
    fi
    stop "$folder/slurmd.pid"
    stop "$folder/slurmctld.pid"
    stop "$folder/munged.pid"
    rm -rf "$folder"
}
trap finish EXIT

fail() { # text, files with output
    echo "FAILED: $1"
    shift
    [ $# = 0 ] || tail -n 20 "$@"
    exit 1
}

# --- a Slurm of one node -------------------------------------------------------------------------
free_ports() {
    python3 -c 'import socket
s = [socket.socket() for _ in range(2)]
[x.bind(("127.0.0.1", 0)) for x in s]
print(*[x.getsockname()[1] for x in s])'
}
read -r port_ctld port_d <<<"$(free_ports)"
node=$(hostname -s)
mkdir "$folder/state" "$folder/spool" "$folder/work"
(umask 077 && head -c 1024 /dev/urandom >"$folder/munge.key")
cat >"$SLURM_CONF" <<CONF
ClusterName=loopback
SlurmctldHost=$node(127.0.0.1)
SlurmctldPort=$port_ctld
SlurmdPort=$port_d
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
# A job that is queued again waits for cred_expire seconds.
AuthInfo=socket=$folder/munge.socket,cred_expire=2
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=1,batch_sched_delay=0
ReturnToService=2
NodeName=$node NodeAddr=127.0.0.1 CPUs=4 State=UNKNOWN
PartitionName=all Nodes=$node Default=YES MaxTime=INFINITE State=UP
CONF
munged --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" \
    --pid-file="$folder/munged.pid" --log-file="$folder/munged.log" \
    --seed-file="$folder/munged.seed" >"$folder/out" 2>&1 || fail "munged" "$folder/out"
slurmctld >"$folder/out" 2>&1 || fail "slurmctld" "$folder/out"
slurmd -N "$node" >"$folder/out" 2>&1 || fail "slurmd" "$folder/out"

wait_for() { # seconds, text, command
    local seconds=$1 text=$2
    shift 2
    for _ in $(seq $((seconds * 5))); do
        "$@" && return 0
        sleep 0.2
    done
    squeue -l 2>&1
    fail "$text" "$folder"/*.log "$folder"/work/*.out
}
is_idle() { [ "$(sinfo -h -o %t 2>/dev/null)" = idle ]; }
wait_for 60 "the node does not come up" is_idle

# --- jobs ----------------------------------------------------------------------------------------
cd "$folder/work" || exit 1
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
