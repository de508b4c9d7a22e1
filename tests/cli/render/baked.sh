# SPDX-License-Identifier: MIT
# a picture of a bake, from its file
alpenglow bake builtin:sphere-plane --size 64 --ao-samples 64 -q -o baked.glb &&
    alpenglow render baked.glb --with ao --resolution 64x48 --samples 4 -q -o baked.exr &&
    alpenglow render builtin:sphere-plane --with ao --ao-samples 64 --resolution 64x48 --samples 4 -q -o rays.exr &&
    alpenglow compare baked.exr rays.exr --max-rmse 0.15 >/dev/null && echo "like the rays"
