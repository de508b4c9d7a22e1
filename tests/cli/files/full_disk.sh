# SPDX-License-Identifier: MIT
# a disk that gets full: the reason is told, what was there stays, and nothing else is left. A limit
# on the size of files stands for the disk; the pipe keeps it from the messages
. "$(dirname "$0")/../scenes.bash"
quick="--size 12 --ao-samples 4 --progress off -q"
room '{"pbrMetallicRoughness":{"metallicFactor":0},"emissiveFactor":[1,1,1]}' '' '' >room.gltf
alpenglow bake room.gltf $quick -o in.glb --maps-dir in
# how many texels there are, and how bright, is not asked here
without_figures() { sed -E '/^(pixels|means)/s/[0-9][0-9.]*/N/g'; }
small() { # KiB, command
    local limit=$1
    shift
    (
        ulimit -f "$limit"
        alpenglow "$@" 2>&1
        echo $?
    ) | without_figures
}
for output in out.glb out.gltf out.obj; do
    small 0 bake room.gltf $quick -o $output --maps-dir maps
    small 1 bake room.gltf $quick -o $output
done
small 0 bake room.gltf $quick --maps-dir maps
small 0 render room.gltf --with albedo --resolution 8x8 -q -o out.png
small 0 compare in/ao.exr in/ao.exr --json out.json
small 0 compare in/ao.exr in/ao.exr --heatmap out.png
small 4 bake room.gltf $quick --maps-dir new --report page.html # the maps fit, the page does not
ls . new
mkdir maps
for name in out.glb out.png out.json maps/ao.exr; do
    echo precious >$name
done
small 1 bake room.gltf $quick -f -o out.glb --maps-dir maps
small 0 render room.gltf -f --with albedo --resolution 8x8 -q -o out.png
small 0 compare -f in/ao.exr in/ao.exr --json out.json
cat out.glb out.png out.json maps/ao.exr
ls . maps
