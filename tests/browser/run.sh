#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh PROGRAM ALPENGLOW BLEND: lets them write scenes with their maps, opens those in a browser
# and compares pixels. 77 = skipped.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
. "$here/needs.sh"
need three babylonjs playwright-core
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1" "$folder"
command=$2
bake() { # file, form of the light
    "$command" bake builtin:cornell --size 64 --maps light --samples 256 -q \
        -o "$folder/$1" --lightmap-as "$2"
}
bake command.json three
cmp "$folder/command.json" "$folder/cornell.json" # the bake whose pixels are known
bake cornell.babylon babylon
bake cornell.glb emissive
node "$here/compare.mjs" "$folder"
"$3" "$folder"
node "$here/blend.mjs" "$folder"
