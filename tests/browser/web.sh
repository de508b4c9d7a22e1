#!/bin/sh
# SPDX-License-Identifier: MIT
# web.sh ALPENGLOW PAGE: bakes a scene in each form of light, writes pages, opens them from the disk
# and compares pixels with alpenglow render. 77 = skipped.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
. "$here/needs.sh"
need playwright-core
if [ ! -e "$2" ]; then
    echo "the page is not built, three.js is absent: skipped (npm ci in web/viewer)"
    exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
page() { # name, options of the bake
    name=$1
    shift
    "$alpenglow" bake builtin:cornell --size 128 -q -o "$name" "$@"
    "$alpenglow" web "$name" -q -o "$name.html"
}
alpenglow=$1
for form in emissive moz extras; do
    page "$form.glb" --maps ao,light --samples 64 --lightmap-as "$form"
done
page exr.gltf --maps light --samples 64 --lightmap-as extras --lightmap-format exr
page hdr.glb --maps light --samples 64 --lightmap-as extras --lightmap-format hdr
page units.glb --maps light --samples 64 --lightmap-as extras --units irradiance/pi
page radiance.glb --maps light --samples 64 --lightmap-as extras --units radiance
page blend.glb --maps light --samples 64 --lightmap-as moz --atlas blend
page ao.gltf --maps ao
"$alpenglow" bake builtin:cornell --size 128 -q -o layers.glb --samples 64 --lamp 0.3,0.5,0.2,1,0.2,0.4,1 \
    --maps-dir maps --layers --lightmap-as extras --lightmap-format exr
"$alpenglow" web layers.glb -q -o layers.glb.html --maps-dir maps
"$alpenglow" probes builtin:cornell -o cornell.probes.json --spacing 0.2 -q
"$alpenglow" web moz.glb -q -o probes.html --probes cornell.probes.json
cp ao.gltf '<img src=x onerror=alert(1)>.gltf'
"$alpenglow" web '<img src=x onerror=alert(1)>.gltf' -q -o hostile.html
node "$here/web.mjs" "$folder" "$alpenglow"
