# SPDX-License-Identifier: MIT
# A picture beside the scene is part of the bake: a checkpoint of another picture is refused.
alpenglow bake builtin:cornell lit.gltf --maps light --size 32 --samples 16 -q --progress off
bake=(alpenglow bake lit.gltf --maps light --samples 65536 --size 128 -q --progress off)
timeout --signal=TERM 1 "${bake[@]}" --maps-dir maps --checkpoint work
echo "exit $?"
alpenglow render builtin:bowl --with albedo -o other.png --resolution 32x32 -q --progress off
cp other.png lit.light.png
"${bake[@]}" --maps-dir maps --checkpoint work 2>stderr
echo "exit $?"
sed -E 's/[0-9a-f]{16}/HASH/g' stderr
