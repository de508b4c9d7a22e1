# SPDX-License-Identifier: MIT
# json: one object a line; plain: the stages
bake="alpenglow bake builtin:sphere-plane --size 64 --ao-samples 64"
$bake --maps-dir a --progress json -q 2>lines
head -1 lines >first.json
json_shape first.json
$bake --maps-dir b --progress plain -q 2>lines
grep -q '^occlusion ' lines && echo "plain names the stage"
$bake --maps-dir c --progress off -q
