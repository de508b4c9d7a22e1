# SPDX-License-Identifier: MIT
# a link stays and what it names is written, there or not; a loop is told before the work
. "$(dirname "$0")/../scenes.bash"
quick="--size 16 --ao-samples 4 --progress off -q"
room '{"pbrMetallicRoughness":{"metallicFactor":0},"emissiveFactor":[1,1,1]}' '' '' >room.gltf
alpenglow bake room.gltf $quick -o good.glb
mkdir far far/maps
echo precious >far/old.glb
ln -s far/old.glb old.glb
ln -s far/new.glb new.glb
ln -s ../new.glb far/chain.glb
ln -s missing/new.glb nowhere.glb
ln -s loop.glb loop.glb
ln -s far folder.glb
ln -s far/maps maps
ln -s far/r.json r.json
ln -s loop.json loop.json
ln -s far/p.html p.html
alpenglow bake room.gltf $quick -o old.glb; echo $?
cat far/old.glb
alpenglow bake room.gltf $quick -o old.glb -f; echo $?
alpenglow bake room.gltf $quick -o far/chain.glb --maps-dir maps --json r.json --report p.html; echo $?
alpenglow bake room.gltf $quick -o nowhere.glb; echo $?
alpenglow bake room.gltf $quick -o loop.glb; echo $?
alpenglow bake room.gltf $quick -o loop.glb -f; echo $?
alpenglow bake room.gltf $quick -o folder.glb -f; echo $?
alpenglow bake room.gltf $quick --maps-dir maps -f; echo $?
alpenglow bake room.gltf $quick -o x.glb --json loop.json -f; echo $?
cmp good.glb far/old.glb && cmp good.glb far/new.glb
alpenglow info loop.glb; echo $?
alpenglow info folder.glb; echo $?
alpenglow compare loop.glb loop.glb; echo $?
find . -type l | sort
ls far far/maps
