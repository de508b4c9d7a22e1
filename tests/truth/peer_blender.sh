#!/bin/sh
# SPDX-License-Identifier: MIT
# peer_blender.sh COMMAND SHARED: bakes a sphere on a plane with Blender's Cycles and with ours, on the
# same texels, and compares those that both cover. 77 = skipped: no Blender, or no shared folder.
set -eu
command=$1
shared=${ALPENGLOW_SHARED:-$2}
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
# 1,024 samples leave .001 of noise in the reference.
PATH=$system blender -b --factory-startup --python-exit-code 3 --python "$peer/bake_peer.py" -- \
    --scene "$peer/sphere_plane.glb" --type ao --size 256 --samples 1024 --ao-distance 0.2 \
    --uv TEXCOORD_1 --out "$folder/cycles.exr" >"$folder/log" 2>&1 || {
    tail -20 "$folder/log"
    exit 1
}
"$command" bake "$peer/sphere_plane.glb" --maps ao --ao-distance 0.2 --ao-falloff none \
    --atlas keep --size 256 --maps-dir "$folder" --progress off
"$command" compare "$folder/ao.exr" "$folder/cycles.exr" --max-rmse 0.006
