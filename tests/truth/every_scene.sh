#!/bin/sh
# SPDX-License-Identifier: MIT
# every_scene.sh COMMAND SHARED: every good glTF file of the shared scenes is baked at 256, read again
# with as many triangles, and held against the original in the Khronos validator. 77 = skipped.
set -eu
command=$1
shared=${ALPENGLOW_SHARED:-$2}
validator=$(cd "$(dirname "$0")/../validator" && pwd)
if [ ! -d "$shared/scenes" ]; then
    echo "$shared/scenes is absent: skipped (set ALPENGLOW_SHARED)"
    exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failed=0
count_triangles() {
    "$command" info "$1" 2>/dev/null | sed -n 's/^triangles *\([0-9]*\).*/\1/p'
}
find "$shared/scenes/architecture" "$shared/scenes/objects" "$shared/scenes/features" \
    -name '*.gl[bt]*' | sort >"$folder/list"
[ -s "$folder/list" ] || {
    echo "no glTF file below $shared/scenes"
    exit 1
}
while read -r scene; do
    out=$folder/$(basename "$scene")
    if ! "$command" bake "$scene" -o "$out" --size 256 --ao-samples 4 --progress off -q \
        2>"$folder/log"; then
        echo "$scene: not baked"
        cat "$folder/log"
        failed=1
        continue
    fi
    before=$(count_triangles "$scene")
    after=$(count_triangles "$out")
    if [ -z "$before" ] || [ "$before" != "$after" ]; then
        echo "$scene: $before triangles, $after after the bake"
        failed=1
    fi
    if [ -d "$validator/node_modules/gltf-validator" ]; then
        node "$validator/validate.mjs" "$scene" "$out" || failed=1
    fi
    echo "$(basename "$scene"): $after triangles"
done <"$folder/list"
[ -d "$validator/node_modules/gltf-validator" ] || echo "not validated: gltf-validator is absent"
exit $failed
