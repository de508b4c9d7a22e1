# SPDX-License-Identifier: MIT
# two bakes of one scene: with themselves 0, blended against charts something, the same in JSON
bake() { alpenglow bake builtin:sphere-plane --size 64 --ao-samples 16 -q -o "$@"; }
bake blend.glb --atlas blend
bake charts.glb --atlas charts
alpenglow compare blend.glb blend.glb --max-rmse 0 | grep -E '^(map|points|rmse|bias|p99|maximum)'
alpenglow compare charts.glb blend.glb --points 1000
alpenglow compare charts.glb blend.glb --points 1000 --max-rmse 0.001 >/dev/null; echo $?
alpenglow compare charts.glb blend.glb --points 1000 --json numbers.json >/dev/null; json_shape numbers.json
alpenglow compare charts.glb charts.glb --scale 0.5 --json - | grep -E '"(relative_rmse|map)"'
