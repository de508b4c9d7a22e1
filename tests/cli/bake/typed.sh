# SPDX-License-Identifier: MIT
# bake without -o, --maps and --lightmap-as: the name of OUT, and what is in it
. "$(dirname "$0")/../scenes.bash"
room '{"pbrMetallicRoughness":{"metallicFactor":0},"emissiveFactor":[1,1,1]}' '' '' >room.gltf
triangle_dae '<unit meter="1"/><up_axis>Y_UP</up_axis>' 2 >flat.dae
quick="--size 16 --ao-samples 4 --progress off"
lit="--size 16 --bounces 1 --samples 32 --progress off"
bake() { # words...
    alpenglow bake "$@" 2>notes | sed -n 's/^wrote  */wrote /p; /^occlusion/s/ .*//p; /^light/s/ .*//p'
    grep '^note: .*--lightmap-as' notes
}
mkdir in && cp room.gltf in/far.gltf
bake room.gltf $quick
bake in/far.gltf $quick
bake flat.dae $quick
bake room.gltf $quick -o box.obj -q
bake box.obj $quick
bake box.obj --atlas vertex --ao-samples 4 --progress off
bake builtin:sphere-plane $quick
bake builtin:terrain,triangles=5000 $quick
ls -- *.baked.* | grep -v '\.baked\..*\.'
echo "== light"
bake room.gltf one.glb $lit
bake room.gltf -o two.glb --maps light $lit
bake room.gltf -o three.glb --maps ao,light --ao-samples 4 $lit
bake room.gltf -o four.glb --ao-samples 4 $lit
bake room.gltf five.json $lit
bake room.gltf six.babylon $lit
bake room.gltf seven.glb $lit --lightmap-as moz
bake room.gltf eight.glb $lit --maps-dir maps
bake room.gltf --lightmap-as three $lit
bake room.gltf -o nine.glb --maps ao,light --maps-dir apart --ao-samples 4 $lit
for name in one two three four seven eight nine; do
    printf '%s:' $name
    for word in occlusionTexture emissiveTexture MOZ_lightmap; do
        grep -aq $word $name.glb && printf ' %s' $word
    done
    echo
done
ls maps apart
for option in '--sky 1' '--sun 0,45,9' '--lamp 0,1,0,9' '--spot 0,1,0,0,0,0,9,1,9' '--bounces 0' \
    '--denoise on' '--layers --maps-dir layers'; do
    alpenglow bake room.gltf $option --size 8 --samples 32 -q -f -o option.glb ||
        echo "failed: $option"
    grep -ac emissiveTexture option.glb
done
echo "== what other formats hold"
bake box.obj lit.obj --sky 1 $lit
bake flat.dae shone.dae --sky 1 $lit
bake room.gltf both.glb --maps ao,light --maps-dir both --lightmap-as emissive --ao-samples 4 $lit
grep -aco 'emissiveTexture' both.glb
ls both
