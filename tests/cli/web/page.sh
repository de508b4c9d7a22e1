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
grep -o '<script type="application/json".*' page.html
grep -c '<script type="application/base64" class="asset">' page.html
[ "$(grep -o 'class="file">[^<]*' page.html | head -1 | cut -d'>' -f2)" = "$(base64 -w0 baked.bin)" ] && echo 'the same bytes'
echo '== outside'
mkdir in && echo secret >secret.png
sed 's/"baked.ao.png"/"..\/secret.png"/; s/"baked/"..\/baked/' baked.gltf >in/out.gltf
ln -s ../secret.png in/link.png
cp baked.bin baked.ao.bin in
sed 's/baked.ao.png/link.png/' baked.gltf >in/link.gltf
for scene in out link; do
    alpenglow web in/$scene.gltf -q -o $scene.html 2>&1
    [ -e $scene.html ] && grep -c "$(base64 -w0 secret.png)" $scene.html
done
echo '== no maps'
echo '{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
"bufferViews": [{"buffer": 0, "byteLength": 36}],
"buffers": [{"byteLength": 36, "uri": "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}' >plain.gltf
alpenglow web plain.gltf -o plain.html 2>&1 | sed 's/[0-9.]* MB/N MB/g'
alpenglow web plain.gltf -q -f plain.html 2>&1
echo '== faults'
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
