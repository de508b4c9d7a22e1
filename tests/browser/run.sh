#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh PROGRAM ALPENGLOW BLEND: lets them write scenes with their maps, opens those in a browser
# and compares pixels. 77 = skipped.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
for tool in node "${CHROMIUM:-chromium}"; do
    if ! command -v "$tool" >/dev/null; then
        echo "$tool is absent: skipped"
        exit 77
    fi
done
for package in three babylonjs playwright-core; do
    if [ ! -d "$here/node_modules/$package" ]; then
        echo "the npm package $package is absent: skipped (npm ci in tests/browser)"
        exit 77
    fi
done
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
