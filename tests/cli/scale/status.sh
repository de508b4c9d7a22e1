# SPDX-License-Identifier: MIT
# What status says of a bake that was stopped, of shards, and of a bake that is complete.
without_figures() { sed -E 's/[0-9.]+ s ago/N s ago/; s/after [0-9]+ s/after N s/; s/[0-9]+ %/N %/g'; }
timeout --signal=TERM 1 alpenglow bake builtin:cornell --ao-samples 1048576 --size 64 -q \
    --progress off --maps-dir maps --checkpoint stopped
alpenglow status stopped | without_figures
alpenglow status stopped --json - | sed -E 's/"version": "[^"]*"/"version": V/
    s/("(done|total|seconds|seconds_left|written)": )[0-9.]+/\1N/'
alpenglow status stopped --json status.json | without_figures
json_shape status.json
quick="--ao-samples 16 --size 32 -q --progress off"
for i in 1 3; do
    alpenglow bake builtin:cornell $quick --maps-dir maps --checkpoint shards --shard $i/5
done
alpenglow status shards | without_figures
alpenglow bake builtin:cornell $quick --maps-dir maps --checkpoint complete
alpenglow status complete | without_figures
echo nonsense >complete/rank-1.state
alpenglow status complete | without_figures
