# SPDX-License-Identifier: MIT
# What info says of lights: where they are and shine, and what of them will surprise.
. "$(dirname "$0")/../scenes.bash"
grey='{"pbrMetallicRoughness":{"metallicFactor":0}}'
lights='{"type":"point","name":"bulb","intensity":40,"range":7},
{"type":"spot","intensity":2,"color":[1,0.5,0.25],"spot":{"innerConeAngle":0.5235987755982988,
"outerConeAngle":0.7853981633974483}},{"type":"directional","name":"sun","intensity":1000}'
room "$grey" "$(lamp 0 0 1 0),$(lamp 1 1 1.5 0),$(lamp 2 0 0 0),$(lamp 0 0 9 0)" "$lights" >lit.gltf
room "$grey" "$(lamp 2 0 0 0)" "$lights" >closed.gltf
room '{"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}}' "" "" >metal.gltf
for scene in lit closed metal; do
    echo "== $scene"
    alpenglow info $scene.gltf 2>&1 | grep -E '^(light|warning)'
    alpenglow info $scene.gltf --json 2>/dev/null | grep '"code"'
done
alpenglow info lit.gltf --json 2>/dev/null >lit.json
json_shape lit.json | grep lights
grep -A2 _degrees lit.json | grep degrees
echo "== bake and render say the same"
alpenglow bake closed.gltf --maps light --maps-dir maps --size 16 --samples 1 --sky 1,1,1 2>&1 |
    grep warning
alpenglow bake lit.gltf --maps light --maps-dir maps --size 16 --samples 1 -f 2>&1 | grep warning
alpenglow render lit.gltf --with reference -o a.png --resolution 8x8 --samples 1 2>&1 | grep warning
alpenglow render lit.gltf --with reference -o a.png --resolution 8x8 --samples 1 -f \
    --warnings-as-errors >/dev/null 2>&1
echo "$?, $(ls a.png)"
echo "== many are counted"
many=$(printf ',%s' $(for i in {1..22}; do lamp 0 0 0.$((i + 10)) 0; done))
glow='{"emissiveFactor":[1,1,1],"pbrMetallicRoughness":{"metallicFactor":0}}'
room "$glow" "${many#,}$(printf ',{"mesh":0,"scale":[%d,4,4]}' {2..22})" "$lights" >many.gltf
alpenglow info many.gltf 2>/dev/null | grep '^light ' | tail -n 22
alpenglow info many.gltf --json 2>/dev/null | grep -c '"kind"'
echo "== metal matters where viewers multiply a light map"
light='--maps light --sky 1,1,1'
for options in '-o ao.glb' "$light -o lit.glb" "$light --lightmap-as extras -o extras.glb" \
    "$light --maps-dir loose"; do
    # shellcheck disable=SC2086
    alpenglow bake metal.gltf $options --size 16 --error 50 >metal.txt 2>&1
    echo "$options: $?, $(grep -c 'is metal' metal.txt)"
done
