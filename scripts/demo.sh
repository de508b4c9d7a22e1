#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Bakes occlusion and light into the built-in room with a teapot, and renders the baked file.
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
run "$command" bake builtin:teapot-room -o "$scene" --maps ao,light --lightmap-as emissive \
    --maps-dir "$folder" --size 512 -f
baked=$(date +%s%N)
# The baked light is emission: without bounces the picture holds that light and nothing else.
run "$command" render "$scene" --with reference --bounces 0 -o "$picture" -f
finished=$(date +%s%N)

seconds() { # from, to: nanoseconds
    printf '%d.%01d s' $((($2 - $1) / 1000000000)) $((($2 - $1) / 100000000 % 10))
}
for file in "$scene" "$folder"/{ao.exr,ao.png,irradiance.exr,irradiance.error.exr} "$picture"; do
    [ -s "$file" ] || { echo "demo: $file was not written" >&2; exit 1; }
done
printf '\n'
printf '%-26s the scene with both maps, for any glTF viewer\n' "$scene"
printf '%-26s occlusion: 32-bit float, and 8-bit to view\n' "$folder/ao.exr, ao.png"
printf '%-26s light: irradiance in W/m2, 32-bit float\n' "$folder/irradiance.exr"
printf '%-26s standard error of each texel\n' "$folder/*.error.exr"
printf '%-26s picture of all light in the baked scene\n' "$picture"
printf 'Baked in %s, rendered in %s.\n' "$(seconds "$started" "$baked")" "$(seconds "$baked" "$finished")"
