# SPDX-License-Identifier: MIT
# any name that the system takes; a message has no control characters of it
. "$(dirname "$0")/../scenes.bash"
quick="--size 16 --ao-samples 4 --progress off -q"
mkdir "a folder" ./-maps
room '{"pbrMetallicRoughness":{"metallicFactor":0},"emissiveFactor":[1,1,1]}' '' '' >room.gltf
alpenglow bake room.gltf $quick -o good.glb
many=$(printf 'n%.0s' {1..251})
try() {
    cp room.gltf "./$1.gltf" && alpenglow bake $quick --maps-dir=-maps -f -o "$1.glb" -- "$1.gltf" &&
        cmp good.glb "./$1.glb" && alpenglow info -q -- "$1.glb" | head -n 1
    rm -f ./"$1".gltf ./"$1".glb
}
try "with  two spaces"
try "Größe 大きさ 🌅"
try "100%d %s%n%2f"
try "two
lines"
try "-o"
try "a folder/../a folder/b"
try '"quoted" '"'too'"' $HOME `x` *'
try "back\\slash"
try "${many::250}" # with .gltf 255 bytes
# beside a name as long as that no other fits, which is told before the work
alpenglow bake room.gltf --ao-samples 1048576 --progress off -q -o "${many::250}.gltf" 2>&1 | cut -c 200-400
alpenglow bake room.gltf --ao-samples 1048576 --progress off -q -o "$many.glb.glb" 2>&1 | cut -c 200-400
alpenglow bake room.gltf --ao-samples 1048576 --progress off -q -o x.glb --json "$many.json" 2>&1 | cut -c 200-400
# pictures beside it are named so that viewers find them
alpenglow bake room.gltf $quick -o "a folder/50% größer #1.gltf"; echo $?
grep -o '"uri":"[^d][^"]*"' "a folder/50% größer #1.gltf"
alpenglow info -q "a folder/50% größer #1.gltf" | head -n 1
# an .obj has no escapes: names that it cannot hold are refused
for name in "a b #1" ä "two
lines" "back\\slash" " blank"; do
    alpenglow bake room.gltf $quick -o "$name.obj" && alpenglow info -q "$name.obj" | sed -n '1p;/materials/p'
done
ls . "a folder" ./-maps
