# SPDX-License-Identifier: MIT
# nothing is overwritten without -f, and -f overwrites
quick="--size 16 --ao-samples 4 --progress off -q"
for name in out.glb out.png out.json out.html maps/ao.exr; do
    mkdir -p maps
    echo precious >$name
done
alpenglow bake builtin:sphere-plane $quick -o out.glb; echo $?
alpenglow bake builtin:sphere-plane $quick --maps-dir maps; echo $?
alpenglow bake builtin:sphere-plane $quick -o new.glb --json out.json; echo $?
alpenglow bake builtin:sphere-plane $quick -o new.glb --report out.html; echo $?
alpenglow render builtin:sphere-plane --with albedo --resolution 8x8 -q -o out.png; echo $?
cat out.glb out.png out.json out.html maps/ao.exr
ls . maps
alpenglow bake builtin:sphere-plane $quick -o out.glb --maps-dir maps --json out.json --report out.html -f; echo $?
alpenglow render builtin:sphere-plane --with albedo --resolution 8x8 -q -o out.png --force; echo $?
grep -l precious out.glb out.png out.json out.html maps/ao.exr
ls . maps
echo "== before the scene is read"
alpenglow bake absent.glb -o out.glb; echo $?
echo "== SCENE.baked.glb"
alpenglow bake builtin:sphere-plane $quick -o scene.baked.glb
alpenglow bake scene.baked.glb $quick; echo $?
mkdir below
(cd below && alpenglow bake ../scene.baked.glb $quick; echo $?; ls)
