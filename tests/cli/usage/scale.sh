# SPDX-License-Identifier: MIT
# --checkpoint, --shard, merge and status: what they refuse before anything is baked
. "$(dirname "$0")/helpers.bash"
unset SLURM_ARRAY_TASK_ID
bake() { try bake builtin:cornell --maps-dir maps "$@"; }
bake --checkpoint-every 5
bake --checkpoint c --checkpoint-every 0
bake --checkpoint c --checkpoint-every 86401
bake --checkpoint c --time-limit 5
bake --checkpoint c --keep-partial
bake --shard 1/5
for shard in 0/5 6/5 5 /5 1/ 1/0 -1/5 1.5/5 1/65537 1/5/5 slurm/ slurm/0 slurm/5; do
    bake --checkpoint c --shard $shard
done
SLURM_ARRAY_TASK_ID=6 bake --checkpoint c --shard slurm/5
SLURM_ARRAY_TASK_ID=x bake --checkpoint c --shard slurm/5
bake --checkpoint c --shard 1/5 --error 1
bake --checkpoint c --shard 1/5 --maps light --error 1
bake --checkpoint c --shard 1/5 --maps light
bake --checkpoint c --shard 1/5 --adaptive auto
bake --checkpoint c --shard 1/5 --only $'\xff' | tr '\377' '?'
try merge
try merge missing
try merge missing -o out.glb
for name in out.png maps.v2 .glb. out.probes; do
    try merge missing -o $name
done
try status
try status missing
mkdir empty
try status empty
try merge empty
mkdir bad
echo nonsense >bad/bake.state
try status bad
ls
