#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Bakes ambient occlusion into the built-in room with a teapot and takes a picture of the result.
#
#   scripts/demo.sh COMMAND FOLDER
set -euo pipefail
command=$1 folder=$2
scene=$folder/teapot-room.glb
picture=$folder/teapot-room.png

run() {
    printf '$ %s\n' "$*"
    "$@"
}

mkdir -p "$folder"
started=$(date +%s%N)
run "$command" bake builtin:teapot-room -o "$scene" --maps ao --maps-dir "$folder" --size 512 -f
baked=$(date +%s%N)
run "$command" render "$scene" --with ao -o "$picture" -f
finished=$(date +%s%N)

seconds() { # from, to: nanoseconds
    printf '%d.%01d s' $((($2 - $1) / 1000000000)) $((($2 - $1) / 100000000 % 10))
}
for file in "$scene" "$folder/ao.exr" "$folder/ao.png" "$picture"; do
    [ -s "$file" ] || { echo "demo: $file was not written" >&2; exit 1; }
done
printf '\n'
printf '%-24s the scene with its occlusion map, for any glTF viewer\n' "$scene"
printf '%-24s the map alone: 32-bit float, and 8-bit to look at\n' "$folder/ao.exr, ao.png"
printf '%-24s a picture rendered from it\n' "$picture"
printf 'Baked in %s, rendered in %s.\n' "$(seconds "$started" "$baked")" "$(seconds "$baked" "$finished")"
