# SPDX-License-Identifier: MIT
# A checkpoint that is damaged: a warning, and the bits of an undisturbed bake.
bake() { alpenglow bake builtin:cornell --ao-samples 24576 -q --progress off --size 64 "$@"; }
bake --maps-dir whole
timeout --signal=TERM 0.5 alpenglow bake builtin:cornell --ao-samples 24576 -q --progress off --size 64 \
    --maps-dir maps --checkpoint c
size=$(stat -c %s c/bake.tiles)
truncate -s $((size - 100)) c/bake.tiles
echo nonsense >>c/bake.state
cp c/bake.state c/bake.state.old
alpenglow status c
echo "exit $?"
bake --maps-dir maps --checkpoint c
cmp whole/ao.exr maps/ao.exr && ls c
