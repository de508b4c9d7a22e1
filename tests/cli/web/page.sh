# SPDX-License-Identifier: MIT
# A page holds its scene and the files that this names; names cannot end a script element, and files
# outside of the folder stay out. A scene that cannot be read leaves no page.
. "$(dirname "$0")/../usage/helpers.bash"
if ! alpenglow bake builtin:cornell --size 16 -q -o baked.gltf || ! alpenglow web baked.gltf -o probe.html >probe.txt 2>&1; then
    if grep -q 'built without' probe.txt; then
        echo "the page is not built, three.js is absent" >&2
        exit 77
    fi
fi
sed 's/, .*//; s/[0-9.]* MB/N MB/' probe.txt
rm probe.*
echo '== files'
cp baked.gltf '<script>.gltf'
alpenglow web '<script>.gltf' -q -o page.html
grep -o '<script type="application/json".*' page.html | sed 's/"camera": {[^}]*}, //'
grep -c '<script type="application/base64" class="asset">' page.html
[ "$(grep -o 'class="file">[^<]*' page.html | head -1 | cut -d'>' -f2)" = "$(base64 -w0 baked.bin)" ] && echo 'the same bytes'
echo '== outside'
mkdir in && echo secret >secret.png
sed 's/"baked.ao.png"/"..\/secret.png"/; s/"baked/"..\/baked/' baked.gltf >in/out.gltf
ln -s ../secret.png in/link.png
cp baked.bin baked.bake.bin in
sed 's/baked.ao.png/link.png/' baked.gltf >in/link.gltf
for scene in out link; do
    alpenglow web in/$scene.gltf -q -o $scene.html 2>&1
    [ -e $scene.html ] && grep -c "$(base64 -w0 secret.png)" $scene.html
done
sed 's/baked.ao.png/https:\/\/host.invalid\/a.png/' baked.gltf >remote.gltf
alpenglow web remote.gltf -q -o remote.html 2>&1
echo '== no maps'
echo '{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
"bufferViews": [{"buffer": 0, "byteLength": 36}],
"buffers": [{"byteLength": 36, "uri": "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}' >plain.gltf
alpenglow web plain.gltf -o plain.html 2>&1 | sed 's/[0-9.]* MB/N MB/g'
alpenglow web plain.gltf -q -f plain.html 2>&1
echo '== pages of an atlas'
bake="alpenglow bake builtin:cornell --maps light --samples 16 --size 64 --layers -q --lightmap-as moz"
$bake --texels-per-metre 60 -o pages.glb --maps-dir pages
alpenglow web pages.glb -q -o pages.html --maps-dir pages
grep -o '"layers".*' pages.html
grep -c 'class="layer"' pages.html
alpenglow bake builtin:cornell --maps light --samples 16 --size 64 --layers -q -o lamp.glb --lightmap-as moz \
    --texels-per-metre 60 --lamp 0.27,0.3,0.1,2,2,2,1 --maps-dir lamp
try web pages.glb -f -o pages.html --maps-dir lamp | sed "s/[0-9.]* W.m2, the light of the scene [0-9.]*/N W\/m2, the light of the scene N/"
echo '== light in space'
alpenglow lpv builtin:cornell --grid 4 --frames 1 -q --volume box.lpv.json
alpenglow web pages.glb -q -o volume.html --volume box.lpv.json
grep -o '"volume": .*' volume.html
grep 'class="volume"' volume.html | sed 's/[^>]*>\([^<]*\)<.*/\1/' | base64 -d | wc -c
sed 's/"hash":"./"hash":"x/' box.lpv.json >other.lpv.json
try web pages.glb -o volume.html -f --volume other.lpv.json
sed 's/"corner":\[/"corner":[1/' box.lpv.json | sed 's/1-/1/' >far.lpv.json
sed 's/"version":1/"version":2/' box.lpv.json >newer.lpv.json
sed 's/"size":\[4/"size":[5/' box.lpv.json >short.lpv.json
sed '9s/^[^,]*,/-1,/' box.lpv.json >negative.lpv.json
alpenglow probes builtin:cornell -o box.probes.json --spacing 0.4 -q
sed 's/"origin":\[/"origin":[7/' box.probes.json >far.probes.json
for file in far newer short negative missing; do
    try web pages.glb -o fault.html --volume $file.lpv.json
done
try web pages.glb -o fault.html --volume pages.glb
try web pages.glb -o fault.html --probes far.probes.json
echo '== faults'
rm 'pages/irradiance.lamp.1.exr'
try web pages.glb -o fault.html --maps-dir pages
$bake -f --size 32 -o small.glb --maps-dir small
$bake -f -o single.glb --maps-dir single
try web single.glb -o fault.html --maps-dir small
truncate -s 401M single/irradiance.lamp.exr
try web single.glb -o fault.html --maps-dir single
echo text >single/irradiance.lamp.exr
try web single.glb -o fault.html --maps-dir single
alpenglow bake builtin:cornell --size 16 -q -o baked.glb
head -c 300 baked.glb >cut.glb
echo '{"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_texture_basisu"]}' >basis.gltf
try web missing.glb -o fault.html
try web cut.glb -o fault.html
try web basis.gltf -o fault.html
mkdir empty
try web baked.glb -o fault.html --maps-dir maps
alpenglow bake builtin:cornell --maps light --samples 16 --size 16 -q -o moz.glb --lightmap-as moz --maps-dir maps
try web moz.glb -o fault.html --maps-dir missing
try web moz.glb -o fault.html --maps-dir empty
try web moz.glb -o fault.html --maps-dir maps
mv maps/irradiance.exr 'maps/irradiance.<b>.exr'
alpenglow web moz.glb -q -o layers.html --maps-dir maps
grep -o '"layers".*' layers.html
alpenglow probes builtin:cornell -o cube.probes.json --spacing 0.3 --basis ambient-cube -q
try web moz.glb -o fault.html --probes cube.probes.json
try web moz.glb -o fault.html --probes missing.probes.json
rm cube.probes.ktx2
try web moz.glb -o fault.html --probes cube.probes.json
ls fault.html 2>&1
