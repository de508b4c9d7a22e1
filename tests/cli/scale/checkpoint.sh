# SPDX-License-Identifier: MIT
# A checkpoint: another bake in its folder is refused by the option that differs; the same one goes on
# and ends with the bits of an undisturbed bake, and the folder is then free.
bake() { alpenglow bake builtin:cornell --ao-samples 24576 -q --progress off --size 64 "$@"; }
quick() { alpenglow bake builtin:cornell --ao-samples 16 -q --progress off --size 32 "$@"; }
stopped() { timeout --signal=USR1 0.5 alpenglow bake builtin:cornell --ao-samples 24576 -q --progress off --size 64 "$@"; }
bake --maps-dir whole
stopped --maps-dir maps --checkpoint c
ls c maps 2>&1
quick --maps-dir maps --checkpoint c
echo "exit $?"
bake --maps-dir maps --checkpoint c --seed 3
echo "exit $?"
bake --maps-dir maps --checkpoint c --maps bent,light --adaptive off --atlas charts --gather hemicube --direct off
echo "exit $?"
bake --maps-dir maps --checkpoint c --adaptive 0.5
echo "exit $?"
bake --maps-dir maps --checkpoint c --only '*block*'
echo "exit $?"
bake --maps-dir maps --checkpoint c --checkpoint-every 3 --threads 1 --json report.json
echo "exit $?"
cmp whole/ao.exr maps/ao.exr && ls c
quick --maps-dir maps -f --checkpoint c && ls c
