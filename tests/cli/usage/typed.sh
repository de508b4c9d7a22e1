# SPDX-License-Identifier: MIT
# what people type first: understood, or answered with the right words; here the scene is missing
. "$(dirname "$0")/helpers.bash"
try
try scene.glb
try models/scene.obj --size 64
try bake scene.glb
try bake scene.glb out.glb
try bake scene.glb out.glb -f
try bake scene.glb out.png
try bake scene.glb out.glb -o other.glb
try bake scene.glb out.glb other.glb
try bake scene.glb ''
try render scene.glb out.png --with ao
for word in lightmap lightmaps occlusion AO ao,lightmap ligth normal; do
    try bake scene.glb --maps $word
done
for size in 1k 2K 16k 17k 512x512 1kx1024 1024x512 k 1kk 1x1x1 99999999999k; do
    try bake scene.glb --size $size
done
for sky in 1 .5 1/0 1,1,1/.2 1/ /1 -1; do try bake scene.glb --sky $sky; done
try info scene.glb --json -
try info --json - scene.glb
try info --json scene.glb
try info --json out.json scene.glb
try info --json=out.json scene.glb
try info --json= scene.glb
try info scene.glb --json missing/out.json
try info ./out.json --json out.json
try info -- --json
for word in Light LIGHT,Ao '' 'ao light' all; do try bake scene.glb --maps "$word"; done
try bake scene.glb --size 1024px
try bake scene.glb --sky
try bake scene.glb --maps
try bake scene.glb --quality preview --gather hemicube --maps light
try bake scene.glb --quality preview --gather paths --maps light
try bake scene.glb --error 1 --bounces 0
try bake scene.glb --error 1 --direct only
try bake scene.glb --error 1 --maps light --samples 64
try --maps=light scene.glb
# files that stand alone
for ending in fbx zip ifc dwg skp max ma blend usdz stl mtl png; do
    : >file.$ending
    try file.$ending
    try bake file.$ending
done
try absent.fbx
try folder/absent
printf '{"asset":{"version":"2.0"}}' >scene.json
try scene.json
