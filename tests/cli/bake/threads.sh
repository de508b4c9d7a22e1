# SPDX-License-Identifier: MIT
# the number of threads never changes a bit of the result
for threads in 1 2 7; do
    alpenglow bake builtin:sphere-plane --size 48 --ao-samples 32 --threads $threads -q \
        --maps-dir maps$threads -o out$threads.glb || exit
done
cmp maps1/ao.exr maps2/ao.exr && cmp maps1/ao.exr maps7/ao.exr && echo "same maps"
cmp out1.glb out2.glb && cmp out1.glb out7.glb && echo "same assets"
alpenglow bake builtin:sphere-plane --size 48 --ao-samples 32 --seed 1 -q --maps-dir seed1
cmp -s maps1/ao.exr seed1/ao.exr || echo "another seed, another noise"
