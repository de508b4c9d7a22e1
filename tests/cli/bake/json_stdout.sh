# SPDX-License-Identifier: MIT
# --json - writes the report to standard output and nothing else there; there is no file of this name
alpenglow bake builtin:sphere-plane --size 32 --ao-samples 16 -o out.glb --json - --progress off > out.json
echo $?
json_shape out.json | head -3
alpenglow bake builtin:sphere-plane --size 32 --ao-samples 16 -o a.glb --maps-dir maps -q --progress off
alpenglow compare maps/ao.exr maps/ao.exr --json - | grep rmse
ls
