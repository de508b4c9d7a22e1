# SPDX-License-Identifier: MIT
# animations and their lengths; a pose has other bounds
. "$(dirname "$0")/../scenes.bash"
slide >slide.gltf
alpenglow info slide.gltf | grep -E '^(bounds|animation)'
alpenglow info slide.gltf --animation-time 2 --animation slide | grep bounds
alpenglow info slide.gltf --json | grep -A 12 '"animations"'
sed 's/"path":"rotation"/"path":"pointer"/' slide.gltf >pointer.gltf
alpenglow info pointer.gltf 2>&1 | grep animation
alpenglow info pointer.gltf --animation-time 1 --animation turn 2>&1 | grep "\[animation"
echo "== refused"
alpenglow info slide.gltf --animation-time 1 --animation 2
echo "exit $?"
alpenglow info builtin:cornell --animation-time 1
echo "exit $?"
alpenglow bake slide.gltf -o out.glb --animation turn
echo "exit $?"
alpenglow render slide.gltf --with albedo -o out.png --animation none
echo "exit $?"
echo "== a bake knows the pose"
bake="alpenglow bake slide.gltf --maps ao --size 32 --ao-samples 16 -q"
$bake --maps-dir rest && $bake --maps-dir begin --animation-time 0 && $bake --maps-dir end --animation-time 2
cmp -s rest/*ao.png begin/*ao.png && echo "the file has the pose of the beginning"
cmp -s rest/*ao.png end/*ao.png || echo "the end is another"
