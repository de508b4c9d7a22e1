# SPDX-License-Identifier: MIT
# the scene itself as output: refused without -f, replaced with it, and still a scene
. "$(dirname "$0")/../scenes.bash"
quick="--size 16 --ao-samples 4 --progress off -q"
room '{"pbrMetallicRoughness":{"metallicFactor":0},"emissiveFactor":[1,1,1]}' '' '' >room.gltf
alpenglow bake room.gltf $quick -o a.obj
cp room.gltf a.gltf
alpenglow bake room.gltf $quick -o a.glb
for scene in a.glb a.gltf a.obj; do
    cp $scene before
    alpenglow bake $scene $quick -o $scene; echo $?
    cmp before $scene
    alpenglow bake $scene $quick -o ./$scene -f; echo $?
    alpenglow info -q $scene | head -n 2
done
ls
