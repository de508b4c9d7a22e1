# SPDX-License-Identifier: MIT
# files that the scene refers to are never overwritten, even by -f; those of an earlier bake are
. "$(dirname "$0")/../scenes.bash"
quick="--size 16 --ao-samples 4 --progress off -q"
room '{"pbrMetallicRoughness":{"metallicFactor":0},"emissiveFactor":[1,1,1]}' '' '' >room.gltf
alpenglow bake room.gltf $quick -o plain.obj
# A scene of somebody: no mark of a bake, a library and a picture with names of outputs.
sed '/^#/d; s/plain.mtl/wall.mtl/' plain.obj >wall.obj
sed '/^#/d; s/plain.ao.png/wall.ao.png/; s/map_Ka/map_Kd/' plain.mtl >wall.mtl
cp plain.ao.png wall.ao.png
cp wall.obj other.obj
cksum wall.* >before
try() {
    echo "$*"
    alpenglow "$@"
    echo $?
}
try bake other.obj $quick -f -o wall.obj
try bake wall.obj $quick -f -o wall.obj
try bake other.obj $quick -f -o wall.gltf
sed 's/wall.ao.png/ao.png/' wall.mtl >small.mtl
sed 's/wall.mtl/small.mtl/' wall.obj >small.obj
cp wall.ao.png ao.png
try bake small.obj $quick -f --maps-dir .
try bake small.obj $quick -f -o fine.glb --json small.mtl
try render small.obj --with albedo --resolution 8x8 -q -f ao.png
cksum wall.* ao.png | grep -v gltf | sort >after
cksum wall.ao.png | sed 's/wall.ao/ao/' | cat before - | sort | diff - after && echo "all stayed"
echo "== an earlier bake's"
try bake other.obj $quick -o fine.obj
try bake other.obj $quick -f -o fine.obj
try bake fine.obj $quick -f -o fine.obj
try bake room.gltf $quick -o glt.gltf
try bake glt.gltf $quick -f -o ./glt.gltf
ls
