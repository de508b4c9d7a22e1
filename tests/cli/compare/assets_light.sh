# SPDX-License-Identifier: MIT
# light of every form, blended and in charts: alike within the texels
bake() {
    alpenglow bake builtin:sphere-plane --size 64 --maps light --samples 16 --sky 1,1,1 --bounces 0 \
        -q -o "$@"
}
for form in emissive moz extras; do
    more=
    [ $form = extras ] && more='--lightmap-format exr'
    bake $form.charts.glb --atlas charts --lightmap-as $form $more
    bake $form.blend.glb --atlas blend --lightmap-as $form $more
    alpenglow compare $form.charts.glb $form.blend.glb | grep ^map
    alpenglow compare $form.charts.glb $form.blend.glb --json - |
        grep -E '"relative_rmse": 0\.0[0-9]+' >/dev/null && echo alike
done
alpenglow compare moz.blend.glb extras.blend.glb --max-rmse 0.01 >/dev/null && echo as bytes and as halves
bake ktx2.glb --atlas blend --lightmap-as extras
alpenglow compare ktx2.glb extras.blend.glb --max-rmse 0.000001 >/dev/null && echo KTX2 and EXR
