#!/bin/sh
# SPDX-License-Identifier: MIT
# peer_blender.sh COMMAND SHARED COMPARE_PEER: bakes with Blender's Cycles and with ours, on the
# same texels, and compares those that both cover: the occlusion of a sphere on a plane, its light
# under a lamp and a coloured sky, and the light of walls with a picture. 77 = skipped: no Blender,
# or no shared folder.
set -eu
command=$1
shared=${ALPENGLOW_SHARED:-$2}
compare=$3
peer=$shared/peers/blender
if [ ! -x /usr/bin/blender ]; then
    echo "blender is absent: skipped (apt-get install blender python3-numpy)"
    exit 77
fi
# Blender takes the Python it finds first: the system's is the one that has numpy.
system=/usr/bin:/bin
if ! PATH=$system blender -b --factory-startup --python-exit-code 3 --python-expr "import numpy" >/dev/null 2>&1; then
    echo "Blender's Python has no numpy: skipped (apt-get install python3-numpy)"
    exit 77
fi
if [ ! -r "$peer/bake_peer.py" ]; then
    echo "$peer is absent: skipped (set ALPENGLOW_SHARED)"
    exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# cycles SCENE OUT OPTION...
cycles() {
    scene=$1 out=$2
    shift 2
    PATH=$system blender -b --factory-startup --python-exit-code 3 \
        --python "$peer/bake_peer.py" -- \
        --scene "$scene" --uv TEXCOORD_1 --out "$out" "$@" >"$folder/log" 2>&1 || {
        tail -20 "$folder/log"
        exit 1
    }
}

# 1,024 samples leave .001 of noise in the reference.
cycles "$peer/sphere_plane.glb" "$folder/cycles.exr" --type ao --size 256 --samples 1024 \
    --ao-distance 0.2
"$command" bake "$peer/sphere_plane.glb" --maps ao --ao-distance 0.2 --ao-falloff none \
    --atlas keep --size 256 --maps-dir "$folder" --progress off
"$command" compare "$folder/ao.exr" "$folder/cycles.exr" --max-rmse 0.006

# light NAME SCENE SKY: Cycles gives E/pi. What it and we leave of noise, two seeds of each tell.
# The mean within .5 % in each channel, and 1 % between texels less the noise: up to 2.6 % and 2.2 %
# in 10,192 texels, whose square is thereby known to (.4 %)^2. The script there knows no sky but one
# of a single colour, and reads pictures that name TEXCOORD_0 through the set it bakes to.
failed=0
light() {
    for seed in 1 2; do
        cycles "$2" "$folder/$1.$seed.exr" --type diffuse --size 128 --samples 128 --bounces 8 \
            --world "$3" --seed $seed
        "$command" bake "$2" --maps light --gather paths --bounces 8 --samples 128 --atlas keep --size 128 \
            --sky "$3" --seed $seed --maps-dir "$folder/$1.$seed" --progress off -q
    done
    printf '%s: ' "$1"
    "$compare" "$folder/$1.1/irradiance.exr" "$folder/$1.2/irradiance.exr" \
        "$folder/$1.1.exr" "$folder/$1.2.exr" 0.318309886 0.005 0.01 || failed=1
}

light sky "$peer/sphere_plane.glb" 0.5,0.7,1
if command -v python3 >/dev/null; then
    python3 "$(dirname "$0")/textured_room.py" "$folder/room.glb"
    light picture "$folder/room.glb" 0.6,0.8,1
else
    echo "python3 is absent: the walls with a picture are left out"
fi
exit $failed
