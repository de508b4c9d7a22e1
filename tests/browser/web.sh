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
layers() { # name, options of the bake
    name=$1
    shift
    "$alpenglow" bake builtin:cornell --size 128 -q -o "$name.glb" --samples 64 \
        --lamp 0.3,0.5,0.2,1,0.2,0.4,1 --maps-dir "$name" --layers "$@"
    "$alpenglow" web "$name.glb" -q -o "$name.glb.html" --maps-dir "$name"
}
layers layers --lightmap-as extras --lightmap-format exr
layers pages --lightmap-as extras --lightmap-format exr --texels-per-metre 90
layers twin --lightmap-as extras --lightmap-format exr --texels-per-metre 90
layers moz8 --lightmap-as moz --texels-per-metre 90
"$alpenglow" bake builtin:cornell --size 128 -q -o other.glb --maps light --maps-dir other --layers
"$alpenglow" web layers.glb -q -o other.html --maps-dir other
layers bright --lightmap-as extras --lightmap-format exr --lamp 0.2,0.3,0.3,4e5,1,0.8,0.5
"$alpenglow" web layers.glb -q -o far_apart.html --maps-dir bright
"$alpenglow" probes builtin:cornell -o cornell.probes.json --spacing 0.2 -q
"$alpenglow" web moz.glb -q -o probes.html --probes cornell.probes.json
"$alpenglow" lpv builtin:cornell --grid 16 --frames 1 --volume cornell.lpv.json -q
"$alpenglow" lpv builtin:cornell --grid 8 --cascades 2 --frames 1 --volume grids.lpv.json -q
"$alpenglow" web moz.glb -q -o slices.html --volume cornell.lpv.json
node -e "const fs = require('fs');
const volume = JSON.parse(fs.readFileSync('cornell.lpv.json'));
for (const grid of volume.grids) grid.fluence = grid.fluence.map((f) => 1e4 * f);
fs.writeFileSync('sun.lpv.json', JSON.stringify(volume));"
"$alpenglow" web moz.glb -q -o sun.html --volume sun.lpv.json
"$alpenglow" web moz.glb -q -o grids.html --volume grids.lpv.json
"$alpenglow" bake builtin:cornell --size 16 -q -o small.glb --report report.html
"$alpenglow" web small.glb -q -o 'the page #1 & 100 %.html' --report report.html
cp ao.gltf '<img src=x onerror=alert(1)>.gltf'
"$alpenglow" web '<img src=x onerror=alert(1)>.gltf' -q -o hostile.html
sed 's/^import/nonsense/' ao.gltf.html >broken.html
node - <<'END' # the same scene 2^19 m away: floats there are 6 cm apart
const fs = require('fs');
const scene = JSON.parse(fs.readFileSync('ao.gltf'));
fs.writeFileSync('near.gltf', JSON.stringify(scene));
scene.nodes.push({ translation: [0, 0, 524288], children: scene.scenes[0].nodes });
scene.scenes[0].nodes = [scene.nodes.length - 1];
fs.writeFileSync('far.gltf', JSON.stringify(scene));
const bare = JSON.parse(fs.readFileSync('ao.gltf')); // no camera, and boxes without a material
delete bare.cameras;
for (const node of bare.nodes) delete node.camera;
for (const mesh of bare.meshes.slice(5, 7)) for (const primitive of mesh.primitives) delete primitive.material;
fs.writeFileSync('bare.gltf', JSON.stringify(bare));
END
"$alpenglow" bake bare.gltf --size 128 -q -o bare.glb --maps light --samples 64 --lightmap-as extras
"$alpenglow" web bare.glb -q -o bare.glb.html
for place in near far; do
    "$alpenglow" bake $place.gltf --size 64 -q -o $place.glb --maps light --samples 16
    "$alpenglow" probes $place.gltf -o $place.probes.json --spacing 0.2 -q
    "$alpenglow" lpv $place.gltf --grid 16 --frames 1 --volume $place.lpv.json -q
    "$alpenglow" web $place.glb -q -o $place.html --probes $place.probes.json --volume $place.lpv.json
done
node "$here/web.mjs" "$folder" "$alpenglow"
