#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs a command beside a private Slurm of one node with four cores on loopback.
#
#   with_slurm.sh PROGRAMS COMMAND...    PROGRAMS is the folder of alpenglow and alpenglow-mpi
#
# The command sees SLURM_CONF, and the programs in its PATH. All jobs and daemons end with it.
# Exit status: that of the command, 77 skipped, 1 Slurm does not start.
set -uo pipefail
programs=$(cd "$1" && pwd)
shift

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
export PATH=$programs:$PATH:/usr/sbin
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
mkdir "$folder/state" "$folder/spool"
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

ready=no
for _ in $(seq 300); do
    if [ "$(sinfo -h -o %t 2>/dev/null)" = idle ]; then
        ready=yes
        break
    fi
    sleep 0.2
done
[ "$ready" = yes ] || fail "the node does not come up" "$folder"/*.log

"$@"
