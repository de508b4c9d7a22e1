# SPDX-License-Identifier: MIT
# light goes into the asset: which files there are, what they say of it
bake() {
    alpenglow bake builtin:cornell --size 16 --maps light --samples 16 --threads 2 -q "$@" ||
        echo "failed: $*"
}
bake -o emissive.gltf --lightmap-as emissive
bake -o moz.gltf --lightmap-as moz --units irradiance/pi
bake -o beside.glb --lightmap-as extras
bake -o three.json --lightmap-as three
bake -o babylon.babylon --lightmap-as babylon
bake -o both.gltf --lightmap-as extras --lightmap-format hdr --units radiance --maps ao,light
ls
for name in emissive moz both; do
    grep -o '"\(units\|unit\|as\)":"[^"]*"' $name.gltf | sort -u
    grep -o '"extensionsUsed":[^]]*]' $name.gltf
    grep -o '"[a-z]*Texture":' $name.gltf | sort -u
done
rm beside.glb
alpenglow bake builtin:cornell --size 16 --maps light --lightmap-as extras -o beside.glb 2>&1 |
    grep -o 'beside.*; use -f.*\|beside.*exists.*'
grep -o '"lightMapIntensity":[^,}]*' three.json | sort -u
grep -o '"lightmapTexture":{"name":[^,]*' babylon.babylon | sort -u
bake -o three.json --lightmap-as three 2>&1 | grep -o 'exists.*'
bake -o babylon.json --lightmap-as babylon 2>&1 | grep -o 'babylon.json.*'
