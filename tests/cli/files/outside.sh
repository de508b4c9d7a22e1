# SPDX-License-Identifier: MIT
# an asset reads below its own folder alone, unless it is allowed more
. "$(dirname "$0")/../scenes.bash"
quick="--size 16 --ao-samples 4 --progress off -q"
mkdir asset other
room '{"pbrMetallicRoughness":{"metallicFactor":0},"emissiveFactor":[1,1,1]}' '' '' >whole.gltf
alpenglow bake whole.gltf $quick -o other/room.gltf
for name in ../other/room.bake.bin ..%2fother%2froom.bake.bin "$PWD/other/room.bake.bin" "file://$PWD/other/room.bake.bin"; do
    sed "s|\"uri\":\"room.bake.bin\"|\"uri\":\"$name\"|; s|\"uri\":\"room.ao.png\"|\"uri\":\"../other/room.ao.png\"|" other/room.gltf >asset/room.gltf
    for command in "info -q" "render -q --with albedo --resolution 8x8 -f -o out.png" "bake $quick -f -o out.glb"; do
        alpenglow ${command%% *} asset/room.gltf ${command#* } 2>&1 >/dev/null | sed "s|$PWD|HERE|g"
        alpenglow ${command%% *} asset/room.gltf ${command#* } --allow-outside 2>&1 >/dev/null | sed "s|$PWD|HERE|g"
    done
done
ls . asset other
